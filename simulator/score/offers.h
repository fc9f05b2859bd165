// SPDX-License-Identifier: BSD-3-Clause
// Where the report says that a claw may close, and whether it may. Knows truth and report, nothing
// of the detector.
#pragma once

#include <span>
#include <vector>

#include "ladder_msgs/ladder_t.hpp"
#include "simulator/score/matching.h"

namespace simulator {

struct OfferParams {
  double max_axis_m = 0.05;     ///< offered place to the axis of the rung it is on
  double claw_width_m = 0.034;  ///< nearer to a rail or a broken end it cannot close
  double reaction_s = 1.0;      ///< a rung taken away may be offered so long (a metric of its own)
};

/// A stretch of a reported rung that is offered to a claw; a single place where both ends are one.
struct Offer {
  Eigen::Vector3d from_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_m = Eigen::Vector3d::Zero();
};

/// Feasible intervals and grasps, in their order in the message.
std::vector<Offer> offers_of(const ladder_msgs::ladder_t& message);

/// Whether all of it lies on one sound rung of a ladder, a claw's width from that rung's ends.
bool is_safe(const Offer& offer, std::span<const TrueRung> truth, const OfferParams& params);

}  // namespace simulator
