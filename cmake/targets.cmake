# SPDX-License-Identifier: BSD-3-Clause
# One way to declare a library, a program and a test. Standard, warnings and floating-point rules live here and nowhere else.

find_program(LADDER_CCACHE ccache)
if(LADDER_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${LADDER_CCACHE}")
endif()

add_library(ladder_options INTERFACE)
target_compile_features(ladder_options INTERFACE cxx_std_20)
target_compile_options(
  ladder_options
  INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Wold-style-cast
            -Wundef -Werror
            # Same bits on every CPU: no contraction into fused multiply-add, errno-free sqrt.
            -ffp-contract=off -fno-math-errno)
if(LADDER_SANITIZE)
  target_compile_options(ladder_options INTERFACE -fsanitize=${LADDER_SANITIZE} -fno-omit-frame-pointer
                                                  -fno-sanitize-recover=all)
  target_link_options(ladder_options INTERFACE -fsanitize=${LADDER_SANITIZE})
endif()

# ladder_library(NAME SOURCES ... [LINK ...] [INCLUDE dir])
# A static library. INCLUDE is the folder its headers are named from (default: the repository root).
function(ladder_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "INCLUDE" "SOURCES;LINK")
  if(NOT arg_INCLUDE)
    set(arg_INCLUDE "${PROJECT_SOURCE_DIR}")
  endif()
  add_library(${name} STATIC ${arg_SOURCES})
  target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${arg_INCLUDE}>)
  target_link_libraries(${name} PUBLIC ${arg_LINK} PRIVATE $<BUILD_INTERFACE:ladder_options>)
  target_compile_features(${name} PUBLIC cxx_std_20)
  set_target_properties(${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
endfunction()

# ladder_executable(NAME SOURCES ... [LINK ...] [OUTPUT name])  An installed program in build/<preset>/bin.
function(ladder_executable name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "OUTPUT" "SOURCES;LINK")
  if(NOT arg_OUTPUT)
    set(arg_OUTPUT ${name})
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE ${arg_LINK} ladder_options)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin" OUTPUT_NAME ${arg_OUTPUT})
endfunction()

# ladder_test(NAME SOURCES ... [LINK ...] [LABELS ...] [TIMEOUT s])  One GoogleTest program = one ctest entry.
# A test that reports "SKIPPED" by GTEST_SKIP() is counted as skipped by ctest and named in its summary.
function(ladder_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "TIMEOUT" "SOURCES;LINK;LABELS")
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 400) # a guard against hanging: with sanitizers on a busy computer the longest take minutes
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}")
  target_link_libraries(${name} PRIVATE ${arg_LINK} ladder_options GTest::gmock GTest::gtest_main)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests/bin" UNITY_BUILD OFF)
  add_test(NAME ${name} COMMAND ${name})
  set_tests_properties(${name} PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS "${arg_LABELS}")
endfunction()
