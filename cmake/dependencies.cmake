# SPDX-License-Identifier: BSD-3-Clause
# Every outside library, all from Debian 12 packages (scripts/setup installs them).

find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(HWY REQUIRED IMPORTED_TARGET libhwy)
pkg_check_modules(SYSTEMD REQUIRED IMPORTED_TARGET libsystemd)
find_package(Python3 REQUIRED COMPONENTS Interpreter)
find_package(Threads REQUIRED)
if(LADDER_BUILD_TESTS)
  find_package(GTest REQUIRED)
endif()
if(LADDER_BUILD_SIMULATOR)
  find_package(mujoco REQUIRED)
  # Debian's package names a build-time folder (libqhull_r) as include path; the headers stand in the compiler's own.
  set_target_properties(mujoco::mujoco PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "")
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
