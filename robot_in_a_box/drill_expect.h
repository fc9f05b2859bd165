// SPDX-License-Identifier: BSD-3-Clause
// What many rows of the fault table expect or forbid, in the observer's terms.
#pragma once

#include "robot_in_a_box/drill_case.h"

namespace robot_in_a_box {

inline constexpr std::int64_t kT_us = ClimbBox::kCycle_us;
inline constexpr std::int64_t kRunOut_us = 150'000;  ///< until targets stand after a stop

bool is_unpowered(climb::ControllerState state);

/// FAULT_HOLD for one of these reasons. Not powered: it stays so. Latched: the first reason stays.
bool holds_for(const CaseRun& run, climb::FaultFlags reasons);
bool is_unchanged(const CaseRun& run);

/// nullptr when fine. After a stop: targets that still move, torque that was taken away from an
/// axis that is not broken itself, claws opened, targets sent where nothing was armed.
const char* harm_after_stop(const CaseRun& run);
/// The same where one axis is broken by the drill itself.
const char* harm_but_for_axis(const CaseRun& run);
const char* harm_to_grasps(const CaseRun& run);
/// Also nothing at all is sent.
const char* harm_when_silent(const CaseRun& run);

void arm_meanwhile(CaseRun& run);  ///< the operator tries to arm where it is not armed

}  // namespace robot_in_a_box
