# SPDX-License-Identifier: BSD-3-Clause
# scripts/vm --vivid --v4l2loopback
hardware_test(hardware_v4l2_source_test SOURCES v4l2_source_test.cpp LINK sources ladder_runtime test_support TIMEOUT 600)
target_compile_definitions(hardware_v4l2_source_test PRIVATE LADDER_BIN_DIR="${PROJECT_BINARY_DIR}/bin")
add_dependencies(hardware_v4l2_source_test sensor_service_main)
