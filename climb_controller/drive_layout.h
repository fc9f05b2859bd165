// SPDX-License-Identifier: BSD-3-Clause
// The sixteen servo axes as the robot is wired: node = 1 + 4 leg + joint, limits from the robot's
// parameters, everything else the same for all joints and for all jaws.
#pragma once

#include "can/cia402_objects.h"
#include "can/odrive_bus.h"
#include "climb/axis.h"
#include "climb/params.h"

namespace climb_controller {

/// Of one kind of axis: leg joints, or jaws.
struct DriveKind {
  double counts_per_rad = 10430.0;   ///< position units per radian of the motor shaft
  double gear = 1.0;                 ///< motor turns per joint turn
  double rated_torque_Nm = 20.0;     ///< what the drive calls 1000 permille
  double quick_stop_rad_s2 = 20.0;   ///< stands within 125 ms from 2.5 rad/s
  double following_error_rad = 0.3;  ///< 60 ms of lag at 2.5 rad/s, twice
  int following_error_ms = 50;
  bool has_torque = true;       ///< 6072h and 6077h exist
  double max_current_A = 20.0;  ///< ODrive only
};

template <class T>
constexpr climb::PerAxis<T> same(T value) {
  climb::PerAxis<T> all{};
  all.fill(value);
  return all;
}
/// 1, 2 ... 16.
constexpr climb::PerAxis<int> in_order() {
  climb::PerAxis<int> ids{};
  for (int axis = 0; axis < climb::kNumAxes; ++axis) ids[axis] = axis + 1;
  return ids;
}

struct DriveLayout {
  DriveKind joint;
  /// A jaw presses on its rung and never reaches its target.
  DriveKind jaw{.rated_torque_Nm = 6.0, .quick_stop_rad_s2 = 100.0, .following_error_rad = 1.0};
  climb::PerAxis<int> node_id = in_order();
  climb::PerAxis<int> sign = same(1);             ///< +1 or -1
  climb::PerAxis<double> offset_rad = same(0.0);  ///< joint angle at position 0
};

/// The bus with these drives and the robot's limits; check() of the result is the caller's.
can::Cia402Params servo_bus_params(const DriveLayout& layout, const climb::ClimbParams& climb);
can::OdriveParams odrive_bus_params(const DriveLayout& layout, const climb::ClimbParams& climb);

}  // namespace climb_controller
