# SPDX-License-Identifier: BSD-3-Clause
# What decides and guards: gate, failsafe table, state machines, grasp confirmation, controller.
ladder_test(climb_safety_test SOURCES safety_test.cpp fault_watch_test.cpp LINK climb LABELS unit)
ladder_test(climb_failsafe_test SOURCES failsafe_test.cpp control_states_test.cpp LINK climb LABELS unit TIMEOUT 300)
ladder_test(climb_confirmation_test SOURCES grasp_confirmation_test.cpp LINK climb LABELS unit)
ladder_test(climb_controller_test SOURCES controller_test.cpp orders_test.cpp regrasp_test.cpp refusals_test.cpp long_step_test.cpp other_way_test.cpp stance_test.cpp way_back_test.cpp disorder_test.cpp new_controller_test.cpp LINK climb LABELS unit)
ladder_test(climb_controller_allocation_test SOURCES controller_allocation_test.cpp LINK climb allocation_counter LABELS unit)
