// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/sensor_messages.h"

#include <algorithm>
#include <string>

namespace simulator {
namespace {

void copy(const Eigen::Isometry3d& pose, double (&position_m)[3], double (&quaternion)[4]) {
  const Eigen::Quaterniond q(pose.linear());
  for (int k = 0; k < 3; ++k) position_m[k] = pose.translation()[k];
  quaternion[0] = q.w();
  quaternion[1] = q.x();
  quaternion[2] = q.y();
  quaternion[3] = q.z();
}

}  // namespace

ladder_msgs::tof_frame_t frame_message(const HeadRenderer& head, const SensorParams& sensor,
                                       const HeadImage& image) {
  using ladder_msgs::tof_frame_t;
  const Pinhole& pinhole = head.pinhole();
  tof_frame_t frame{};
  frame.depth_kind = sensor.radial ? tof_frame_t::DEPTH_RADIAL : tof_frame_t::DEPTH_Z;
  frame.width_px = static_cast<std::int16_t>(pinhole.width_px);
  frame.height_px = static_cast<std::int16_t>(pinhole.height_px);
  frame.fx_px = pinhole.fx_px;
  frame.fy_px = pinhole.fy_px;
  frame.cx_px = pinhole.cx_px;
  frame.cy_px = pinhole.cy_px;
  frame.range_min_m = sensor.range_min_m;
  frame.range_max_m = sensor.wrap_range_m > 0.0 ? std::min(sensor.wrap_range_m, sensor.range_max_m)
                                                : sensor.range_max_m;
  frame.wrap_range_m = sensor.wrap_range_m;
  copy(head.T_body_head_nominal(), frame.p_body_head_m, frame.q_body_head);
  frame.depth_mm = image.depth_mm;
  frame.confidence = image.confidence;
  frame.num_pixels = static_cast<std::int32_t>(frame.depth_mm.size());
  frame.num_confidence = static_cast<std::int32_t>(frame.confidence.size());
  return frame;
}

ladder_msgs::truth_t scene_truth(const Scene& scene, const RungVisibility& seen,
                                 const Eigen::Isometry3d& T_odom_world,
                                 const Eigen::Isometry3d& T_world_body) {
  ladder_msgs::truth_t truth{};
  truth.scene = std::string(to_string(scene.params.kind)) + " " + std::to_string(scene.params.seed);
  truth.is_ladder = is_ladder(scene.params.kind) ? 1 : 0;
  copy(T_odom_world * T_world_body, truth.p_odom_body_m, truth.q_odom_body);
  for (std::size_t i = 0; i < scene.rungs.size(); ++i) {
    const Rung& rung = scene.rungs[i];
    const Eigen::Vector3f end0 = (T_odom_world * rung.end0_m).cast<float>();
    const Eigen::Vector3f end1 = (T_odom_world * rung.end1_m).cast<float>();
    truth.rung_id.push_back(rung.id);
    truth.rung_kind.push_back(static_cast<std::uint8_t>(rung.kind));
    truth.rung_x0_m.push_back(end0.x());
    truth.rung_y0_m.push_back(end0.y());
    truth.rung_z0_m.push_back(end0.z());
    truth.rung_x1_m.push_back(end1.x());
    truth.rung_y1_m.push_back(end1.y());
    truth.rung_z1_m.push_back(end1.z());
    truth.rung_radius_m.push_back(static_cast<float>(rung.radius_m));
    truth.rung_hits.push_back(seen.hits(i));
    truth.rung_visible.push_back(seen.visible_share(i));
  }
  truth.num_rungs = static_cast<std::int32_t>(scene.rungs.size());
  for (const Rail& rail : scene.rails) {
    const Eigen::Vector3f end0 = (T_odom_world * rail.end0_m).cast<float>();
    const Eigen::Vector3f end1 = (T_odom_world * rail.end1_m).cast<float>();
    truth.rail_x0_m.push_back(end0.x());
    truth.rail_y0_m.push_back(end0.y());
    truth.rail_z0_m.push_back(end0.z());
    truth.rail_x1_m.push_back(end1.x());
    truth.rail_y1_m.push_back(end1.y());
    truth.rail_z1_m.push_back(end1.z());
    truth.rail_half_width_m.push_back(static_cast<float>(rail.half_width_m));
  }
  truth.num_rails = static_cast<std::int32_t>(scene.rails.size());
  return truth;
}

}  // namespace simulator
