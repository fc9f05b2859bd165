# SPDX-License-Identifier: BSD-3-Clause
# Needs the module gpio-sim (scripts/vm --gpio-sim); the tests make their own chips.
hardware_test(hardware_gpio_lines_test SOURCES gpio_lines_test.cpp LINK gpio_lines)
