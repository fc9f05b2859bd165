// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/claw.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace simulator {
namespace {

/// The jaw bears on the rung when it is within this of the contact angle.
constexpr double kContactWindow_rad = 0.02;

}  // namespace

const char* name(LossCause cause) {
  constexpr std::array<const char*, 4> kNames = {"none", "opened", "rung_broke", "torn_off"};
  return kNames[static_cast<std::size_t>(cause)];
}

double Claw::contact_rad(double rung_radius_m) const {
  const double wider_m = rung_radius_m - params_.on_rung_radius_m;
  return std::max(params_.stop_rad, params_.on_rung_rad + params_.jaw_rad_per_m * wider_m);
}

double Claw::press_Nm(double jaw_target_rad) const {
  if (!holds_) return 0.0;
  return params_.jaw_stiffness_Nm_rad * std::max(0.0, jaw_stop_rad_ - jaw_target_rad);
}

void Claw::update(const ClawInputs& inputs, const RungWorld& world) {
  if (holds_) {
    keep_or_lose(inputs, world);
  } else {
    try_to_catch(inputs, world);
  }
  update_touch(inputs);
}

void Claw::keep_or_lose(const ClawInputs& inputs, const RungWorld& world) {
  if (world.rung(rung_index_).broken) return lose(LossCause::kRungBroke, inputs.now_us);
  if (inputs.jaw_rad > jaw_stop_rad_ + params_.release_rad) {
    return lose(LossCause::kOpened, inputs.now_us);
  }
  if (!(inputs.force_N > params_.tear_off_N)) {
    overload_since_us_ = -1;
    return;
  }
  if (overload_since_us_ < 0) overload_since_us_ = inputs.now_us;
  if (inputs.now_us - overload_since_us_ >= params_.tear_off_us) {
    lose(LossCause::kTornOff, inputs.now_us);
  }
}

void Claw::lose(LossCause cause, std::int64_t now_us) {
  holds_ = false;
  last_loss_ = cause;
  lost_us_ = now_us;
  overload_since_us_ = -1;
  // A rung that is still between the jaws stops them; one that is gone does not.
  if (cause != LossCause::kOpened) jaw_stop_rad_ = params_.stop_rad;
}

void Claw::try_to_catch(const ClawInputs& inputs, const RungWorld& world) {
  const NearestRung nearest = world.nearest(inputs.p_world_foot_m);
  jaw_stop_rad_ = params_.stop_rad;
  if (nearest.index < 0 || nearest.distance_m > params_.capture_m) return;
  const double contact = contact_rad(world.rung(nearest.index).radius_m);
  // A jaw already closed past the rung keeps it out.
  if (inputs.jaw_rad < contact - kContactWindow_rad) return;
  jaw_stop_rad_ = contact;
  if (inputs.jaw_rad > contact + kContactWindow_rad) return;
  holds_ = true;
  rung_index_ = nearest.index;
  // The closing jaw centres the claw, up to its play.
  const Eigen::Vector3d off = inputs.p_world_foot_m - nearest.point_m;
  const double off_m = off.norm();
  anchor_m_ = nearest.point_m;
  if (off_m > 0.0) anchor_m_ += off * std::min(1.0, params_.play_m / off_m);
}

void Claw::update_touch(const ClawInputs& inputs) {
  const bool was_pressed = pressed_since_us_ >= 0;
  const bool presses =
      inputs.jaw_powered ? std::fabs(inputs.jaw_torque_Nm) > params_.touch_torque_Nm : was_pressed;
  if (!holds_ || !presses) {
    pressed_since_us_ = -1;
    touch_ = false;
    return;
  }
  if (!was_pressed) pressed_since_us_ = inputs.now_us;
  touch_ = inputs.now_us - pressed_since_us_ >= params_.touch_us;
}

}  // namespace simulator
