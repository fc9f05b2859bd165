# SPDX-License-Identifier: BSD-3-Clause
# Every outside library, all from Debian 12 packages (scripts/setup installs them).

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(SYSTEMD REQUIRED IMPORTED_TARGET libsystemd)
pkg_check_modules(GPIOD REQUIRED IMPORTED_TARGET libgpiod>=1.5)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
find_package(Threads REQUIRED)
find_package(Boost 1.74 REQUIRED) # headers: Asio and Beast
if(LADDER_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(LADDER_BUILD_SIMULATOR)
  # Not through its CMake package: that asks for OpenGL's development files, which only its viewer needs.
  find_path(MUJOCO_INCLUDE_DIR mujoco/mujoco.h REQUIRED)
  find_library(MUJOCO_LIBRARY mujoco REQUIRED)
  add_library(mujoco::mujoco SHARED IMPORTED)
  set_target_properties(mujoco::mujoco PROPERTIES IMPORTED_LOCATION "${MUJOCO_LIBRARY}")
endif()
if(LADDER_BUILD_TESTS AND LADDER_BUILD_BENCHES)
  find_package(benchmark REQUIRED)
endif()

# LCM 1.4 and later bring a CMake package; Debian's 1.3.1 does not, and its lcm.pc needs glib's development files.
find_package(lcm QUIET CONFIG)
if(NOT TARGET lcm)
  find_path(LCM_INCLUDE_DIR lcm/lcm-cpp.hpp REQUIRED)
  find_library(LCM_LIBRARY lcm REQUIRED)
  add_library(lcm SHARED IMPORTED)
  set_target_properties(lcm PROPERTIES IMPORTED_LOCATION "${LCM_LIBRARY}" INTERFACE_INCLUDE_DIRECTORIES "${LCM_INCLUDE_DIR}")
endif()
find_program(LCM_GEN lcm-gen REQUIRED)
