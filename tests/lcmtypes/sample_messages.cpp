// SPDX-License-Identifier: BSD-3-Clause
#include "tests/lcmtypes/sample_messages.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lcmtypes {
namespace {

using base::Rng;
using Floats = std::vector<float>;

template <class Value = float>
Value between(Rng& rng, double low, double high) {
  return static_cast<Value>(low + (high - low) * rng.uniform());
}

int index_below(Rng& rng, int count) {
  return static_cast<int>(rng.below(static_cast<std::uint32_t>(count)));
}

/// low .. high, both included.
template <class Values>
void fill_integers(Values& values, Rng& rng, int low, int high) {
  for (auto& value : values) {
    value = static_cast<std::decay_t<decltype(value)>>(low + index_below(rng, high - low + 1));
  }
}

void resize_integers(auto& values, int size, Rng& rng, int low, int high) {
  values.resize(static_cast<std::size_t>(size));
  fill_integers(values, rng, low, high);
}

void resize_floats(Floats& values, int size, Rng& rng, double low, double high) {
  values.resize(static_cast<std::size_t>(size));
  for (float& value : values) value = between(rng, low, high);
}

void resize_positions(std::initializer_list<Floats*> coordinates, int size, Rng& rng) {
  for (Floats* values : coordinates) resize_floats(*values, size, rng, -5.0, 5.0);
}

void resize_covariances(std::initializer_list<Floats*> six, int size, Rng& rng) {
  for (Floats* values : six) resize_floats(*values, size, rng, 0.0, 0.01);
}

template <class Values>
void fill_unit(Values& values, Rng& rng) {
  double sum = 0.0;
  for (auto& value : values) {
    value = between<std::decay_t<decltype(value)>>(rng, 0.1, 1.0);
    sum += static_cast<double>(value) * static_cast<double>(value);
  }
  for (auto& value : values) {
    value = static_cast<std::decay_t<decltype(value)>>(value / std::sqrt(sum));
  }
}

template <class Values>
void fill_between(Values& values, Rng& rng, double low, double high) {
  for (auto& value : values) value = between<std::decay_t<decltype(value)>>(rng, low, high);
}

template <class Msg>
void stamp(Msg& m, Rng& rng) {
  m.utime = 1'700'000'000'000'000 + static_cast<std::int64_t>(rng.below(1'000'000'000));
  m.seq = rng.below(1'000'000);
}

template <class Msg>
void fill_view(Msg& m, Rng& rng) {
  fill_integers(m.head_state, rng, 0, 2);
  fill_between(m.head_x_m, rng, -1.0, 1.0);
  fill_between(m.head_y_m, rng, -1.0, 1.0);
  fill_between(m.head_z_m, rng, 0.0, 2.0);
  fill_between(m.p_odom_body_m, rng, -2.0, 2.0);
  fill_unit(m.q_odom_body, rng);
  m.range_max_m = 4.0F;
  m.pixel_pitch_rad = 0.0048F;
}

std::string text_of(int size, Rng& rng) {
  std::string text = "m\u00e4\u00dfig \u2192 ";
  for (int i = 0; i < size; ++i) text += static_cast<char>('a' + index_below(rng, 26));
  return text;
}

std::int8_t any_service(Rng& rng) {
  return static_cast<std::int8_t>(1 + index_below(rng, 6));
}

}  // namespace

void fill_sample(ladder_msgs::command_t& m, int /*size*/, Rng& rng) {
  stamp(m, rng);
  m.session_id = 1 + index_below(rng, 1'000'000);
  m.order = static_cast<std::int8_t>(index_below(rng, m.ORDER_DISARM + 1));
}

void fill_sample(ladder_msgs::climb_state_t& m, int /*size*/, Rng& rng) {
  stamp(m, rng);
  m.session_id = 1 + index_below(rng, 1'000'000);
  m.state = m.STATE_CLIMBING;
  m.reason = m.REASON_NONE;
  m.refusal = m.REFUSAL_NONE;
  m.burden = m.BURDEN_BORNE;
  m.policy = m.POLICY_NONE;
  m.order = ladder_msgs::command_t::ORDER_CLIMB;
  m.order_seq = index_below(rng, 1000);
  m.order_verdict = m.VERDICT_ACCEPTED;
  fill_integers(m.touch, rng, 0, 1);
  fill_integers(m.limb_state, rng, 1, m.LIMB_SUPPORT_LOST);
  fill_integers(m.rung_id, rng, -1, 20);
  m.bus_phase = m.BUS_ENABLED;
  m.has_targets = 1;
  std::fill(std::begin(m.is_heard), std::end(m.is_heard), std::int8_t{1});
  fill_between(m.wanted_rad, rng, -2.0, 2.0);
  fill_between(m.measured_rad, rng, -2.0, 2.0);
  fill_between(m.torque_Nm, rng, -20.0, 20.0);
  fill_integers(m.drive_state, rng, 0, m.DRIVE_FAULT);
  m.cycles = index_below(rng, 100'000);
  m.cycle_p50_us = 40;
  m.cycle_p99_us = 80;
  m.cycle_max_us = 120;
  m.late_p99_us = 90;
  m.late_max_us = 300;
}

void fill_sample(ladder_msgs::config_t& m, int size, Rng& rng) {
  stamp(m, rng);
  m.config_hash = static_cast<std::int64_t>(rng.next());
  m.service = any_service(rng);
  m.version = "0.1.0";
  if (size > 0) m.toml = "[gng]\n\tname = \"" + text_of(20 * size, rng) + "\"\n";
}

void fill_sample(ladder_msgs::event_t& m, int size, Rng& rng) {
  stamp(m, rng);
  m.level = static_cast<std::int8_t>(1 + index_below(rng, 3));
  m.service = any_service(rng);
  if (size > 0) m.text = text_of(std::min(20 * size, 400), rng);
}

void fill_sample(ladder_msgs::health_t& m, int size, Rng& rng) {
  stamp(m, rng);
  m.service = any_service(rng);
  m.state = static_cast<std::int8_t>(index_below(rng, 5));
  m.pid = index_below(rng, 32768);
  m.start_utime = m.utime - 1'000'000;
  m.config_hash = static_cast<std::int64_t>(rng.next());
  m.flags = index_below(rng, 32);
  fill_integers(m.head_state, rng, 0, 2);
  m.steps = index_below(rng, 100000);
  const int inputs = std::min<int>(size, m.MAX_INPUTS);
  m.num_inputs = inputs;
  resize_integers(m.input_channel, inputs, rng, m.CHANNEL_TOF_0, m.CHANNEL_SIM);
  for (auto* counts : {&m.input_received, &m.input_lost, &m.input_overwritten, &m.input_rejected}) {
    resize_integers(*counts, inputs, rng, 0, 100000);
  }
  resize_integers(m.input_age_p50_us, inputs, rng, -1, 50000);
  resize_integers(m.input_age_p99_us, inputs, rng, -1, 50000);
  for (auto* cause :
       {&m.rejected_size, &m.rejected_fingerprint, &m.rejected_count, &m.rejected_string,
        &m.rejected_trailing, &m.rejected_depth, &m.rejected_value, &m.rejected_stale}) {
    *cause = index_below(rng, 100);
  }
  m.num_stages = std::min<int>(size, m.MAX_STAGES);
  for (auto* stage : {&m.stage_p50_us, &m.stage_p95_us, &m.stage_max_us}) {
    resize_integers(*stage, m.num_stages, rng, 0, 50000);
  }
}

void fill_sample(ladder_msgs::imu_t& m, int /*size*/, Rng& rng) {
  stamp(m, rng);
  fill_between(m.accelerometer_m_s2, rng, -20.0, 20.0);
  fill_between(m.gyroscope_rad_s, rng, -3.0, 3.0);
}

void fill_sample(ladder_msgs::pose_t& m, int /*size*/, Rng& rng) {
  stamp(m, rng);
  fill_between(m.p_odom_body_m, rng, -3.0, 3.0);
  fill_unit(m.q_odom_body, rng);
  m.sigma_position_m = between<double>(rng, 0.0, 0.1);
  m.sigma_angle_rad = between<double>(rng, 0.0, 0.1);
}

void fill_sample(ladder_msgs::tof_frame_t& m, int size, Rng& rng) {
  stamp(m, rng);
  m.head = static_cast<std::int8_t>(index_below(rng, 4));
  m.depth_kind = static_cast<std::int8_t>(1 + index_below(rng, 2));
  m.width_px = static_cast<std::int16_t>(1 + 10 * size);
  m.height_px = static_cast<std::int16_t>(1 + 8 * size);
  m.fx_px = m.fy_px = 10.0 * size + 1.0;
  m.cx_px = 0.5 * (m.width_px - 1);
  m.cy_px = 0.5 * (m.height_px - 1);
  m.range_min_m = 0.1;
  m.range_max_m = 4.0;
  m.wrap_range_m = rng.below(2) == 0 ? 0.0 : 7.5;
  fill_between(m.p_body_head_m, rng, -0.5, 0.5);
  fill_unit(m.q_body_head, rng);
  m.num_pixels = m.width_px * m.height_px;
  resize_integers(m.depth_mm, m.num_pixels, rng, 0, 4000);
  m.num_confidence = size > 0 && rng.below(2) == 0 ? m.num_pixels : 0;
  resize_integers(m.confidence, m.num_confidence, rng, 0, 255);
}

void fill_sample(ladder_msgs::point_cloud_t& m, int size, Rng& rng) {
  stamp(m, rng);
  fill_view(m, rng);
  for (std::int64_t& utime : m.head_utime) utime = m.utime - index_below(rng, 66000);
  m.pose_source = static_cast<std::int8_t>(index_below(rng, 3));
  m.num_points = 100 * size;
  resize_positions({&m.x_m, &m.y_m, &m.z_m}, m.num_points, rng);
  resize_integers(m.head, m.num_points, rng, 0, 3);
}

namespace {

void fill_nodes(ladder_msgs::topology_t& m, Rng& rng) {
  const int n = m.num_nodes;
  int next_id = index_below(rng, 5);
  m.node_id.resize(static_cast<std::size_t>(n));
  for (std::int32_t& id : m.node_id) id = next_id += 1 + index_below(rng, 3);
  resize_positions({&m.node_x_m, &m.node_y_m, &m.node_z_m}, n, rng);
  resize_floats(m.node_strength, n, rng, 1.0, 4.0);
  resize_floats(m.node_error_m2, n, rng, 0.0, 1.0);
  resize_floats(m.node_utility_m2, n, rng, 0.0, 1.0);
  resize_integers(m.node_class, n, rng, 0, m.CLASS_OBSTACLE);
  resize_integers(m.node_object, n, rng, -1, m.num_objects - 1);
  resize_integers(m.node_plane, n, rng, -1, m.num_planes - 1);
}

void fill_moments(ladder_msgs::topology_t& m, Rng& rng) {
  for (int node = 0; node < m.num_nodes; ++node) {
    for (std::uint8_t head = 0; head < 4; ++head) {
      if (rng.below(2) == 0) continue;
      m.moment_node.push_back(node);
      m.moment_head.push_back(head);
    }
  }
  const int n = m.num_moments = static_cast<int>(m.moment_node.size());
  resize_floats(m.moment_weight, n, rng, 0.5, 50.0);
  resize_positions({&m.moment_x_m, &m.moment_y_m, &m.moment_z_m}, n, rng);
  resize_covariances({&m.moment_xx_m2, &m.moment_xy_m2, &m.moment_xz_m2, &m.moment_yy_m2,
                      &m.moment_yz_m2, &m.moment_zz_m2},
                     n, rng);
}

/// A strip: i - i+1 and i - i+2 are joined, every three in a row make a face.
void fill_edges_and_faces(ladder_msgs::topology_t& m, Rng& rng) {
  for (int a = 0; a < m.num_nodes; ++a) {
    for (int b = a + 1; b < std::min(a + 3, m.num_nodes); ++b) {
      m.edge_a.push_back(a);
      m.edge_b.push_back(b);
    }
    if (a + 2 >= m.num_nodes) continue;
    m.face_a.push_back(a);
    m.face_b.push_back(a + 1);
    m.face_c.push_back(a + 2);
  }
  m.num_edges = static_cast<int>(m.edge_a.size());
  m.num_faces = static_cast<int>(m.face_a.size());
  resize_integers(m.face_label, m.num_faces, rng, 0, m.num_labels - 1);
}

void fill_labels_planes_objects(ladder_msgs::topology_t& m, Rng& rng) {
  resize_integers(m.label_class, m.num_labels, rng, 0, m.CLASS_OBSTACLE);
  for (Floats* normal : {&m.label_normal_x, &m.label_normal_y, &m.label_normal_z}) {
    resize_floats(*normal, m.num_labels, rng, -0.5, 0.5);
  }
  resize_floats(m.label_area_m2, m.num_labels, rng, 0.0, 2.0);
  resize_floats(m.label_safety, m.num_labels, rng, 0.0, 1.0);
  const auto planes = static_cast<std::size_t>(m.num_planes);
  m.plane_normal_x.assign(planes, 0.6F);
  m.plane_normal_y.assign(planes, 0.0F);
  m.plane_normal_z.assign(planes, -0.8F);
  resize_floats(m.plane_offset_m, m.num_planes, rng, -3.0, 3.0);
  resize_integers(m.plane_class, m.num_planes, rng, 0, m.CLASS_OBSTACLE);
  resize_integers(m.object_suspected, m.num_objects, rng, 0, 1);
  resize_positions({&m.object_x_m, &m.object_y_m, &m.object_z_m, &m.object_velocity_x_m_s,
                    &m.object_velocity_y_m_s, &m.object_velocity_z_m_s},
                   m.num_objects, rng);
  for (Floats* extent : {&m.object_size_x_m, &m.object_size_y_m, &m.object_size_z_m}) {
    resize_floats(*extent, m.num_objects, rng, 0.0, 1.0);
  }
}

}  // namespace

void fill_sample(ladder_msgs::topology_t& m, int size, Rng& rng) {
  stamp(m, rng);
  fill_view(m, rng);
  m.cloud_seq = index_below(rng, 1000);
  m.num_nodes = 10 * size;
  m.num_labels = m.num_planes = m.num_objects = size;
  fill_nodes(m, rng);
  fill_moments(m, rng);
  fill_edges_and_faces(m, rng);
  fill_labels_planes_objects(m, rng);
}

namespace {

void fill_rungs(ladder_msgs::ladder_t& m, Rng& rng) {
  const int n = m.num_rungs;
  resize_integers(m.rung_id, n, rng, 0, 1000);
  resize_integers(m.rung_state, n, rng, 0, m.RUNG_TRUSTED);
  resize_integers(m.rung_age, n, rng, 0, 150);
  resize_floats(m.rung_confidence, n, rng, 0.0, 1.0);
  resize_floats(m.rung_evaluation, n, rng, 0.0, 3.0);
  resize_integers(m.rung_inliers, n, rng, 0, 60);
  resize_integers(m.rung_outliers, n, rng, 0, 60);
  resize_positions(
      {&m.rung_x0_m, &m.rung_y0_m, &m.rung_z0_m, &m.rung_x1_m, &m.rung_y1_m, &m.rung_z1_m}, n, rng);
  resize_floats(m.rung_radius_m, n, rng, 0.01, 0.03);
  resize_floats(m.rung_sag_m, n, rng, 0.0, 0.02);
  resize_integers(m.rung_flags, n, rng, 0, 15);
  resize_covariances({&m.rung_cov_xx_m2, &m.rung_cov_xy_m2, &m.rung_cov_xz_m2, &m.rung_cov_yy_m2,
                      &m.rung_cov_yz_m2, &m.rung_cov_zz_m2},
                     n, rng);
}

/// Two intervals and one grasp for each rung.
void fill_affordances(ladder_msgs::ladder_t& m, Rng& rng) {
  for (std::int32_t rung = 0; rung < m.num_rungs; ++rung) {
    m.interval_rung.insert(m.interval_rung.end(), 2, rung);
    m.interval_from_m.insert(m.interval_from_m.end(), {0.0F, 0.15F});
    m.interval_to_m.insert(m.interval_to_m.end(), {0.15F, 0.3F});
    m.grasp_rung.push_back(rung);
  }
  m.num_intervals = 2 * m.num_rungs;
  resize_integers(m.interval_reason, m.num_intervals, rng, m.REASON_NONE, m.REASON_TOO_DEEP);
  const int n = m.num_grasps = m.num_rungs;
  resize_positions({&m.grasp_x_m, &m.grasp_y_m, &m.grasp_z_m}, n, rng);
  m.grasp_approach_x.assign(static_cast<std::size_t>(n), 0.8F);
  m.grasp_approach_y.assign(static_cast<std::size_t>(n), -0.6F);
  m.grasp_approach_z.assign(static_cast<std::size_t>(n), 0.0F);
  resize_floats(m.grasp_confidence, n, rng, 0.0, 1.0);
}

}  // namespace

void fill_sample(ladder_msgs::ladder_t& m, int size, Rng& rng) {
  stamp(m, rng);
  m.topology_seq = index_below(rng, 1000);
  m.ladder_state = size > 0 ? m.LADDER_CONFIRMED : m.LADDER_NONE;
  m.spacing_m = size > 0 ? 0.3F : 0.0F;
  m.num_rungs = std::min<int>(size, m.MAX_RUNGS);
  fill_rungs(m, rng);
  m.num_rails = std::min(size, 2);
  resize_positions(
      {&m.rail_x0_m, &m.rail_y0_m, &m.rail_z0_m, &m.rail_x1_m, &m.rail_y1_m, &m.rail_z1_m},
      m.num_rails, rng);
  fill_affordances(m, rng);
}

void fill_sample(ladder_msgs::truth_t& m, int size, Rng& rng) {
  stamp(m, rng);
  if (size > 0) m.scene = "plain 17";
  m.is_ladder = static_cast<std::int8_t>(index_below(rng, 2));
  fill_between(m.p_odom_body_m, rng, -2.0, 2.0);
  fill_unit(m.q_odom_body, rng);
  const int n = m.num_rungs = std::min<int>(size, m.MAX_RUNGS);
  m.rung_id.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) m.rung_id[i] = 2 * i;
  resize_integers(m.rung_kind, n, rng, 0, m.RUNG_BAR);
  resize_positions(
      {&m.rung_x0_m, &m.rung_y0_m, &m.rung_z0_m, &m.rung_x1_m, &m.rung_y1_m, &m.rung_z1_m}, n, rng);
  resize_floats(m.rung_radius_m, n, rng, 0.01, 0.03);
  resize_integers(m.rung_hits, n, rng, 0, 500);
  resize_floats(m.rung_visible, n, rng, 0.0, 1.0);
  m.num_rails = std::min(size, 2);
  resize_positions(
      {&m.rail_x0_m, &m.rail_y0_m, &m.rail_z0_m, &m.rail_x1_m, &m.rail_y1_m, &m.rail_z1_m},
      m.num_rails, rng);
  resize_floats(m.rail_half_width_m, m.num_rails, rng, 0.01, 0.03);
}

}  // namespace lcmtypes
