# SPDX-License-Identifier: BSD-3-Clause
# Toolchain of the preset arm64: Debian's cross compiler, Debian's arm64 libraries unpacked in build/arm64-sysroot, and qemu to run tests.
# scripts/cross_arm64 prepares all three.

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++-12)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

get_filename_component(LADDER_SYSROOT "${CMAKE_CURRENT_LIST_DIR}/../build/arm64-sysroot" ABSOLUTE)
set(CMAKE_SYSROOT "${LADDER_SYSROOT}")
set(CMAKE_FIND_ROOT_PATH "${LADDER_SYSROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L "${LADDER_SYSROOT}")

# pkg-config reads the sysroot's files and nobody else's.
set(ENV{PKG_CONFIG_LIBDIR} "${LADDER_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${LADDER_SYSROOT}/usr/share/pkgconfig")
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${LADDER_SYSROOT}")
