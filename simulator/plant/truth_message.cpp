// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/truth_message.h"

namespace simulator {

ladder_msgs::truth_t truth_message(const PlantTruth& truth, const RungWorld& world,
                                   const Eigen::Vector3d& odom_origin_m, std::int64_t utime_us) {
  ladder_msgs::truth_t message{};
  message.utime = utime_us;
  message.scene = "plant";
  message.is_ladder = 1;
  const Eigen::Vector3d position = truth.T_world_body.translation() - odom_origin_m;
  const Eigen::Quaterniond rotation(truth.T_world_body.linear());
  for (int i = 0; i < 3; ++i) message.p_odom_body_m[i] = position[i];
  message.q_odom_body[0] = rotation.w();
  message.q_odom_body[1] = rotation.x();
  message.q_odom_body[2] = rotation.y();
  message.q_odom_body[3] = rotation.z();
  for (int index = 0; index < world.num_rungs(); ++index) {
    const LadderRung& rung = world.rung(index);
    if (rung.broken) continue;
    const Eigen::Vector3f end0 = (rung.end0_m - odom_origin_m).cast<float>();
    const Eigen::Vector3f end1 = (rung.end1_m - odom_origin_m).cast<float>();
    message.rung_id.push_back(index);
    message.rung_kind.push_back(ladder_msgs::truth_t::RUNG_SOUND);
    message.rung_x0_m.push_back(end0.x());
    message.rung_y0_m.push_back(end0.y());
    message.rung_z0_m.push_back(end0.z());
    message.rung_x1_m.push_back(end1.x());
    message.rung_y1_m.push_back(end1.y());
    message.rung_z1_m.push_back(end1.z());
    message.rung_radius_m.push_back(static_cast<float>(rung.radius_m));
    message.rung_hits.push_back(0);
    message.rung_visible.push_back(0.0F);
  }
  message.num_rungs = static_cast<std::int32_t>(message.rung_id.size());
  message.num_rails = 0;
  return message;
}

}  // namespace simulator
