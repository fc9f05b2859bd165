// SPDX-License-Identifier: BSD-3-Clause
#include "climb/grasp_confirmation.h"

#include <algorithm>
#include <cmath>

namespace climb {
namespace {

// Sums of cycle times reach 0.03 s as 0.0299999..: a hundredth of a cycle is forgiven.
constexpr double kRounding_s = 1e-4;
constexpr double kMaxSkew = 0.5;  ///< more is no rung across the claw

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

JawWindow jaw_window(const ClawParams& claw, const ExpectedRung& rung) {
  const auto on_rung_rad = [&claw](double radius_m) {
    return claw.on_rung_rad + claw.jaw_rad_per_m * (radius_m - claw.on_rung_radius_m);
  };
  const bool is_known = rung.radius_m > 0.0 && std::isfinite(rung.radius_m);
  const double radius_m =
      std::min(is_known ? rung.radius_m : claw.max_rung_radius_m, claw.max_rung_radius_m);
  const double skew = std::isfinite(rung.skew) ? std::min(std::abs(rung.skew), kMaxSkew) : 0.0;
  // Pulled at, a thinner one leaves the palm and opens the jaw as one of this radius does (run).
  const double pulled_radius_m = std::max(radius_m, claw.on_rung_radius_m);
  const double widest_rad = on_rung_rad(pulled_radius_m + claw.jaw_row_m * skew);
  JawWindow window;
  window.high_rad = std::min(widest_rad + claw.on_rung_window_rad, claw.open_rad);
  // Not known: only an empty claw is told from a full one.
  window.low_rad = claw.empty_rad;
  if (is_known) {
    window.low_rad = std::max(claw.empty_rad, on_rung_rad(radius_m) - claw.on_rung_window_rad);
  }
  return window;
}

GraspConfirmation::GraspConfirmation(const ClawParams& claw, const MotionParams& motion,
                                     const ConfirmationParams& params)
    : claw_(claw), motion_(motion), params_(params), window_(jaw_window(claw, {})) {
  params_.touch_s -= kRounding_s;
  params_.lost_s -= kRounding_s;
  params_.stuck_s -= kRounding_s;
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
