// SPDX-License-Identifier: BSD-3-Clause
// Each documented rule of each type, broken alone, is refused as kValue; the border cases that are
// allowed pass.
#include "runtime/semantic_checks.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "runtime/printable_text.h"
#include "runtime/wire_guard.h"
#include "tests/lcmtypes/sample_messages.h"
#include "tests/lcmtypes/wire_edit.h"

namespace lcmtypes {
namespace {

using runtime::Reject;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The verdict on a sound message after `edit`; it travels over the wire, as a real one would.
template <class Msg, class Edit>
Reject verdict_after(Edit edit) {
  Msg message = sample<Msg>(3, 11);
  edit(message);
  Msg received{};
  return runtime::decode_guarded(encode(message), received);
}

#define EXPECT_REFUSED(Type, statement) \
  EXPECT_EQ(verdict_after<ladder_msgs::Type>([](auto& m) { statement; }), Reject::kValue)
#define EXPECT_ACCEPTED(Type, statement) \
  EXPECT_EQ(verdict_after<ladder_msgs::Type>([](auto& m) { statement; }), Reject::kNone)

template <class Msg>
void expect_stamp_rules() {
  SCOPED_TRACE(Msg::getTypeName());
  EXPECT_EQ(verdict_after<Msg>([](Msg&) {}), Reject::kNone);
  EXPECT_EQ(verdict_after<Msg>([](Msg& m) { m.utime = 0; }), Reject::kValue);
  EXPECT_EQ(verdict_after<Msg>([](Msg& m) { m.utime = -5; }), Reject::kValue);
  EXPECT_EQ(verdict_after<Msg>([](Msg& m) { m.seq = -1; }), Reject::kValue);
  EXPECT_EQ(verdict_after<Msg>([](Msg& m) { m.seq = 0; }), Reject::kNone);
}

// Every message carries a time after the epoch and a sequence number from 0 on.
TEST(SemanticChecks, Stamps) {
  for_each_message_type([]<class Msg>(std::type_identity<Msg>) { expect_stamp_rules<Msg>(); });
}

/// The bytes of +infinity, quiet NaN and -infinity as the wire has them: big-endian.
std::vector<std::vector<std::uint8_t>> not_finite(runtime::WireKind kind) {
  if (kind == runtime::WireKind::kFloat) {
    return {{0x7f, 0x80, 0, 0}, {0x7f, 0xc0, 0, 0}, {0xff, 0x80, 0, 0}};
  }
  return {{0x7f, 0xf0, 0, 0, 0, 0, 0, 0},
          {0x7f, 0xf8, 0, 0, 0, 0, 0, 0},
          {0xff, 0xf0, 0, 0, 0, 0, 0, 0}};
}

template <class Msg>
void expect_only_finite_values() {
  const auto& type = runtime::kWireTypeOf<Msg>;
  const auto bytes = encode(sample<Msg>(3, 11));
  for (const Place& place : places(bytes, type)) {
    const runtime::WireKind kind = place.field->kind;
    if (kind != runtime::WireKind::kFloat && kind != runtime::WireKind::kDouble) continue;
    ASSERT_GT(place.elements, 0) << "the sample leaves " << place.field->name << " untested";
    for (const auto& value : not_finite(kind)) {
      auto damaged = bytes;
      const std::size_t last = static_cast<std::size_t>(place.elements - 1) * value.size();
      std::copy(value.begin(), value.end(), damaged.begin() + place.offset + last);
      Msg received{};
      EXPECT_EQ(runtime::decode_guarded(damaged, received), Reject::kValue)
          << type.name << "." << place.field->name;
    }
  }
}

// No field of no type may be infinite or NaN.
TEST(SemanticChecks, EveryNumberIsFinite) {
  for_each_message_type(
      []<class Msg>(std::type_identity<Msg>) { expect_only_finite_values<Msg>(); });
}

// A frame names its head, its camera and its ranges; its image has the size it says.
TEST(SemanticChecks, TofFrame) {
  EXPECT_REFUSED(tof_frame_t, m.head = 4);
  EXPECT_REFUSED(tof_frame_t, m.head = -1);
  EXPECT_REFUSED(tof_frame_t, m.depth_kind = m.DEPTH_UNKNOWN);
  EXPECT_REFUSED(tof_frame_t, m.depth_kind = 3);
  EXPECT_REFUSED(tof_frame_t, m.width_px += 1);
  EXPECT_REFUSED(tof_frame_t, (m.width_px = -m.width_px, m.height_px = -m.height_px));
  EXPECT_REFUSED(tof_frame_t, (m.width_px = 0, m.num_pixels = 0, m.depth_mm.clear(),
                               m.num_confidence = 0, m.confidence.clear()));
  EXPECT_REFUSED(tof_frame_t, (m.height_px = 0, m.num_pixels = 0, m.depth_mm.clear(),
                               m.num_confidence = 0, m.confidence.clear()));
  EXPECT_REFUSED(tof_frame_t, (m.num_confidence = 1, m.confidence.assign(1, 0)));
  EXPECT_ACCEPTED(tof_frame_t, (m.num_confidence = 0, m.confidence.clear()));
  EXPECT_REFUSED(tof_frame_t, m.fx_px = 0.0);
  EXPECT_REFUSED(tof_frame_t, m.fy_px = -100.0);
  EXPECT_REFUSED(tof_frame_t, m.cx_px = std::nan(""));
  EXPECT_REFUSED(tof_frame_t, m.cy_px = HUGE_VAL);
  EXPECT_REFUSED(tof_frame_t, m.range_max_m = m.range_min_m);
  EXPECT_REFUSED(tof_frame_t, m.range_min_m = -0.1);
  EXPECT_REFUSED(tof_frame_t, m.range_max_m = std::nan(""));
  EXPECT_REFUSED(tof_frame_t, m.wrap_range_m = -1.0);
  EXPECT_REFUSED(tof_frame_t, m.q_body_head[0] += 0.01);
  EXPECT_REFUSED(tof_frame_t, std::fill_n(m.q_body_head, 4, 0.0));
  EXPECT_REFUSED(tof_frame_t, m.p_body_head_m[2] = 1.1e4);
  EXPECT_REFUSED(tof_frame_t, m.depth_mm.back() = -1);
}

// The inertial sample is finite and physical.
TEST(SemanticChecks, Imu) {
  EXPECT_REFUSED(imu_t, m.accelerometer_m_s2[2] = std::nan(""));
  EXPECT_REFUSED(imu_t, m.gyroscope_rad_s[0] = -HUGE_VAL);
  EXPECT_REFUSED(imu_t, m.accelerometer_m_s2[0] = 1e6);
}

// A pose is near, its quaternion of unit length (1e-3 off is accepted), its sigmas not negative.
TEST(SemanticChecks, Pose) {
  EXPECT_REFUSED(pose_t, m.p_odom_body_m[0] = std::nan(""));
  EXPECT_REFUSED(pose_t, m.p_odom_body_m[1] = -2e4);
  EXPECT_REFUSED(pose_t, m.q_odom_body[3] = std::nan(""));
  EXPECT_REFUSED(pose_t, m.q_odom_body[1] *= -1.5);
  EXPECT_ACCEPTED(pose_t, for (double& q : m.q_odom_body) q *= 1.0 + 9e-4);
  EXPECT_REFUSED(pose_t, for (double& q : m.q_odom_body) q *= 1.0 + 11e-4);
  EXPECT_REFUSED(pose_t, m.sigma_position_m = -1e-9);
  EXPECT_REFUSED(pose_t, m.sigma_angle_rad = std::nan(""));
}

// An order exists; a session is never negative. A message of zeros is refused as a whole.
TEST(SemanticChecks, Command) {
  EXPECT_REFUSED(command_t, m.order = -1);
  EXPECT_REFUSED(command_t, m.order = m.ORDER_DISARM + 1);
  EXPECT_REFUSED(command_t, m.session_id = -1);
  EXPECT_REFUSED(command_t, m = {});
  EXPECT_ACCEPTED(command_t, m.order = m.ORDER_NONE);
}

// Each enumeration, flag and number of the climbing state stays in its range.
TEST(SemanticChecks, ClimbState) {
  EXPECT_REFUSED(climb_state_t, m.session_id = 0);
  EXPECT_REFUSED(climb_state_t, m.state = m.STATE_DISARMING + 1);
  EXPECT_REFUSED(climb_state_t, m.reason = m.REASON_PERCEPTION_SILENT + 1);
  EXPECT_REFUSED(climb_state_t, m.refusal = m.REFUSAL_RUNG_MISSING + 1);
  EXPECT_REFUSED(climb_state_t, m.burden = m.BURDEN_TORQUE + 1);
  EXPECT_REFUSED(climb_state_t, m.policy = m.POLICY_NO_POWER_OFF_HOLD + 1);
  EXPECT_REFUSED(climb_state_t, m.order = ladder_msgs::command_t::ORDER_DISARM + 1);
  EXPECT_REFUSED(climb_state_t, m.order_seq = -2);
  EXPECT_REFUSED(climb_state_t, m.order_verdict = m.VERDICT_NOT_NOW + 1);
  EXPECT_REFUSED(climb_state_t, m.at_top = 2);
  EXPECT_REFUSED(climb_state_t, m.estop_active = -1);
  EXPECT_REFUSED(climb_state_t, m.touch[3] = 2);
  EXPECT_REFUSED(climb_state_t, m.limb_state[2] = m.LIMB_SUPPORT_LOST + 1);
  EXPECT_REFUSED(climb_state_t, m.rung_id[0] = -2);
  EXPECT_REFUSED(climb_state_t, m.bus_phase = m.BUS_FAULTED + 1);
  EXPECT_REFUSED(climb_state_t, m.is_heard[15] = 2);
  EXPECT_REFUSED(climb_state_t, m.drive_state[7] = m.DRIVE_FAULT + 1);
  EXPECT_REFUSED(climb_state_t, m.error_code[1] = -1);
  EXPECT_REFUSED(climb_state_t, m.measured_rad[5] = 2e4F);
  EXPECT_REFUSED(climb_state_t, m.overruns = -1);
  EXPECT_REFUSED(climb_state_t, m.cycle_max_us = -2);
  EXPECT_ACCEPTED(climb_state_t, m.cycle_p50_us = -1);
}

// A cloud may be empty; its points are finite and from a head that exists.
TEST(SemanticChecks, PointCloud) {
  EXPECT_REFUSED(point_cloud_t, m.x_m.back() = kNan);
  EXPECT_REFUSED(point_cloud_t, m.y_m.front() = kInfinity);
  EXPECT_REFUSED(point_cloud_t, m.z_m[1] = -1.1e4F);
  EXPECT_REFUSED(point_cloud_t, m.head[2] = 4);
  EXPECT_REFUSED(point_cloud_t, m.head_state[3] = 3);
  EXPECT_REFUSED(point_cloud_t, m.head_utime[0] = -1);
  EXPECT_ACCEPTED(point_cloud_t, m.head_utime[0] = 0);
  EXPECT_REFUSED(point_cloud_t, m.head_z_m[0] = kNan);
  EXPECT_REFUSED(point_cloud_t, m.pose_source = 3);
  EXPECT_REFUSED(point_cloud_t, m.range_max_m = 0.0F);
  EXPECT_REFUSED(point_cloud_t, m.pixel_pitch_rad = kNan);
  EXPECT_REFUSED(point_cloud_t, m.q_odom_body[0] = 0.0F);
}

// Nodes: ids ascend, values finite and not negative, classes known, references exist or are -1.
TEST(SemanticChecks, TopologyNodesAndMoments) {
  EXPECT_REFUSED(topology_t, m.node_id[1] = m.node_id[0]);
  EXPECT_REFUSED(topology_t, m.node_id[0] = -1);
  EXPECT_REFUSED(topology_t, m.node_x_m[5] = kNan);
  EXPECT_REFUSED(topology_t, m.node_strength[0] = kInfinity);
  EXPECT_REFUSED(topology_t, m.node_error_m2[0] = -1.0F);
  EXPECT_REFUSED(topology_t, m.node_utility_m2[0] = kNan);
  EXPECT_REFUSED(topology_t, m.node_class[0] = 4);
  EXPECT_REFUSED(topology_t, m.node_object[0] = m.num_objects);
  EXPECT_REFUSED(topology_t, m.node_plane[0] = -2);
  EXPECT_ACCEPTED(topology_t, m.node_plane[0] = -1);
  EXPECT_REFUSED(topology_t, m.moment_node.back() = m.num_nodes);
  EXPECT_REFUSED(topology_t, m.moment_node[0] = -1);
  EXPECT_REFUSED(topology_t, m.moment_head.back() = 4);
  EXPECT_REFUSED(topology_t, std::swap(m.moment_node.front(), m.moment_node.back()));
  EXPECT_REFUSED(topology_t,
                 (m.moment_node[1] = m.moment_node[0], m.moment_head[1] = m.moment_head[0]));
  EXPECT_REFUSED(topology_t, m.moment_weight[0] = 0.0F);
  EXPECT_REFUSED(topology_t, m.moment_weight[0] = kNan);
  EXPECT_REFUSED(topology_t, m.moment_zz_m2[0] = -1e-6F);
  EXPECT_REFUSED(topology_t, m.moment_xy_m2[0] = kNan);
  EXPECT_ACCEPTED(topology_t, m.moment_xy_m2[0] = -0.5F);
  EXPECT_REFUSED(topology_t, m.cloud_seq = -1);
}

// Edges and faces name nodes that exist, in ascending order; the rest refers to what exists.
TEST(SemanticChecks, TopologyEdgesFacesAndSegments) {
  EXPECT_REFUSED(topology_t, m.edge_b[0] = m.edge_a[0]);
  EXPECT_REFUSED(topology_t, std::swap(m.edge_a[0], m.edge_b[0]));
  EXPECT_REFUSED(topology_t, m.edge_b[0] = m.num_nodes);
  EXPECT_REFUSED(topology_t, m.edge_a[0] = -1);
  EXPECT_REFUSED(topology_t, m.face_c[0] = m.num_nodes);
  EXPECT_REFUSED(topology_t, m.face_a[0] = -1);
  EXPECT_REFUSED(topology_t, m.face_b[0] = m.face_c[0]);
  EXPECT_REFUSED(topology_t, m.face_a[0] = m.face_b[0] + 1);
  EXPECT_REFUSED(topology_t, m.face_label[0] = m.num_labels);
  EXPECT_REFUSED(topology_t, m.face_label[0] = -1);
  EXPECT_REFUSED(topology_t, m.label_class[0] = 200);
  EXPECT_REFUSED(topology_t, m.label_normal_y[0] = kNan);
  EXPECT_REFUSED(topology_t, m.label_area_m2[0] = -1.0F);
  EXPECT_REFUSED(topology_t, m.label_safety[0] = 1.1F);
  EXPECT_REFUSED(topology_t, m.plane_normal_z[0] = 0.0F);
  EXPECT_REFUSED(topology_t, m.plane_offset_m[0] = kInfinity);
  EXPECT_REFUSED(topology_t, m.plane_class[0] = 4);
  EXPECT_REFUSED(topology_t, m.object_suspected[0] = 2);
  EXPECT_REFUSED(topology_t, m.object_size_y_m[0] = -0.1F);
  EXPECT_REFUSED(topology_t, m.object_velocity_z_m_s[0] = kNan);
}

// Rungs: known states and flags, finite axes; spacing only with a confirmed ladder.
TEST(SemanticChecks, LadderRungs) {
  EXPECT_REFUSED(ladder_t, m.ladder_state = 3);
  EXPECT_REFUSED(ladder_t, (m.ladder_state = 3, m.spacing_m = 0.0F));
  EXPECT_REFUSED(ladder_t, (m.ladder_state = m.LADDER_NONE, m.spacing_m = -0.3F));
  EXPECT_REFUSED(ladder_t, m.ladder_state = m.LADDER_NONE);
  EXPECT_REFUSED(ladder_t, m.spacing_m = 0.0F);
  EXPECT_REFUSED(ladder_t, m.spacing_sigma_m = kNan);
  EXPECT_REFUSED(ladder_t, m.topology_seq = -1);
  EXPECT_REFUSED(ladder_t, m.rung_id[0] = -1);
  EXPECT_REFUSED(ladder_t, m.rung_inliers[0] = -1);
  EXPECT_REFUSED(ladder_t, m.rung_outliers[0] = -1);
  EXPECT_REFUSED(ladder_t, m.rung_sag_m[0] = -0.01F);
  EXPECT_REFUSED(ladder_t, m.rung_state[0] = 3);
  EXPECT_REFUSED(ladder_t, m.rung_age[0] = -1);
  EXPECT_REFUSED(ladder_t, m.rung_confidence[0] = 1.01F);
  EXPECT_REFUSED(ladder_t, m.rung_evaluation[0] = kNan);
  EXPECT_REFUSED(ladder_t, m.rung_y1_m[2] = kInfinity);
  EXPECT_REFUSED(ladder_t, m.rung_radius_m[0] = -0.01F);
  EXPECT_REFUSED(ladder_t, m.rung_flags[0] = 16);
  EXPECT_REFUSED(ladder_t, m.rung_flags[0] = -1);
  EXPECT_REFUSED(ladder_t, m.rung_cov_yy_m2[0] = -1e-9F);
  EXPECT_REFUSED(ladder_t, m.rung_cov_yz_m2[0] = kNan);
  EXPECT_REFUSED(ladder_t, m.rail_z1_m[0] = kNan);
}

// Intervals and grasps belong to a rung that exists, in order, one grasp each, approached level.
TEST(SemanticChecks, LadderAffordances) {
  EXPECT_REFUSED(ladder_t, m.interval_rung.back() = m.num_rungs);
  EXPECT_REFUSED(ladder_t, m.interval_rung[0] = -1);
  EXPECT_REFUSED(ladder_t, m.interval_to_m[0] = -0.1F);
  EXPECT_REFUSED(ladder_t, m.interval_from_m[1] = kNan);
  EXPECT_REFUSED(ladder_t, m.interval_from_m[1] = m.interval_from_m[0]);
  EXPECT_REFUSED(ladder_t, m.interval_rung[0] = 1);
  EXPECT_REFUSED(ladder_t, m.interval_reason[0] = m.REASON_TOO_DEEP + 1);
  EXPECT_REFUSED(ladder_t, m.grasp_rung[0] = m.num_rungs);
  EXPECT_REFUSED(ladder_t, m.grasp_rung[1] = m.grasp_rung[0]);
  EXPECT_REFUSED(ladder_t, m.grasp_x_m[0] = kNan);
  EXPECT_REFUSED(ladder_t, m.grasp_approach_x[0] = 0.0F);
  EXPECT_REFUSED(ladder_t, (m.grasp_approach_x[0] = 0.6F, m.grasp_approach_y[0] = 0.0F,
                            m.grasp_approach_z[0] = 0.8F));
  EXPECT_REFUSED(ladder_t, m.grasp_confidence[0] = -0.1F);
}

// Health: a known service, state, flags and channels; counters never negative, ages from -1.
TEST(SemanticChecks, Health) {
  EXPECT_REFUSED(health_t, m.service = m.SERVICE_UNKNOWN);
  EXPECT_REFUSED(health_t, m.service = 7);
  EXPECT_REFUSED(health_t, m.state = 5);
  EXPECT_REFUSED(health_t, m.flags = 32);
  EXPECT_REFUSED(health_t, m.flags = std::numeric_limits<std::int64_t>::min());
  EXPECT_REFUSED(health_t, m.pid = -1);
  EXPECT_REFUSED(health_t, m.head_state[1] = -1);
  EXPECT_REFUSED(health_t, m.input_channel[0] = m.CHANNEL_UNKNOWN);
  EXPECT_REFUSED(health_t, m.input_channel[0] = 17);
  EXPECT_REFUSED(health_t, m.input_received[0] = -1);
  EXPECT_REFUSED(health_t, m.input_overwritten[0] = -1);
  EXPECT_REFUSED(health_t, m.input_rejected[0] = -1);
  EXPECT_REFUSED(health_t, m.input_age_p50_us[0] = -2);
  EXPECT_REFUSED(health_t, m.stage_p50_us[0] = -2);
  EXPECT_REFUSED(health_t, m.stage_p95_us[0] = -2);
  EXPECT_REFUSED(health_t, m.input_lost[0] = -1);
  EXPECT_REFUSED(health_t, m.input_age_p99_us[0] = -2);
  EXPECT_ACCEPTED(health_t, m.input_age_p99_us[0] = -1);
  EXPECT_REFUSED(health_t, m.rejected_depth = -1);
  EXPECT_REFUSED(health_t, m.stage_max_us[0] = -2);
}

// The truth obeys the same rules: finite rungs with ascending ids, shares within 0..1.
TEST(SemanticChecks, Truth) {
  EXPECT_REFUSED(truth_t, m.is_ladder = 2);
  EXPECT_REFUSED(truth_t, m.rung_id[1] = m.rung_id[0]);
  EXPECT_REFUSED(truth_t, m.rung_id[0] = -1);
  EXPECT_REFUSED(truth_t, m.rung_hits[0] = -1);
  EXPECT_REFUSED(truth_t, m.rung_radius_m[0] = -0.01F);
  EXPECT_REFUSED(truth_t, m.rung_kind[0] = 5);
  EXPECT_REFUSED(truth_t, m.rung_visible[0] = 1.5F);
  EXPECT_REFUSED(truth_t, m.rung_x0_m[0] = kNan);
  EXPECT_REFUSED(truth_t, m.rail_half_width_m[0] = -1.0F);
  EXPECT_REFUSED(truth_t, m.scene = "a\nb");
  EXPECT_REFUSED(truth_t, m.q_odom_body[0] = 2.0);
}

// Texts are printable; only the configuration has lines.
TEST(SemanticChecks, EventAndConfig) {
  EXPECT_REFUSED(event_t, m.level = m.LEVEL_UNKNOWN);
  EXPECT_REFUSED(event_t, m.level = 4);
  EXPECT_REFUSED(event_t, m.service = 0);
  EXPECT_REFUSED(event_t, m.text = "line\nline");
  EXPECT_REFUSED(event_t, m.text = "\x1b[31mred");
  EXPECT_ACCEPTED(event_t, m.text = "");
  EXPECT_ACCEPTED(config_t, m.toml = "a = 1\n\tb = 2\n");
  EXPECT_REFUSED(config_t, m.version = "1\n");
  EXPECT_REFUSED(config_t, m.toml = "a = \r\n");
  EXPECT_REFUSED(config_t, m.service = -1);
}

// Well-formed UTF-8 only: no stray, missing, overlong, surrogate or too large sequences, no
// controls.
TEST(PrintableText, Utf8) {
  const auto is_printable = [](std::string_view text) {
    return runtime::is_printable_utf8(text, runtime::LineBreaks::kRefused);
  };
  for (const char* text : {"", " ~", "m\u00fchsam", "\u20ac", "\U0001F916", "\U0010FFFF"}) {
    EXPECT_TRUE(is_printable(text)) << text;
  }
  for (const char* text :
       {"\x80", "\xc3", "\xc3(", "\xc0\xaf", "\xc1\xbf", "\xe0\x80\xaf", "\xed\xa0\x80",
        "\xf0\x80\x80\xaf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "\xe2\x82", "\t",
        "\x7f", "\xc2\x85", "\x1f"}) {
    EXPECT_FALSE(is_printable(text)) << testing::PrintToString(std::string(text));
  }
}

}  // namespace
}  // namespace lcmtypes
