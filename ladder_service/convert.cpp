// SPDX-License-Identifier: BSD-3-Clause
#include "ladder_service/convert.h"

#include <vector>

#include "ladder_msgs/point_cloud_t.hpp"
#include "runtime/columns.h"

namespace ladder_service {
namespace {

using ladder_msgs::ladder_t;
using ladder_msgs::topology_t;
using runtime::count;
using runtime::fill_column;

void copy_nodes(const topology_t& m, ladder::NodeCloud& cloud) {
  cloud.id = m.node_id;
  cloud.x_m = m.node_x_m;
  cloud.y_m = m.node_y_m;
  cloud.z_m = m.node_z_m;
  fill_column(cloud.node_class, m.node_class, [](std::uint8_t value) { return value; });
  cloud.plane = m.node_plane;
}

void copy_moments(const topology_t& m, ladder::NodeCloud& cloud) {
  cloud.moments.resize(m.num_moments);
  for (int i = 0; i < m.num_moments; ++i) {
    ladder::HeadMoment& moment = cloud.moments[i];
    moment.node = m.moment_node[i];
    moment.head = m.moment_head[i];
    moment.weight = m.moment_weight[i];
    moment.mean_m = {m.moment_x_m[i], m.moment_y_m[i], m.moment_z_m[i]};
    moment.xx_m2 = m.moment_xx_m2[i];
    moment.xy_m2 = m.moment_xy_m2[i];
    moment.xz_m2 = m.moment_xz_m2[i];
    moment.yy_m2 = m.moment_yy_m2[i];
    moment.yz_m2 = m.moment_yz_m2[i];
    moment.zz_m2 = m.moment_zz_m2[i];
  }
}

void copy_structure(const topology_t& m, ladder::NodeCloud& cloud) {
  cloud.edges.resize(m.num_edges);
  for (int i = 0; i < m.num_edges; ++i) cloud.edges[i] = {m.edge_a[i], m.edge_b[i]};
  cloud.planes.resize(m.num_planes);
  for (int i = 0; i < m.num_planes; ++i) {
    cloud.planes[i] = {{m.plane_normal_x[i], m.plane_normal_y[i], m.plane_normal_z[i]},
                       m.plane_offset_m[i],
                       static_cast<ladder::NodeClass>(m.plane_class[i])};
  }
  cloud.suspected.clear();
  for (int i = 0; i < m.num_objects; ++i) {
    if (m.object_suspected[i] == 0) continue;
    cloud.suspected.push_back({{m.object_x_m[i], m.object_y_m[i], m.object_z_m[i]},
                               {m.object_size_x_m[i], m.object_size_y_m[i], m.object_size_z_m[i]}});
  }
}

void copy_rungs(const std::vector<ladder::Rung>& rungs, ladder_t& m) {
  using ladder::Rung;
  m.num_rungs = count(rungs);
  fill_column(m.rung_id, rungs, [](const Rung& x) { return x.id; });
  fill_column(m.rung_state, rungs, [](const Rung& x) { return x.state; });
  fill_column(m.rung_age, rungs, [](const Rung& x) { return x.age; });
  fill_column(m.rung_confidence, rungs, [](const Rung& x) { return x.confidence; });
  fill_column(m.rung_evaluation, rungs, [](const Rung& x) { return x.evaluation; });
  fill_column(m.rung_inliers, rungs, [](const Rung& x) { return x.num_inliers; });
  fill_column(m.rung_outliers, rungs, [](const Rung& x) { return x.num_outliers; });
  fill_column(m.rung_x0_m, rungs, [](const Rung& x) { return x.end0_m.x(); });
  fill_column(m.rung_y0_m, rungs, [](const Rung& x) { return x.end0_m.y(); });
  fill_column(m.rung_z0_m, rungs, [](const Rung& x) { return x.end0_m.z(); });
  fill_column(m.rung_x1_m, rungs, [](const Rung& x) { return x.end1_m.x(); });
  fill_column(m.rung_y1_m, rungs, [](const Rung& x) { return x.end1_m.y(); });
  fill_column(m.rung_z1_m, rungs, [](const Rung& x) { return x.end1_m.z(); });
  fill_column(m.rung_radius_m, rungs, [](const Rung& x) { return x.radius_m; });
  fill_column(m.rung_sag_m, rungs, [](const Rung& x) { return x.sag_m; });
  fill_column(m.rung_flags, rungs, [](const Rung& x) { return x.flags; });
  fill_column(m.rung_cov_xx_m2, rungs, [](const Rung& x) { return x.covariance_m2(0, 0); });
  fill_column(m.rung_cov_xy_m2, rungs, [](const Rung& x) { return x.covariance_m2(0, 1); });
  fill_column(m.rung_cov_xz_m2, rungs, [](const Rung& x) { return x.covariance_m2(0, 2); });
  fill_column(m.rung_cov_yy_m2, rungs, [](const Rung& x) { return x.covariance_m2(1, 1); });
  fill_column(m.rung_cov_yz_m2, rungs, [](const Rung& x) { return x.covariance_m2(1, 2); });
  fill_column(m.rung_cov_zz_m2, rungs, [](const Rung& x) { return x.covariance_m2(2, 2); });
}

void copy_rails(const std::vector<ladder::Rail>& rails, ladder_t& m) {
  using ladder::Rail;
  m.num_rails = count(rails);
  fill_column(m.rail_x0_m, rails, [](const Rail& x) { return x.end0_m.x(); });
  fill_column(m.rail_y0_m, rails, [](const Rail& x) { return x.end0_m.y(); });
  fill_column(m.rail_z0_m, rails, [](const Rail& x) { return x.end0_m.z(); });
  fill_column(m.rail_x1_m, rails, [](const Rail& x) { return x.end1_m.x(); });
  fill_column(m.rail_y1_m, rails, [](const Rail& x) { return x.end1_m.y(); });
  fill_column(m.rail_z1_m, rails, [](const Rail& x) { return x.end1_m.z(); });
}

void copy_affordances(const ladder::LadderEstimate& estimate, ladder_t& m) {
  using ladder::Grasp;
  using ladder::Interval;
  m.num_intervals = count(estimate.intervals);
  fill_column(m.interval_rung, estimate.intervals, [](const Interval& x) { return x.rung; });
  fill_column(m.interval_from_m, estimate.intervals, [](const Interval& x) { return x.from_m; });
  fill_column(m.interval_to_m, estimate.intervals, [](const Interval& x) { return x.to_m; });
  fill_column(m.interval_reason, estimate.intervals, [](const Interval& x) { return x.reason; });
  m.num_grasps = count(estimate.grasps);
  fill_column(m.grasp_rung, estimate.grasps, [](const Grasp& x) { return x.rung; });
  fill_column(m.grasp_x_m, estimate.grasps, [](const Grasp& x) { return x.position_m.x(); });
  fill_column(m.grasp_y_m, estimate.grasps, [](const Grasp& x) { return x.position_m.y(); });
  fill_column(m.grasp_z_m, estimate.grasps, [](const Grasp& x) { return x.position_m.z(); });
  fill_column(m.grasp_approach_x, estimate.grasps, [](const Grasp& x) { return x.approach.x(); });
  fill_column(m.grasp_approach_y, estimate.grasps, [](const Grasp& x) { return x.approach.y(); });
  fill_column(m.grasp_approach_z, estimate.grasps, [](const Grasp& x) { return x.approach.z(); });
  fill_column(m.grasp_confidence, estimate.grasps, [](const Grasp& x) { return x.confidence; });
}

}  // namespace

void to_node_cloud(const topology_t& m, ladder::NodeCloud& cloud) {
  cloud.sequence = static_cast<std::uint64_t>(m.seq);
  copy_nodes(m, cloud);
  copy_moments(m, cloud);
  copy_structure(m, cloud);
  for (int i = 0; i < ladder::kNumHeads; ++i) {
    cloud.head_position_m[i] = {m.head_x_m[i], m.head_y_m[i], m.head_z_m[i]};
    cloud.head_valid[i] = m.head_state[i] == ladder_msgs::point_cloud_t::HEAD_LIVE;
  }
  cloud.body_position_m = {m.p_odom_body_m[0], m.p_odom_body_m[1], m.p_odom_body_m[2]};
  cloud.pixel_pitch_rad = m.pixel_pitch_rad;
  cloud.range_max_m = m.range_max_m;
}

void to_message(const ladder::LadderEstimate& estimate, const topology_t& topology, ladder_t& m) {
  m.utime = topology.utime;
  m.topology_seq = topology.seq;
  m.ladder_state = static_cast<std::int8_t>(estimate.state);
  m.spacing_m = static_cast<float>(estimate.spacing_m);
  m.spacing_sigma_m = static_cast<float>(estimate.spacing_sigma_m);
  copy_rungs(estimate.rungs, m);
  copy_rails(estimate.rails, m);
  copy_affordances(estimate, m);
}

}  // namespace ladder_service
