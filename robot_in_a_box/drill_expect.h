// SPDX-License-Identifier: BSD-3-Clause
// What many rows of the fault table expect or forbid, in the observer's terms.
#pragma once

#include "robot_in_a_box/drill_case.h"

namespace robot_in_a_box {

inline constexpr std::int64_t kT_us = ClimbBox::kCycle_us;
inline constexpr std::int64_t kRunOut_us = 150'000;  ///< until targets stand after a stop

bool is_unpowered(climb::ControllerState state);

// Situations.
bool everywhere(const Situation& at);
bool after_boot(const Situation& at);     ///< it speaks on the bus
bool where_enabled(const Situation& at);  ///< drives follow targets
bool where_powered(const Situation& at);  ///< ... and nothing is latched
bool in_climbing(const Situation& at);
bool in_hold(const Situation& at);  ///< on the ladder

// Reactions.

/// FAULT_HOLD for one of these reasons. Not powered: it stays so. Latched: the first reason stays.
bool holds_for(const CaseRun& run, climb::FaultFlags reasons);
bool is_unchanged(const CaseRun& run);

bool takes_no_notice(const CaseRun& run);  ///< for 0.3 s
/// At rest, or stopped because the limb under way cannot finish for a trouble of its own.
bool rests(const CaseRun& run);
/// The first message of perception that was taken; -1 = none yet.
std::int64_t next_message_at(const CaseRun& run);
/// Armed again after a stop.
bool follows_again(const CaseRun& run);

// Harm; nullptr when there is none.
/// After a stop: targets that still move, torque that was taken away from an
/// axis that is not broken itself, claws opened, targets sent where nothing was armed.
const char* harm_after_stop(const CaseRun& run);
/// The same where one axis is broken by the drill itself.
const char* harm_but_for_axis(const CaseRun& run);
const char* harm_to_grasps(const CaseRun& run);
/// Also nothing at all is sent.
const char* harm_when_silent(const CaseRun& run);

const char* harm_by_notice(const CaseRun& run);
/// The limb in the air finishes, none is lifted any more, and torque stays.
const char* harm_by_next_step(const CaseRun& run);

/// The operator resets so long after the injection, then arms as soon as that is possible.
void reset_and_arm(CaseRun& run, std::int64_t reset_us);
const char* harm_by_reaching(const CaseRun& run);  ///< no limb is lifted
void arm_meanwhile(CaseRun& run);  ///< the operator tries to arm where it is not armed

}  // namespace robot_in_a_box
