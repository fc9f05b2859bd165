// SPDX-License-Identifier: BSD-3-Clause
#include "gng_service/convert.h"

#include <algorithm>
#include <iterator>
#include <vector>

namespace gng_service {
namespace {

using ddgng::Topology;
using ladder_msgs::point_cloud_t;
using ladder_msgs::topology_t;

/// into[i] = get(from[i])
template <class To, class From, class Get>
void copy(const std::vector<From>& from, std::vector<To>& into, Get get) {
  into.clear();
  std::transform(from.begin(), from.end(), std::back_inserter(into),
                 [&](const From& element) { return static_cast<To>(get(element)); });
}

template <class T>
std::int32_t count(const std::vector<T>& elements) {
  return static_cast<std::int32_t>(elements.size());
}

constexpr auto kItself = [](const auto& element) { return element; };

void copy_nodes(const Topology& topology, topology_t& m) {
  m.num_nodes = topology.num_nodes();
  m.node_id = topology.node_id;
  m.node_x_m = topology.node_x_m;
  m.node_y_m = topology.node_y_m;
  m.node_z_m = topology.node_z_m;
  m.node_strength = topology.node_strength;
  m.node_error_m2 = topology.node_error_m2;
  m.node_utility_m2 = topology.node_utility_m2;
  copy(topology.node_class, m.node_class, kItself);
  m.node_object = topology.node_object;
  m.node_plane = topology.node_plane;
}

void copy_moments(const Topology& topology, topology_t& m) {
  using ddgng::Moment;
  m.num_moments = count(topology.moments);
  copy(topology.moments, m.moment_node, [](const Moment& x) { return x.node; });
  copy(topology.moments, m.moment_head, [](const Moment& x) { return x.head; });
  copy(topology.moments, m.moment_weight, [](const Moment& x) { return x.weight; });
  copy(topology.moments, m.moment_x_m, [](const Moment& x) { return x.mean_m.x(); });
  copy(topology.moments, m.moment_y_m, [](const Moment& x) { return x.mean_m.y(); });
  copy(topology.moments, m.moment_z_m, [](const Moment& x) { return x.mean_m.z(); });
  copy(topology.moments, m.moment_xx_m2, [](const Moment& x) { return x.xx_m2; });
  copy(topology.moments, m.moment_xy_m2, [](const Moment& x) { return x.xy_m2; });
  copy(topology.moments, m.moment_xz_m2, [](const Moment& x) { return x.xz_m2; });
  copy(topology.moments, m.moment_yy_m2, [](const Moment& x) { return x.yy_m2; });
  copy(topology.moments, m.moment_yz_m2, [](const Moment& x) { return x.yz_m2; });
  copy(topology.moments, m.moment_zz_m2, [](const Moment& x) { return x.zz_m2; });
}

void copy_edges_and_faces(const Topology& topology, topology_t& m) {
  using ddgng::Edge;
  using ddgng::Face;
  m.num_edges = count(topology.edges);
  copy(topology.edges, m.edge_a, [](const Edge& x) { return x.a; });
  copy(topology.edges, m.edge_b, [](const Edge& x) { return x.b; });
  m.num_faces = count(topology.faces);
  copy(topology.faces, m.face_a, [](const Face& x) { return x.nodes[0]; });
  copy(topology.faces, m.face_b, [](const Face& x) { return x.nodes[1]; });
  copy(topology.faces, m.face_c, [](const Face& x) { return x.nodes[2]; });
  copy(topology.faces, m.face_label, [](const Face& x) { return x.label; });
}

void copy_labels_and_planes(const Topology& topology, topology_t& m) {
  using ddgng::Label;
  using ddgng::Plane;
  m.num_labels = count(topology.labels);
  copy(topology.labels, m.label_class, [](const Label& x) { return x.label_class; });
  copy(topology.labels, m.label_normal_x, [](const Label& x) { return x.normal.x(); });
  copy(topology.labels, m.label_normal_y, [](const Label& x) { return x.normal.y(); });
  copy(topology.labels, m.label_normal_z, [](const Label& x) { return x.normal.z(); });
  copy(topology.labels, m.label_area_m2, [](const Label& x) { return x.area_m2; });
  copy(topology.labels, m.label_safety, [](const Label& x) { return x.safety; });
  m.num_planes = count(topology.planes);
  copy(topology.planes, m.plane_normal_x, [](const Plane& x) { return x.normal.x(); });
  copy(topology.planes, m.plane_normal_y, [](const Plane& x) { return x.normal.y(); });
  copy(topology.planes, m.plane_normal_z, [](const Plane& x) { return x.normal.z(); });
  copy(topology.planes, m.plane_offset_m, [](const Plane& x) { return x.offset_m; });
  copy(topology.planes, m.plane_class, [](const Plane& x) { return x.plane_class; });
}

void copy_objects(const Topology& topology, topology_t& m) {
  using ddgng::Object;
  m.num_objects = count(topology.objects);
  copy(topology.objects, m.object_suspected, [](const Object& x) { return x.suspected ? 1 : 0; });
  copy(topology.objects, m.object_x_m, [](const Object& x) { return x.center_m.x(); });
  copy(topology.objects, m.object_y_m, [](const Object& x) { return x.center_m.y(); });
  copy(topology.objects, m.object_z_m, [](const Object& x) { return x.center_m.z(); });
  copy(topology.objects, m.object_size_x_m, [](const Object& x) { return x.size_m.x(); });
  copy(topology.objects, m.object_size_y_m, [](const Object& x) { return x.size_m.y(); });
  copy(topology.objects, m.object_size_z_m, [](const Object& x) { return x.size_m.z(); });
  copy(topology.objects, m.object_velocity_x_m_s,
       [](const Object& x) { return x.velocity_m_s.x(); });
  copy(topology.objects, m.object_velocity_y_m_s,
       [](const Object& x) { return x.velocity_m_s.y(); });
  copy(topology.objects, m.object_velocity_z_m_s,
       [](const Object& x) { return x.velocity_m_s.z(); });
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
