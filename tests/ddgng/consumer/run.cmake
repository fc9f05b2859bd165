# SPDX-License-Identifier: BSD-3-Clause
# cmake -D BUILD=... -D SOURCE=... -D WORK=... -D COMPILER=... -D TOOLCHAIN=... -D EMULATOR=... -P run.cmake
# Installs ddgng into an empty prefix, builds a foreign project against it and runs that. TOOLCHAIN and EMULATOR are of a cross build, else empty.
file(REMOVE_RECURSE "${WORK}")
foreach(command
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${WORK}/prefix;--component;ddgng"
    "${CMAKE_COMMAND};-S;${SOURCE};-B;${WORK}/build;-DCMAKE_BUILD_TYPE=Release;-DCMAKE_CXX_COMPILER=${COMPILER};-DCMAKE_TOOLCHAIN_FILE=${TOOLCHAIN};-Dddgng_DIR=${WORK}/prefix/lib/cmake/ddgng"
    "${CMAKE_COMMAND};--build;${WORK}/build"
    "${EMULATOR};${WORK}/build/consumer")
  list(REMOVE_ITEM command "")
  execute_process(COMMAND ${command} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
