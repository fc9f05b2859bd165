// SPDX-License-Identifier: BSD-3-Clause
// One climb in full fidelity and virtual time: physical_climb.h, but what the robot knows of the
// ladder it has seen with its own heads (full_perception.h), and its attitude comes from samples.
#pragma once

#include <string>

#include "robot_in_a_box/full_perception.h"
#include "robot_in_a_box/physical_climb.h"
#include "runtime/config.h"

namespace robot_in_a_box {

struct FullClimbParams {
  PhysicalClimbParams climb;  ///< its perception is not used
  FullPerceptionParams perception;
};

class FullClimb {
 public:
  /// [sensor], [gng], [ladder] and [climb] of the configuration. Throws runtime::ConfigError.
  FullClimb(const FullClimbParams& params, const runtime::Config& config);

  PhysicalClimb& climb() { return climb_; }
  FullPerception& eyes() { return eyes_; }

 private:
  PhysicalClimb climb_;
  FullPerception eyes_;
};

}  // namespace robot_in_a_box
