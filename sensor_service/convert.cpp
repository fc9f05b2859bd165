// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_service/convert.h"

namespace sensor_service {
namespace {

tof::Pose pose_of(const double (&p_m)[3], const double (&q)[4]) {
  return {.p_m = {p_m[0], p_m[1], p_m[2]}, .q = {q[0], q[1], q[2], q[3]}};
}

void copy(const tof::Pose& pose, double (&p_m)[3], double (&q)[4]) {
  for (int axis = 0; axis < 3; ++axis) p_m[axis] = pose.p_m[axis];
  q[0] = pose.q.w();
  q[1] = pose.q.x();
  q[2] = pose.q.y();
  q[3] = pose.q.z();
}

}  // namespace

tof::DepthFrame to_depth_frame(const ladder_msgs::tof_frame_t& message) {
  tof::DepthFrame frame;
  frame.utime_us = message.utime;
  frame.seq = message.seq;
  frame.head = message.head;
  frame.depth_kind = static_cast<tof::DepthKind>(message.depth_kind);
  frame.width_px = message.width_px;
  frame.height_px = message.height_px;
  frame.intrinsics = {.fx_px = message.fx_px,
                      .fy_px = message.fy_px,
                      .cx_px = message.cx_px,
                      .cy_px = message.cy_px};
  frame.range_min_m = message.range_min_m;
  frame.range_max_m = message.range_max_m;
  frame.wrap_range_m = message.wrap_range_m;
  frame.T_body_head = pose_of(message.p_body_head_m, message.q_body_head);
  frame.depth_mm = message.depth_mm;
  frame.confidence = message.confidence;
  return frame;
}

tof::ImuSample to_imu_sample(const ladder_msgs::imu_t& message) {
  const double* a = message.accelerometer_m_s2;
  const double* w = message.gyroscope_rad_s;
  return {.utime_us = message.utime,
          .accelerometer_m_s2 = {a[0], a[1], a[2]},
          .gyroscope_rad_s = {w[0], w[1], w[2]}};
}

tof::Pose to_pose(const ladder_msgs::pose_t& message) {
  return pose_of(message.p_odom_body_m, message.q_odom_body);
}

std::optional<tof::JointAngles> to_joints(const ladder_msgs::climb_state_t& message) {
  tof::JointAngles angles_rad{};
  for (int joint = 0; joint < tof::kNumJoints; ++joint) {
    if (message.is_heard[joint] == 0) return std::nullopt;
    angles_rad[static_cast<std::size_t>(joint)] = static_cast<double>(message.measured_rad[joint]);
  }
  return angles_rad;
}

void to_message(const tof::DepthFrame& frame, ladder_msgs::tof_frame_t& m) {
  m.utime = frame.utime_us;
  m.seq = frame.seq;
  m.head = static_cast<std::int8_t>(frame.head);
  m.depth_kind = static_cast<std::int8_t>(frame.depth_kind);
  m.width_px = static_cast<std::int16_t>(frame.width_px);
  m.height_px = static_cast<std::int16_t>(frame.height_px);
  m.fx_px = frame.intrinsics.fx_px;
  m.fy_px = frame.intrinsics.fy_px;
  m.cx_px = frame.intrinsics.cx_px;
  m.cy_px = frame.intrinsics.cy_px;
  m.range_min_m = frame.range_min_m;
  m.range_max_m = frame.range_max_m;
  m.wrap_range_m = frame.wrap_range_m;
  copy(frame.T_body_head, m.p_body_head_m, m.q_body_head);
  m.num_pixels = static_cast<std::int32_t>(frame.depth_mm.size());
  m.depth_mm.assign(frame.depth_mm.begin(), frame.depth_mm.end());
  m.num_confidence = static_cast<std::int32_t>(frame.confidence.size());
  m.confidence.assign(frame.confidence.begin(), frame.confidence.end());
}

void to_message(const tof::ImuSample& sample, ladder_msgs::imu_t& m) {
  m.utime = sample.utime_us;
  for (int axis = 0; axis < 3; ++axis) {
    m.accelerometer_m_s2[axis] = sample.accelerometer_m_s2[axis];
    m.gyroscope_rad_s[axis] = sample.gyroscope_rad_s[axis];
  }
}

void to_message(const tof::Cloud& cloud, ladder_msgs::point_cloud_t& m) {
  m.utime = cloud.utime_us;
  for (int head = 0; head < tof::kNumHeads; ++head) {
    m.head_utime[head] = cloud.head_utime_us[head];
    m.head_state[head] = static_cast<std::int8_t>(cloud.head_state[head]);
    m.head_x_m[head] = cloud.head_position_m[head].x();
    m.head_y_m[head] = cloud.head_position_m[head].y();
    m.head_z_m[head] = cloud.head_position_m[head].z();
  }
  const Eigen::Vector3f p_odom_body_m = cloud.T_odom_body.p_m.cast<float>();
  const Eigen::Quaternionf q_odom_body = cloud.T_odom_body.q.cast<float>();
  for (int axis = 0; axis < 3; ++axis) m.p_odom_body_m[axis] = p_odom_body_m[axis];
  m.q_odom_body[0] = q_odom_body.w();
  m.q_odom_body[1] = q_odom_body.x();
  m.q_odom_body[2] = q_odom_body.y();
  m.q_odom_body[3] = q_odom_body.z();
  m.pose_source = static_cast<std::int8_t>(cloud.pose_source);
  m.range_max_m = cloud.range_max_m;
  m.pixel_pitch_rad = cloud.pixel_pitch_rad;
  m.num_points = static_cast<std::int32_t>(cloud.size());
  m.x_m = cloud.x_m;
  m.y_m = cloud.y_m;
  m.z_m = cloud.z_m;
  m.head = cloud.head;
}

}  // namespace sensor_service
