// SPDX-License-Identifier: BSD-3-Clause
#include "gng_service/convert.h"

#include <algorithm>
#include <iterator>

#include "runtime/columns.h"

namespace gng_service {
namespace {

using ddgng::Topology;
using ladder_msgs::point_cloud_t;
using ladder_msgs::topology_t;
using runtime::count;
using runtime::fill_column;

void copy_nodes(const Topology& topology, topology_t& m) {
  m.num_nodes = topology.num_nodes();
  m.node_id = topology.node_id;
  m.node_x_m = topology.node_x_m;
  m.node_y_m = topology.node_y_m;
  m.node_z_m = topology.node_z_m;
  m.node_strength = topology.node_strength;
  m.node_error_m2 = topology.node_error_m2;
  m.node_utility_m2 = topology.node_utility_m2;
  fill_column(m.node_class, topology.node_class, [](ddgng::Class x) { return x; });
  m.node_object = topology.node_object;
  m.node_plane = topology.node_plane;
}

void copy_moments(const Topology& topology, topology_t& m) {
  using ddgng::Moment;
  m.num_moments = count(topology.moments);
  fill_column(m.moment_node, topology.moments, [](const Moment& x) { return x.node; });
  fill_column(m.moment_head, topology.moments, [](const Moment& x) { return x.head; });
  fill_column(m.moment_weight, topology.moments, [](const Moment& x) { return x.weight; });
  fill_column(m.moment_x_m, topology.moments, [](const Moment& x) { return x.mean_m.x(); });
  fill_column(m.moment_y_m, topology.moments, [](const Moment& x) { return x.mean_m.y(); });
  fill_column(m.moment_z_m, topology.moments, [](const Moment& x) { return x.mean_m.z(); });
  fill_column(m.moment_xx_m2, topology.moments, [](const Moment& x) { return x.xx_m2; });
  fill_column(m.moment_xy_m2, topology.moments, [](const Moment& x) { return x.xy_m2; });
  fill_column(m.moment_xz_m2, topology.moments, [](const Moment& x) { return x.xz_m2; });
  fill_column(m.moment_yy_m2, topology.moments, [](const Moment& x) { return x.yy_m2; });
  fill_column(m.moment_yz_m2, topology.moments, [](const Moment& x) { return x.yz_m2; });
  fill_column(m.moment_zz_m2, topology.moments, [](const Moment& x) { return x.zz_m2; });
}

void copy_edges_and_faces(const Topology& topology, topology_t& m) {
  using ddgng::Edge;
  using ddgng::Face;
  m.num_edges = count(topology.edges);
  fill_column(m.edge_a, topology.edges, [](const Edge& x) { return x.a; });
  fill_column(m.edge_b, topology.edges, [](const Edge& x) { return x.b; });
  m.num_faces = count(topology.faces);
  fill_column(m.face_a, topology.faces, [](const Face& x) { return x.nodes[0]; });
  fill_column(m.face_b, topology.faces, [](const Face& x) { return x.nodes[1]; });
  fill_column(m.face_c, topology.faces, [](const Face& x) { return x.nodes[2]; });
  fill_column(m.face_label, topology.faces, [](const Face& x) { return x.label; });
}

void copy_labels_and_planes(const Topology& topology, topology_t& m) {
  using ddgng::Label;
  using ddgng::Plane;
  m.num_labels = count(topology.labels);
  fill_column(m.label_class, topology.labels, [](const Label& x) { return x.label_class; });
  fill_column(m.label_normal_x, topology.labels, [](const Label& x) { return x.normal.x(); });
  fill_column(m.label_normal_y, topology.labels, [](const Label& x) { return x.normal.y(); });
  fill_column(m.label_normal_z, topology.labels, [](const Label& x) { return x.normal.z(); });
  fill_column(m.label_area_m2, topology.labels, [](const Label& x) { return x.area_m2; });
  fill_column(m.label_safety, topology.labels, [](const Label& x) { return x.safety; });
  m.num_planes = count(topology.planes);
  fill_column(m.plane_normal_x, topology.planes, [](const Plane& x) { return x.normal.x(); });
  fill_column(m.plane_normal_y, topology.planes, [](const Plane& x) { return x.normal.y(); });
  fill_column(m.plane_normal_z, topology.planes, [](const Plane& x) { return x.normal.z(); });
  fill_column(m.plane_offset_m, topology.planes, [](const Plane& x) { return x.offset_m; });
  fill_column(m.plane_class, topology.planes, [](const Plane& x) { return x.plane_class; });
}

void copy_objects(const Topology& topology, topology_t& m) {
  using ddgng::Object;
  m.num_objects = count(topology.objects);
  fill_column(m.object_suspected, topology.objects,
              [](const Object& x) { return x.suspected ? 1 : 0; });
  fill_column(m.object_x_m, topology.objects, [](const Object& x) { return x.center_m.x(); });
  fill_column(m.object_y_m, topology.objects, [](const Object& x) { return x.center_m.y(); });
  fill_column(m.object_z_m, topology.objects, [](const Object& x) { return x.center_m.z(); });
  fill_column(m.object_size_x_m, topology.objects, [](const Object& x) { return x.size_m.x(); });
  fill_column(m.object_size_y_m, topology.objects, [](const Object& x) { return x.size_m.y(); });
  fill_column(m.object_size_z_m, topology.objects, [](const Object& x) { return x.size_m.z(); });
  fill_column(m.object_velocity_x_m_s, topology.objects,
              [](const Object& x) { return x.velocity_m_s.x(); });
  fill_column(m.object_velocity_y_m_s, topology.objects,
              [](const Object& x) { return x.velocity_m_s.y(); });
  fill_column(m.object_velocity_z_m_s, topology.objects,
              [](const Object& x) { return x.velocity_m_s.z(); });
}

/// The body's x axis made level; odom's where the body looks straight up or down.
Eigen::Vector2f level_ahead(const point_cloud_t& cloud) {
  const float w = cloud.q_odom_body[0];
  const float x = cloud.q_odom_body[1];
  const float y = cloud.q_odom_body[2];
  const float z = cloud.q_odom_body[3];
  const Eigen::Vector2f ahead(w * w + x * x - y * y - z * z, 2.0F * (x * y + w * z));
  const float length = ahead.norm();
  constexpr float kLeast = 0.05F;
  return length > kLeast ? Eigen::Vector2f(ahead / length) : Eigen::Vector2f::UnitX();
}

}  // namespace

ddgng::CloudView to_cloud_view(const point_cloud_t& message, float time_step_s) {
  ddgng::CloudView view;
  view.x_m = message.x_m;
  view.y_m = message.y_m;
  view.z_m = message.z_m;
  view.head = message.head;
  for (int i = 0; i < ddgng::kNumHeads; ++i) {
    view.head_position_m[i] = {message.head_x_m[i], message.head_y_m[i], message.head_z_m[i]};
    view.head_valid[i] = message.head_utime[i] != 0;
  }
  view.ahead = level_ahead(message);
  view.range_max_m = message.range_max_m;
  view.time_step_s = time_step_s;
  view.sequence = static_cast<std::uint64_t>(message.seq);
  return view;
}

void to_message(const Topology& topology, const point_cloud_t& cloud, topology_t& m) {
  m.utime = cloud.utime;
  m.cloud_seq = cloud.seq;
  std::copy(std::begin(cloud.head_state), std::end(cloud.head_state), m.head_state);
  std::copy(std::begin(cloud.head_x_m), std::end(cloud.head_x_m), m.head_x_m);
  std::copy(std::begin(cloud.head_y_m), std::end(cloud.head_y_m), m.head_y_m);
  std::copy(std::begin(cloud.head_z_m), std::end(cloud.head_z_m), m.head_z_m);
  std::copy(std::begin(cloud.p_odom_body_m), std::end(cloud.p_odom_body_m), m.p_odom_body_m);
  std::copy(std::begin(cloud.q_odom_body), std::end(cloud.q_odom_body), m.q_odom_body);
  m.range_max_m = cloud.range_max_m;
  m.pixel_pitch_rad = cloud.pixel_pitch_rad;
  copy_nodes(topology, m);
  copy_moments(topology, m);
  copy_edges_and_faces(topology, m);
  copy_labels_and_planes(topology, m);
  copy_objects(topology, m);
}

}  // namespace gng_service
