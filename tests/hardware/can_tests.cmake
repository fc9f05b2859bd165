# SPDX-License-Identifier: BSD-3-Clause
# vcan0 and the controller pair of scripts/vm --vcan 1 --kvaser; the tests make further interfaces themselves.
hardware_test(hardware_can_socket_test SOURCES can_socket_test.cpp LINK can_bus)
if(TARGET ladder_plant_main)
  hardware_test(hardware_can_master_test SOURCES can_master_test.cpp LINK can_bus test_support TIMEOUT 900)
  target_compile_definitions(
    hardware_can_master_test PRIVATE LADDER_PLANT_PROGRAM="$<TARGET_FILE:ladder_plant_main>"
                                     LADDER_BUS_LOG="${PROJECT_BINARY_DIR}/tests/hardware/power_up.candump")
  add_dependencies(hardware_can_master_test ladder_plant_main)
endif()

# The whole controller on kernel devices, in this process: tests and the drill's kernel rows run it.
if(TARGET climb_box)
  ladder_library(hardware_kernel_box SOURCES kernel_box.cpp LINK climb_box)
  hardware_test(hardware_climb_test SOURCES climb_test.cpp LINK hardware_kernel_box test_support TIMEOUT 900)
  target_compile_definitions(hardware_climb_test
                             PRIVATE LADDER_BUS_LOG="${PROJECT_BINARY_DIR}/tests/hardware/climb_in_process.candump")
endif()
if(TARGET climb_box AND TARGET climb_controller_main)
  hardware_test(hardware_climb_process_test SOURCES climb_process_test.cpp LINK ladder_runtime test_support TIMEOUT 900)
  target_compile_definitions(
    hardware_climb_process_test PRIVATE LADDER_BIN_DIR="${PROJECT_BINARY_DIR}/bin"
                                        LADDER_BUS_LOG="${PROJECT_BINARY_DIR}/tests/hardware/climb.candump")
  add_dependencies(hardware_climb_process_test climb_controller_main ladder_command_main ladder_plant_main)

  add_executable(ladder_fault_rows fault_rows.cpp fault_rows_process.cpp)
  target_link_libraries(ladder_fault_rows PRIVATE hardware_kernel_box ladder_runtime test_support CLI11::CLI11 ladder_options)
  target_compile_definitions(ladder_fault_rows PRIVATE LADDER_BIN_DIR="${PROJECT_BINARY_DIR}/bin")
  set_target_properties(ladder_fault_rows PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests/bin")
  add_dependencies(ladder_fault_rows climb_controller_main ladder_command_main ladder_plant_main)

  add_executable(hardware_climb_ladder climb_ladder_test.cpp main_in_vm.cpp)
  target_link_libraries(hardware_climb_ladder PRIVATE ladder_runtime test_support ladder_options GTest::gmock GTest::gtest)
  target_include_directories(hardware_climb_ladder PRIVATE "${PROJECT_SOURCE_DIR}")
  target_compile_definitions(
    hardware_climb_ladder PRIVATE LADDER_BIN_DIR="${PROJECT_BINARY_DIR}/bin"
                                  LADDER_BUS_LOG="${PROJECT_BINARY_DIR}/tests/hardware/climb_ladder.candump")
  set_target_properties(hardware_climb_ladder PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests/bin")
  add_dependencies(hardware_climb_ladder climb_controller_main ladder_command_main ladder_plant_main)
endif()
