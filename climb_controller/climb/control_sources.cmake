# SPDX-License-Identifier: BSD-3-Clause
# What decides and guards, beside what computes motion.
set(climb_control_sources
    controller_state.cpp
    body_shift.cpp
    controller.cpp
    controller_output.cpp
    controller_stance.cpp
    controller_work.cpp
    failsafe.cpp
    fault_watch.cpp
    step_over.cpp
    step_planner.cpp
    grasp_confirmation.cpp
    limb_cycle.cpp
    limb_motion.cpp
    limb_state.cpp
    safety.cpp
    way_back.cpp)
