// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/perceived_ladder.h"

#include <cmath>

namespace robot_in_a_box {
namespace {

constexpr double kSigma_m = 0.002;

Eigen::Vector3d within(double limit_m, base::Rng& rng) {
  Eigen::Vector3d error;
  for (int i = 0; i < 3; ++i) error[i] = limit_m * (2.0 * rng.uniform() - 1.0);
  return error;
}

}  // namespace

PerceivedLadder::PerceivedLadder(const PerceptionParams& params, std::uint64_t seed)
    : params_(params), rng_(seed) {}

bool PerceivedLadder::update(std::int64_t now_us, const simulator::RobotPlant& plant,
                             const Eigen::Isometry3d& T_odom_body) {
  const auto rungs = plant.world().rungs();
  while (bias_m_.size() < rungs.size()) bias_m_.push_back(within(params_.bias_m, rng_));
  if (now_us < next_us_) return false;
  next_us_ += params_.period_us;
  if (silent) return false;
  rungs_.clear();
  stretches_.clear();
  const Eigen::Isometry3d T_odom_world = T_odom_body * plant.T_world_body().inverse();
  const double body_m = plant.T_world_body().translation().z();
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    const double above_m = rungs[i].end0_m.z() - body_m;
    const bool is_seen =
        !rungs[i].broken && above_m >= seen_from_m && std::fabs(above_m) <= params_.range_m;
    if (is_seen) tell(static_cast<int>(i), rungs[i], T_odom_world);
  }
  received_us_ = now_us;
  return true;
}

void PerceivedLadder::tell(int index, const simulator::LadderRung& rung,
                           const Eigen::Isometry3d& T_odom_world) {
  const Eigen::Vector3d error_m =
      bias_m_[static_cast<std::size_t>(index)] + within(params_.jitter_m, rng_);
  climb::RungView told;
  told.id = index;
  told.trusted = true;
  told.damaged = index == withdrawn_rung;
  told.confidence = 1.0;
  told.end0_m = T_odom_world * rung.end1_m + error_m;  // the left end first
  told.end1_m = T_odom_world * rung.end0_m + error_m;
  told.radius_m = rung.radius_m;
  told.covariance_m2 = kSigma_m * kSigma_m * Eigen::Matrix3d::Identity();
  const double length_m = (told.end1_m - told.end0_m).norm();
  stretches_.push_back(
      {static_cast<int>(rungs_.size()), params_.stretch_end_m, length_m - params_.stretch_end_m});
  rungs_.push_back(told);
}

climb::LadderView PerceivedLadder::view() const {
  return {rungs_, stretches_, 0.0, rungs_.size() >= 3};
}

}  // namespace robot_in_a_box
