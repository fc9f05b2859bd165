// SPDX-License-Identifier: BSD-3-Clause
// Where the controller is, as far as a drill tells situations apart: its state, the limb that is
// under way and what it does, and whether the dock still holds the robot.
#pragma once

#include <string>
#include <tuple>

#include "robot_in_a_box/climb_box.h"

namespace robot_in_a_box {

struct Situation {
  climb::ControllerState state = climb::ControllerState::kBoot;
  int leg = -1;                                       ///< the limb that is under way, -1 = none
  climb::LimbState limb = climb::LimbState::kLoaded;  ///< of that leg
  bool shifts = false;                                ///< the body is being moved
  bool docked = true;
  bool follows = false;  ///< drives are given targets

  auto key() const { return std::tuple(state, leg, limb, shifts, docked, follows); }
  friend bool operator<(const Situation& a, const Situation& b) { return a.key() < b.key(); }
};

Situation situation_of(const ClimbBox& box);
/// "CLIMBING RR TRANSIT".
std::string describe(const Situation& situation);

}  // namespace robot_in_a_box
