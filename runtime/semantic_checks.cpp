// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/semantic_checks.h"

#include <bitset>

#include "ladder_msgs/encode_guard.hpp"
#include "runtime/printable_text.h"
#include "runtime/value_rules.h"

namespace runtime {
namespace {

using namespace rules;  // NOLINT(google-build-using-namespace): the rules are this file's language

constexpr double kMaxSpeed_m_s = 1e3;
constexpr double kMaxAcceleration_m_s2 = 1e3;
constexpr double kMaxTurnRate_rad_s = 1e3;
constexpr double kMaxFocalLength_px = 1e5;
constexpr double kMaxSide_px = 1024;
constexpr double kMaxAngle_rad = 1e4;
constexpr double kMaxTorque_Nm = 1e4;
constexpr double kLargest = 1e12;  // of sums without a natural bound

Reject verdict(bool is_sound) {
  return is_sound ? Reject::kNone : Reject::kValue;
}

template <class Msg>
bool is_stamped(const Msg& m) {
  return m.utime > 0 && m.seq >= 0;
}

template <class Msg>
bool is_body_pose(const Msg& m) {
  return are_positions(m.p_odom_body_m) && is_unit(m.q_odom_body);
}

/// The part that a topology copies from its cloud.
template <class Msg>
bool is_view(const Msg& m) {
  return all_within(m.head_state, 0, ladder_msgs::point_cloud_t::HEAD_DEAD) &&
         are_positions(m.head_x_m, m.head_y_m, m.head_z_m) && is_body_pose(m) &&
         m.range_max_m > 0.0F && within(m.range_max_m, 0.0, kPositionLimit_m) &&
         m.pixel_pitch_rad > 0.0F && within(m.pixel_pitch_rad, 0.0, 1.0);
}

bool is_known_service(std::int8_t service) {
  return within(service, ladder_msgs::health_t::SERVICE_SENSOR,
                ladder_msgs::health_t::SERVICE_VIEWER);
}

}  // namespace

Reject check_values(const ladder_msgs::command_t& m) {
  return verdict(is_stamped(m) && m.session_id >= 0 &&
                 within(m.order, m.ORDER_NONE, m.ORDER_DISARM));
}

namespace {

bool are_drives(const ladder_msgs::climb_state_t& m) {
  return within(m.bus_phase, 0, m.BUS_FAULTED) && within(m.has_targets, 0, 1) &&
         all_within(m.is_heard, 0, 1) && all_within(m.wanted_rad, -kMaxAngle_rad, kMaxAngle_rad) &&
         all_within(m.measured_rad, -kMaxAngle_rad, kMaxAngle_rad) &&
         all_within(m.torque_Nm, -kMaxTorque_Nm, kMaxTorque_Nm) &&
         all_within(m.drive_state, 0, m.DRIVE_FAULT) && all_at_least(m.error_code, 0);
}

bool are_cycles(const ladder_msgs::climb_state_t& m) {
  return m.cycles >= 0 && m.overruns >= 0 && m.cycle_p50_us >= -1 && m.cycle_p99_us >= -1 &&
         m.cycle_max_us >= -1 && m.late_p99_us >= -1 && m.late_max_us >= -1;
}

}  // namespace

Reject check_values(const ladder_msgs::climb_state_t& m) {
  const bool is_state = m.session_id > 0 && within(m.state, 0, m.STATE_DISARMING) &&
                        within(m.reason, 0, m.REASON_PERCEPTION_SILENT) &&
                        within(m.refusal, 0, m.REFUSAL_RUNG_MISSING) &&
                        within(m.burden, 0, m.BURDEN_TORQUE) &&
                        within(m.policy, 0, m.POLICY_NO_POWER_OFF_HOLD) && within(m.at_top, 0, 1) &&
                        within(m.body_shift, 0, 1);
  const bool is_answer = within(m.order, 0, ladder_msgs::command_t::ORDER_DISARM) &&
                         m.order_seq >= -1 && within(m.order_verdict, 0, m.VERDICT_NOT_NOW);
  const bool are_limbs =
      within(m.estop_active, 0, 1) && within(m.lines_lost, 0, 1) && all_within(m.touch, 0, 1) &&
      all_within(m.limb_state, 0, m.LIMB_SUPPORT_LOST) && all_at_least(m.rung_id, -1);
  return verdict(is_stamped(m) && is_state && is_answer && are_limbs && are_drives(m) &&
                 are_cycles(m));
}

Reject check_values(const ladder_msgs::config_t& m) {
  return verdict(encodable(m) && is_stamped(m) && is_known_service(m.service) &&
                 is_printable_utf8(m.version, LineBreaks::kRefused) &&
                 is_printable_utf8(m.toml, LineBreaks::kAllowed));
}

Reject check_values(const ladder_msgs::event_t& m) {
  return verdict(encodable(m) && is_stamped(m) && is_known_service(m.service) &&
                 within(m.level, ladder_msgs::event_t::LEVEL_INFO, m.LEVEL_ERROR) &&
                 is_printable_utf8(m.text, LineBreaks::kRefused));
}

Reject check_values(const ladder_msgs::imu_t& m) {
  return verdict(is_stamped(m) &&
                 all_within(m.accelerometer_m_s2, -kMaxAcceleration_m_s2, kMaxAcceleration_m_s2) &&
                 all_within(m.gyroscope_rad_s, -kMaxTurnRate_rad_s, kMaxTurnRate_rad_s));
}

Reject check_values(const ladder_msgs::pose_t& m) {
  return verdict(is_stamped(m) && is_body_pose(m) &&
                 within(m.sigma_position_m, 0.0, kPositionLimit_m) &&
                 within(m.sigma_angle_rad, 0.0, 10.0));
}

Reject check_values(const ladder_msgs::tof_frame_t& m) {
  const bool is_image = within(m.width_px, 1, kMaxSide_px) && within(m.height_px, 1, kMaxSide_px) &&
                        m.num_pixels == m.width_px * m.height_px &&
                        (m.num_confidence == 0 || m.num_confidence == m.num_pixels);
  const bool is_camera = within(m.depth_kind, m.DEPTH_Z, m.DEPTH_RADIAL) &&
                         within(m.fx_px, 1.0, kMaxFocalLength_px) &&
                         within(m.fy_px, 1.0, kMaxFocalLength_px) &&
                         within(m.cx_px, -kMaxFocalLength_px, kMaxFocalLength_px) &&
                         within(m.cy_px, -kMaxFocalLength_px, kMaxFocalLength_px);
  const bool are_ranges =
      within(m.range_min_m, 0.0, kPositionLimit_m) && m.range_min_m < m.range_max_m &&
      within(m.range_max_m, 0.0, kPositionLimit_m) && within(m.wrap_range_m, 0.0, kPositionLimit_m);
  return verdict(encodable(m) && is_stamped(m) && within(m.head, 0, 3) && is_image && is_camera &&
                 are_ranges && are_positions(m.p_body_head_m) && is_unit(m.q_body_head) &&
                 all_at_least(m.depth_mm, 0));
}

Reject check_values(const ladder_msgs::point_cloud_t& m) {
  return verdict(encodable(m) && is_stamped(m) && all_at_least(m.head_utime, 0) && is_view(m) &&
                 within(m.pose_source, 0, m.POSE_ODOMETRY) && are_positions(m.x_m, m.y_m, m.z_m) &&
                 all_within(m.head, 0, 3));
}

namespace {

bool are_nodes(const ladder_msgs::topology_t& m) {
  return strictly_ascending(m.node_id) && all_at_least(m.node_id, 0) &&
         are_positions(m.node_x_m, m.node_y_m, m.node_z_m) &&
         all_within(m.node_strength, 0.0, kLargest) && all_within(m.node_error_m2, 0.0, kLargest) &&
         all_within(m.node_utility_m2, 0.0, kLargest) &&
         all_within(m.node_class, 0, m.CLASS_OBSTACLE) &&
         are_indices(m.node_object, m.num_objects, -1) &&
         are_indices(m.node_plane, m.num_planes, -1);
}

bool are_moments(const ladder_msgs::topology_t& m) {
  const auto is_positive = [](float weight) { return weight > 0.0F; };
  return are_indices(m.moment_node, m.num_nodes) && all_within(m.moment_head, 0, 3) &&
         pairs_ascending(m.moment_node, m.moment_head) &&
         all_within(m.moment_weight, 0.0, kLargest) &&
         std::all_of(m.moment_weight.begin(), m.moment_weight.end(), is_positive) &&
         are_positions(m.moment_x_m, m.moment_y_m, m.moment_z_m) &&
         are_covariances(m.moment_xx_m2, m.moment_xy_m2, m.moment_xz_m2, m.moment_yy_m2,
                         m.moment_yz_m2, m.moment_zz_m2);
}

/// Ascending nodes: the first is at least 0 and the last exists, so all do.
bool are_edges_and_faces(const ladder_msgs::topology_t& m) {
  return all_at_least(m.edge_a, 0) && each_less(m.edge_a, m.edge_b) &&
         are_indices(m.edge_b, m.num_nodes) && all_at_least(m.face_a, 0) &&
         each_less(m.face_a, m.face_b) && each_less(m.face_b, m.face_c) &&
         are_indices(m.face_c, m.num_nodes) && are_indices(m.face_label, m.num_labels);
}

/// The normal of a label is a mean of unit vectors: it may be shorter than 1.
bool are_labels(const ladder_msgs::topology_t& m) {
  constexpr double kLimit = 1.0 + kUnitTolerance;
  return all_within(m.label_class, 0, m.CLASS_OBSTACLE) &&
         all_within(m.label_normal_x, -kLimit, kLimit) &&
         all_within(m.label_normal_y, -kLimit, kLimit) &&
         all_within(m.label_normal_z, -kLimit, kLimit) &&
         all_within(m.label_area_m2, 0.0, kLargest) &&
         all_within(m.label_safety, -kUnitTolerance, kLimit);
}

bool are_planes_and_objects(const ladder_msgs::topology_t& m) {
  const auto are_speeds = [](const auto& values) {
    return all_within(values, -kMaxSpeed_m_s, kMaxSpeed_m_s);
  };
  const auto are_sizes = [](const auto& values) {
    return all_within(values, 0.0, 2.0 * kPositionLimit_m);
  };
  return are_unit(m.plane_normal_x, m.plane_normal_y, m.plane_normal_z) &&
         are_positions(m.plane_offset_m) && all_within(m.plane_class, 0, m.CLASS_OBSTACLE) &&
         all_within(m.object_suspected, 0, 1) &&
         are_positions(m.object_x_m, m.object_y_m, m.object_z_m) && are_sizes(m.object_size_x_m) &&
         are_sizes(m.object_size_y_m) && are_sizes(m.object_size_z_m) &&
         are_speeds(m.object_velocity_x_m_s) && are_speeds(m.object_velocity_y_m_s) &&
         are_speeds(m.object_velocity_z_m_s);
}

}  // namespace

Reject check_values(const ladder_msgs::topology_t& m) {
  return verdict(encodable(m) && is_stamped(m) && m.cloud_seq >= 0 && is_view(m) && are_nodes(m) &&
                 are_moments(m) && are_edges_and_faces(m) && are_labels(m) &&
                 are_planes_and_objects(m));
}

namespace {

bool are_rungs(const ladder_msgs::ladder_t& m) {
  const int kAllFlags = m.FLAG_STUB | m.FLAG_BENT | m.FLAG_SAGGED | m.FLAG_TILTED;
  return all_at_least(m.rung_id, 0) && all_within(m.rung_state, 0, m.RUNG_TRUSTED) &&
         all_at_least(m.rung_age, 0) && all_within(m.rung_confidence, 0.0, 1.0) &&
         all_within(m.rung_evaluation, 0.0, kLargest) && all_at_least(m.rung_inliers, 0) &&
         all_at_least(m.rung_outliers, 0) &&
         are_positions(m.rung_x0_m, m.rung_y0_m, m.rung_z0_m, m.rung_x1_m, m.rung_y1_m,
                       m.rung_z1_m) &&
         all_within(m.rung_radius_m, 0.0, kPositionLimit_m) &&
         all_within(m.rung_sag_m, 0.0, kPositionLimit_m) &&
         all_within(m.rung_flags, 0, kAllFlags) &&
         are_covariances(m.rung_cov_xx_m2, m.rung_cov_xy_m2, m.rung_cov_xz_m2, m.rung_cov_yy_m2,
                         m.rung_cov_yz_m2, m.rung_cov_zz_m2);
}

bool are_intervals(const ladder_msgs::ladder_t& m) {
  for (std::int32_t i = 0; i < m.num_intervals; ++i) {
    if (!(m.interval_from_m[i] <= m.interval_to_m[i])) return false;
  }
  return are_indices(m.interval_rung, m.num_rungs) &&
         are_positions(m.interval_from_m, m.interval_to_m) &&
         pairs_ascending(m.interval_rung, m.interval_from_m) &&
         all_within(m.interval_reason, m.REASON_NONE, m.REASON_TOO_DEEP);
}

bool are_grasps(const ladder_msgs::ladder_t& m) {
  if (!are_indices(m.grasp_rung, m.num_rungs)) return false;
  std::bitset<ladder_msgs::ladder_t::MAX_RUNGS> has_grasp;
  for (const std::int32_t rung : m.grasp_rung) {
    if (has_grasp.test(rung)) return false;
    has_grasp.set(rung);
  }
  return are_positions(m.grasp_x_m, m.grasp_y_m, m.grasp_z_m) &&
         are_unit(m.grasp_approach_x, m.grasp_approach_y, m.grasp_approach_z) &&
         all_within(m.grasp_approach_z, -kUnitTolerance, kUnitTolerance) &&
         all_within(m.grasp_confidence, 0.0, 1.0);
}

}  // namespace

Reject check_values(const ladder_msgs::ladder_t& m) {
  const bool is_spacing = within(m.spacing_m, 0.0, kPositionLimit_m) &&
                          within(m.spacing_sigma_m, 0.0, kPositionLimit_m) &&
                          (m.spacing_m > 0.0F) == (m.ladder_state == m.LADDER_CONFIRMED);
  return verdict(
      encodable(m) && is_stamped(m) && m.topology_seq >= 0 &&
      within(m.ladder_state, 0, m.LADDER_CONFIRMED) && is_spacing && are_rungs(m) &&
      are_positions(m.rail_x0_m, m.rail_y0_m, m.rail_z0_m, m.rail_x1_m, m.rail_y1_m, m.rail_z1_m) &&
      are_intervals(m) && are_grasps(m));
}

Reject check_values(const ladder_msgs::health_t& m) {
  const std::int64_t kAllFlags = m.FLAG_SMALL_SOCKET_BUFFER | m.FLAG_HEAD_DEAD |
                                 m.FLAG_NO_ODOMETRY | m.FLAG_NO_GRAVITY | m.FLAG_PUBLISH_FAILED;
  const std::int64_t rejected[] = {m.rejected_size,   m.rejected_fingerprint, m.rejected_count,
                                   m.rejected_string, m.rejected_trailing,    m.rejected_depth,
                                   m.rejected_value,  m.rejected_stale};
  const bool is_process = is_known_service(m.service) && within(m.state, 0, m.STATE_STOPPING) &&
                          m.pid >= 0 && m.start_utime >= 0 && m.steps >= 0 &&
                          (m.flags & ~kAllFlags) == 0 &&
                          all_within(m.head_state, 0, ladder_msgs::point_cloud_t::HEAD_DEAD);
  const bool are_inputs = all_within(m.input_channel, m.CHANNEL_TOF_0, m.CHANNEL_SIM) &&
                          all_at_least(m.input_received, 0) && all_at_least(m.input_lost, 0) &&
                          all_at_least(m.input_overwritten, 0) &&
                          all_at_least(m.input_rejected, 0) &&
                          all_at_least(m.input_age_p50_us, -1) &&
                          all_at_least(m.input_age_p99_us, -1) && all_at_least(rejected, 0);
  const bool are_stages = all_at_least(m.stage_p50_us, -1) && all_at_least(m.stage_p95_us, -1) &&
                          all_at_least(m.stage_max_us, -1);
  return verdict(encodable(m) && is_stamped(m) && is_process && are_inputs && are_stages);
}

Reject check_values(const ladder_msgs::truth_t& m) {
  const bool are_rungs =
      strictly_ascending(m.rung_id) && all_at_least(m.rung_id, 0) &&
      all_within(m.rung_kind, 0, m.RUNG_BAR) &&
      are_positions(m.rung_x0_m, m.rung_y0_m, m.rung_z0_m, m.rung_x1_m, m.rung_y1_m, m.rung_z1_m) &&
      all_within(m.rung_radius_m, 0.0, kPositionLimit_m) && all_at_least(m.rung_hits, 0) &&
      all_within(m.rung_visible, 0.0, 1.0);
  return verdict(
      encodable(m) && is_stamped(m) && is_printable_utf8(m.scene, LineBreaks::kRefused) &&
      within(m.is_ladder, 0, 1) && is_body_pose(m) && are_rungs &&
      are_positions(m.rail_x0_m, m.rail_y0_m, m.rail_z0_m, m.rail_x1_m, m.rail_y1_m, m.rail_z1_m) &&
      all_within(m.rail_half_width_m, 0.0, kPositionLimit_m));
}

}  // namespace runtime
