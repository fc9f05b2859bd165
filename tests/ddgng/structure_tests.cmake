# SPDX-License-Identifier: BSD-3-Clause
# The structure part: from graphs to surfaces, planes, objects and attention.
ladder_test(ddgng_structure_test
  SOURCES structure_params_test.cpp classification_test.cpp structure_odd_inputs_test.cpp
          structure_scene_test.cpp planes_test.cpp objects_test.cpp attention_test.cpp
          structure_scene.cpp
  LINK ddgng LABELS unit)
ladder_test(ddgng_structure_reference_test
  SOURCES structure_reference_test.cpp structure_invariants_test.cpp structure_scene.cpp
          ../reference/structure_reference.cpp
  LINK ddgng LABELS property)
ladder_test(ddgng_structure_allocation_test
  SOURCES structure_allocation_test.cpp structure_scene.cpp
  LINK ddgng allocation_counter LABELS unit)
