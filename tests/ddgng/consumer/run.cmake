# SPDX-License-Identifier: BSD-3-Clause
# cmake -D BUILD=... -D SOURCE=... -D WORK=... -D COMPILER=... -P run.cmake
# Installs ddgng into an empty prefix, builds a foreign project against it and runs that.
file(REMOVE_RECURSE "${WORK}")
foreach(command
    "${CMAKE_COMMAND};--install;${BUILD};--prefix;${WORK}/prefix;--component;ddgng"
    "${CMAKE_COMMAND};-S;${SOURCE};-B;${WORK}/build;-DCMAKE_BUILD_TYPE=Release;-DCMAKE_CXX_COMPILER=${COMPILER};-DCMAKE_PREFIX_PATH=${WORK}/prefix"
    "${CMAKE_COMMAND};--build;${WORK}/build"
    "${WORK}/build/consumer")
  execute_process(COMMAND ${command} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
