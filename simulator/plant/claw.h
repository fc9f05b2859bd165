// SPDX-License-Identifier: BSD-3-Clause
// One claw: a jaw that closes on a rung or, when it misses, to its stop; what it holds, how it lost
// it, and its touch switch. Numbers from the simulated robot with real contacts.
// Does not model friction along the rung, fingers bumping into rungs, or bending.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "simulator/plant/rung_world.h"

namespace simulator {

struct ClawParams {
  double open_rad = 1.2;
  double stop_rad = -0.60;     ///< closed and empty
  double on_rung_rad = -0.42;  ///< on a rung of this radius (run)
  double on_rung_radius_m = 0.014;
  double jaw_rad_per_m = 60.0;         ///< ... and per radius more (run: 24..40 mm)
  double capture_m = 0.015;            ///< a rung axis nearer to the foot is caught
  double play_m = 0.005;               ///< clearance of the claw about the rung
  double jaw_stiffness_Nm_rad = 20.0;  ///< torque per angle closed beyond contact
  double release_rad = 0.08;           ///< opened so far beyond contact = let go
  double tear_off_N = 230.0;           ///< a single claw is torn off
  std::int64_t tear_off_us = 5'000;
  double touch_torque_Nm = 0.5;
  std::int64_t touch_us = 30'000;  ///< pressed so long before the switch closes
};

enum class LossCause : std::uint8_t { kNone, kOpened, kRungBroke, kTornOff };
const char* name(LossCause cause);

struct ClawInputs {
  std::int64_t now_us = 0;
  Eigen::Vector3d p_world_foot_m = Eigen::Vector3d::Zero();
  double jaw_rad = 0.0;
  double jaw_torque_Nm = 0.0;
  bool jaw_powered = false;  ///< else a brake keeps what it pressed
  double force_N = 0.0;      ///< on the rung, of the step before
};

class Claw {
 public:
  explicit Claw(const ClawParams& params) : params_(params) {}

  void update(const ClawInputs& inputs, const RungWorld& world);

  bool holds() const { return holds_; }
  int rung_index() const { return rung_index_; }
  const Eigen::Vector3d& anchor_m() const { return anchor_m_; }
  LossCause last_loss() const { return last_loss_; }
  std::int64_t lost_us() const { return lost_us_; }
  bool touch() const { return touch_; }
  /// Where the jaw is stopped: on a rung within reach, or its own stop.
  double jaw_stop_rad() const { return jaw_stop_rad_; }
  /// Torque that a jaw commanded to this angle presses with.
  double press_Nm(double jaw_target_rad) const;
  double contact_rad(double rung_radius_m) const;

 private:
  void keep_or_lose(const ClawInputs& inputs, const RungWorld& world);
  void try_to_catch(const ClawInputs& inputs, const RungWorld& world);
  void lose(LossCause cause, std::int64_t now_us);
  void update_touch(const ClawInputs& inputs);

  ClawParams params_;
  bool holds_ = false;
  int rung_index_ = -1;
  Eigen::Vector3d anchor_m_ = Eigen::Vector3d::Zero();
  LossCause last_loss_ = LossCause::kNone;
  std::int64_t lost_us_ = -1;
  std::int64_t overload_since_us_ = -1;
  std::int64_t pressed_since_us_ = -1;
  bool touch_ = false;
  double jaw_stop_rad_ = -0.60;
};

}  // namespace simulator
