# SPDX-License-Identifier: BSD-3-Clause
# What decides and guards, beside what computes motion.
set(climb_control_sources
    controller_state.cpp
    failsafe.cpp
    grasp_confirmation.cpp
    limb_state.cpp
    safety.cpp)
