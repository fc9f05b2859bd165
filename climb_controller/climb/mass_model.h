// SPDX-License-Identifier: BSD-3-Clause
// Centre of mass of torso and legs, body frame.
#pragma once

#include "climb/params.h"

namespace climb {

class MassModel {
 public:
  explicit MassModel(const RobotParams& robot);

  double total_kg() const { return total_kg_; }

  /// Of the whole robot in this configuration.
  Eigen::Vector3d center_m(const PerLeg<LegAngles>& angles_rad) const;

 private:
  RobotParams robot_;
  double total_kg_;
};

}  // namespace climb
