// SPDX-License-Identifier: BSD-3-Clause
#include "climb/grasp_confirmation.h"

#include <cmath>

namespace climb {
namespace {

// Sums of cycle times reach 0.03 s as 0.0299999..: a hundredth of a cycle is forgiven.
constexpr double kRounding_s = 1e-4;

double counted(double sum_s, bool goes_on, double dt_s) {
  if (!goes_on) return 0.0;
  return sum_s + (dt_s > 0.0 && std::isfinite(dt_s) ? dt_s : 0.0);
}

}  // namespace

std::string check(const ConfirmationParams& p) {
  const bool times_ok = p.touch_s > 0.0 && p.touch_s <= 1.0 && p.lost_s > 0.0 && p.lost_s <= 1.0 &&
                        p.stuck_s > 0.0 && p.stuck_s <= 1.0;
  if (!times_ok) return "confirmation: touch_s, lost_s and stuck_s must be above 0, at most 1";
  if (!(p.open_window_rad > 0.0 && p.open_window_rad <= 1.0)) {
    return "confirmation.open_window_rad must be above 0, at most 1";
  }
  if (!(p.max_disagreements > 0)) return "confirmation.max_disagreements must be above 0";
  return "";
}

GraspConfirmation::GraspConfirmation(const ClawParams& claw, const MotionParams& motion,
                                     const ConfirmationParams& params)
    : claw_(claw), motion_(motion), params_(params) {
  params_.touch_s -= kRounding_s;
  params_.lost_s -= kRounding_s;
  params_.stuck_s -= kRounding_s;
}

bool GraspConfirmation::in_window() const {
  return std::abs(reading_.jaw_rad - claw_.on_rung_rad) <= claw_.on_rung_window_rad;
}

void GraspConfirmation::update(const ClawReading& reading, double dt_s) {
  reading_ = reading;
  touch_s_ = counted(touch_s_, reading.touch, dt_s);
  open_s_ = counted(open_s_, !(reading.touch && in_window()), dt_s);
  jaw_off_s_ = counted(jaw_off_s_, !in_window(), dt_s);
  if (open_s_ <= 0.0) grace_s_ = 0.0;
  const bool stands_open = reading.jaw_rad >= claw_.open_rad - params_.open_window_rad;
  stuck_s_ = counted(stuck_s_, reading.touch && stands_open, dt_s);
}

GraspWitness GraspConfirmation::witness() const {
  GraspWitness witness;
  witness.touch = touch_s_ >= params_.touch_s;
  witness.jaw = in_window();
  witness.torque = std::abs(reading_.jaw_torque_Nm) >= claw_.min_closing_torque_Nm;
  return witness;
}

GraspWitness GraspConfirmation::conclude(const PullResult& pull) {
  GraspWitness verdict = witness();
  verdict.pull = std::abs(pull.slip_m) < motion_.pull_test_max_slip_m &&
                 pull.force_N >= motion_.pull_test_min_N && std::isfinite(pull.force_N);
  const bool agree = verdict.touch == verdict.pull && verdict.jaw == verdict.pull;
  num_disagreements_ = agree ? 0 : num_disagreements_ + 1;
  return verdict;
}

void GraspConfirmation::conclude_missed() {
  // An empty claw at its stop has torque too: touch against jaw is the contradiction.
  if (reading_.touch != in_window()) ++num_disagreements_;
}

}  // namespace climb
