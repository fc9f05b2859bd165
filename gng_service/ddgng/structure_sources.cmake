# SPDX-License-Identifier: BSD-3-Clause
# The sources that turn a graph into surfaces, planes, objects and attention; included by gng_service/CMakeLists.txt.
set(DDGNG_STRUCTURE_SOURCES
    ${CMAKE_CURRENT_LIST_DIR}/attention.cpp
    ${CMAKE_CURRENT_LIST_DIR}/classification.cpp
    ${CMAKE_CURRENT_LIST_DIR}/neighborhood.cpp
    ${CMAKE_CURRENT_LIST_DIR}/objects.cpp
    ${CMAKE_CURRENT_LIST_DIR}/planes.cpp
    ${CMAKE_CURRENT_LIST_DIR}/segmentation.cpp
    ${CMAKE_CURRENT_LIST_DIR}/structure.cpp
    ${CMAKE_CURRENT_LIST_DIR}/structure_params.cpp
    ${CMAKE_CURRENT_LIST_DIR}/triangulation.cpp)
