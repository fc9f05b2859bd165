// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/situation.h"

namespace robot_in_a_box {
namespace {

bool is_under_way(const ClimbBox& box, climb::Leg leg) {
  const climb::LimbCycle& limb = box.controller().limb(leg);
  return limb.moves() || limb.state() == climb::LimbState::kSupportLost;
}

}  // namespace

Situation situation_of(const ClimbBox& box) {
  Situation situation;
  situation.state = box.state();
  situation.shifts = box.report().output.body_shift;
  situation.docked = box.plant().is_docked();
  situation.follows = box.report().output.send;
  for (const climb::Leg leg : climb::kLegs) {
    if (situation.leg >= 0 || !is_under_way(box, leg)) continue;
    situation.leg = leg;
    situation.limb = box.report().output.limbs[leg];
  }
  return situation;
}

std::string describe(const Situation& situation) {
  std::string text = climb::name(situation.state);
  if (situation.leg >= 0) {
    text += std::string(" ") + climb::name(static_cast<climb::Leg>(situation.leg)) + " " +
            climb::name(situation.limb);
  }
  if (situation.shifts) text += " body shift";
  if (situation.docked) text += " docked";
  if (situation.state == climb::ControllerState::kArming && !situation.follows) text += " enabling";
  return text;
}

}  // namespace robot_in_a_box
