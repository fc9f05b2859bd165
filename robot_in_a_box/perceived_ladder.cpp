// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/perceived_ladder.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/plant/truth_perception.h"

namespace robot_in_a_box {
namespace {

constexpr std::int64_t kDelay_us = 20'000;  ///< from measurement to message
constexpr float kSigma_m = 0.002F;

Eigen::Vector3d within(double limit_m, base::Rng& rng) {
  Eigen::Vector3d error;
  for (int i = 0; i < 3; ++i) error[i] = limit_m * (2.0 * rng.uniform() - 1.0);
  return error;
}

}  // namespace

PerceivedLadder::PerceivedLadder(const PerceptionParams& params, std::uint64_t seed)
    : params_(params), rng_(seed), tilt_rng_(seed, 1) {
  newest_.reserve();
}

void PerceivedLadder::update(std::int64_t now_us, const simulator::RobotPlant& plant,
                             const Eigen::Isometry3d& T_odom_body) {
  const auto rungs = plant.world().rungs();
  while (bias_m_.size() < rungs.size()) bias_m_.push_back(within(params_.bias_m, rng_));
  while (tilt_rad_.size() < rungs.size()) tilt_rad_.push_back(within(params_.tilt_rad, tilt_rng_));
  if (now_us < next_us_) return;
  next_us_ += params_.period_us;
  if (silent) return;
  tell(now_us, plant, T_odom_body * plant.T_world_body().inverse());
  spoil();
  repeat(now_us);
}

void PerceivedLadder::repeat(std::int64_t now_us) {
  inbox_.accept(message_, {now_us, kEpoch_us + wall_step_us + now_us}, newest_);
}

void PerceivedLadder::tell(std::int64_t now_us, const simulator::RobotPlant& plant,
                           const Eigen::Isometry3d& T_odom_world) {
  message_ = {};
  message_.utime = kEpoch_us + wall_step_us + now_us - kDelay_us;
  message_.seq = seq_++;
  const auto rungs = plant.world().rungs();
  const double body_m = plant.T_world_body().translation().z();
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    const double above_m = rungs[i].end0_m.z() - body_m;
    const bool is_seen =
        !rungs[i].broken && above_m >= seen_from_m && std::fabs(above_m) <= params_.range_m;
    if (is_seen) add_rung(static_cast<int>(i), rungs[i], T_odom_world);
  }
  const bool is_ladder = message_.num_rungs >= 3;
  message_.ladder_state = is_ladder ? message_.LADDER_CONFIRMED : message_.LADDER_NONE;
  message_.spacing_m = is_ladder ? 0.3F : 0.0F;
}

void PerceivedLadder::add_rung(int index, const simulator::LadderRung& rung,
                               const Eigen::Isometry3d& T_odom_world) {
  const Eigen::Vector3d error_m =
      bias_m_[static_cast<std::size_t>(index)] + within(params_.jitter_m, rng_);
  const Eigen::Vector3d half_m = 0.5 * (rung.end1_m - rung.end0_m);
  const Eigen::Vector3d turned_m = tilt_rad_[static_cast<std::size_t>(index)].cross(half_m);
  const bool is_damaged =
      index == withdrawn_rung ||
      std::find(damaged_rungs.begin(), damaged_rungs.end(), index) != damaged_rungs.end();
  simulator::ToldRung told;
  told.id = index;
  told.left_m = (T_odom_world * (rung.end1_m + turned_m) + error_m).cast<float>();
  told.right_m = (T_odom_world * (rung.end0_m - turned_m) + error_m).cast<float>();
  told.radius_m = static_cast<float>(rung.radius_m);
  told.sigma_m = kSigma_m;
  told.from_end_m = static_cast<float>(params_.stretch_end_m);
  if (is_damaged) told.flags = ladder_msgs::ladder_t::FLAG_BENT;
  simulator::append(message_, told);
}

void PerceivedLadder::spoil() {
  const bool has_rung = message_.num_rungs > 0;
  switch (nonsense) {
    case Nonsense::kNone:
      good_seq_ = message_.seq;
      good_utime_us_ = message_.utime;
      return;
    case Nonsense::kRepeated:
      message_.seq = good_seq_;
      message_.utime = good_utime_us_;
      return;
    case Nonsense::kReordered:
      message_.seq = good_seq_ - 1;
      message_.utime = good_utime_us_ - params_.period_us;
      return;
    case Nonsense::kOld:
      message_.utime -= 1'000'000;
      return;
    case Nonsense::kAhead:
      message_.utime += 3'600'000'000;
      return;
    case Nonsense::kNotFinite:
      if (has_rung) message_.rung_z0_m[0] = std::numeric_limits<float>::quiet_NaN();
      return;
    case Nonsense::kHuge:
      if (has_rung) message_.rung_x1_m[0] = 1e30F;
      return;
    case Nonsense::kBadCount:
      message_.num_rungs += 5;
      return;
  }
}

}  // namespace robot_in_a_box
