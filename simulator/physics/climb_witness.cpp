// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/physics/climb_witness.h"

#include <cstdio>
#include <fstream>
#include <utility>

#include "runtime/channels.h"

namespace simulator {
namespace {

using ladder_msgs::climb_state_t;
namespace channels = runtime::channels;

LimbPhase phase_of(std::int8_t limb_state) {
  switch (limb_state) {
    case climb_state_t::LIMB_LOADED:
      return LimbPhase::kHolds;
    case climb_state_t::LIMB_CLOSING:
    case climb_state_t::LIMB_VERIFY:
    case climb_state_t::LIMB_LOADING:
      return LimbPhase::kTries;
    default:
      return LimbPhase::kAway;
  }
}

}  // namespace

ClimbWitness::ClimbWitness(const std::string& url, std::vector<int> unsafe_rungs)
    : bus_(url),
      states_(bus_.newest(channels::kClimb)),
      poses_(bus_.newest(channels::kPose)),
      figures_(std::move(unsafe_rungs)) {}

void ClimbWitness::see(const PlantTruth& truth, double wall_s) {
  bus_.drain();
  if (const climb_state_t* state = states_.take(0)) state_ = *state;
  if (const ladder_msgs::pose_t* pose = poses_.take(0)) {
    const double* q = pose->q_odom_body;
    T_odom_body_.linear() = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
    T_odom_body_.translation() = Eigen::Map<const Eigen::Vector3d>(pose->p_odom_body_m);
  }
  ClimbMoment moment{truth.time_us, truth, {}, T_odom_body_};
  for (std::size_t leg = 0; leg < kNumLegs; ++leg) {
    moment.limbs[leg] = phase_of(state_.limb_state[leg]);
  }
  moment.climbs = state_.state == climb_state_t::STATE_CLIMBING;
  figures_.see(moment);
  top_reached_ = top_reached_ || (state_.at_top != 0 && state_.state == climb_state_t::STATE_HOLD);
  simulated_s_ = 1e-6 * static_cast<double>(truth.time_us);
  wall_s_ = wall_s;
  tell_progress(truth);
}

void ClimbWitness::tell_progress(const PlantTruth& truth) {
  const Figures& f = figures_.told();
  if (f.rungs_climbed == told_rungs_) return;
  told_rungs_ = f.rungs_climbed;
  std::printf(
      "%6.1f s  rung %d climbed, body at %.2f m, %d of %d grasps failed, at most %.1f Nm, %.0f N, "
      "pose off by %.0f mm\n",
      simulated_s_, f.rungs_climbed, truth.T_world_body.translation().z(), f.grasps_failed,
      f.grasps_tried, f.peak_joint_torque_Nm, f.peak_grip_N, f.pose_drift_mm);
  std::fflush(stdout);
}

bool ClimbWitness::write(const std::string& path) const {
  char real_time[60];
  std::snprintf(real_time, sizeof real_time, "%.3f", wall_s_ > 0.0 ? simulated_s_ / wall_s_ : 0.0);
  std::ofstream file(path);
  file << "{\"top_reached\": " << (top_reached_ ? "true" : "false") << ", "
       << json_members(figures_.told()) << ", \"real_time_factor\": " << real_time << "}\n";
  return static_cast<bool>(file.flush());
}

}  // namespace simulator
