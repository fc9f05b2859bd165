# SPDX-License-Identifier: BSD-3-Clause
# vcan0 and vcan1 of scripts/vm --vcan 2; the tests make further interfaces themselves.
hardware_test(hardware_can_socket_test SOURCES can_socket_test.cpp LINK can_bus)
