// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/objects.h"

#include <algorithm>
#include <limits>

#include "ddgng/heads.h"

namespace ddgng {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Lowest node of safe ground [m]; minus infinity when no ground is known.
float floor_height_m(const Topology& topology) {
  float lowest_m = kInfinity;
  for (int node = 0; node < topology.num_nodes(); ++node) {
    if (topology.node_class[node] != Class::kSafeGround) continue;
    lowest_m = std::min(lowest_m, topology.node_z_m[node]);
  }
  return lowest_m < kInfinity ? lowest_m : -kInfinity;
}

/// Axes ahead and to the left of the heads, from the heads.
struct LevelFrame {
  Eigen::Vector2f ahead;  ///< unit
  Eigen::Vector3f origin_m;

  Eigen::Vector3f turn(const Eigen::Vector3f& v) const {
    return {ahead.x() * v.x() + ahead.y() * v.y(), ahead.x() * v.y() - ahead.y() * v.x(), v.z()};
  }
  /// The box about the turned box.
  Eigen::AlignedBox3f turn(const Eigen::AlignedBox3f& box_m) const {
    const Eigen::Vector3f center_m = turn(box_m.center() - origin_m);
    const Eigen::Vector3f half_m = 0.5F * box_m.sizes();
    const Eigen::Vector2f cosines = ahead.cwiseAbs();
    const Eigen::Vector3f turned_m(cosines.x() * half_m.x() + cosines.y() * half_m.y(),
                                   cosines.x() * half_m.y() + cosines.y() * half_m.x(), half_m.z());
    return {center_m - turned_m, center_m + turned_m};
  }
};

}  // namespace

ObjectFinder::ObjectFinder(const StructureParams& params, int max_nodes, int max_faces)
    : params_(params), sets_(max_nodes) {
  first_node_of_label_.reserve(max_faces);
  boxes_m_.reserve(max_nodes);
  previous_id_.reserve(max_nodes);
  previous_object_.reserve(max_nodes);
  previous_center_m_.reserve(max_nodes);
  shared_.reserve(max_nodes);
}

void ObjectFinder::reset() {
  previous_id_.clear();
  previous_object_.clear();
  previous_center_m_.clear();
}

void ObjectFinder::build(const CloudView& cloud, Topology& topology) {
  group_nodes(topology);
  set_boxes(topology);
  set_velocities(cloud.time_step_s, topology);
  set_suspected(cloud, topology);
  remember(topology);
}

// Obstacle nodes are of one object when they share an obstacle label or are joined by an edge c, so
// that rungs, thin chains with few faces, stay with their ladder.
// PAPER: labels that share a node only; docs/EQUATIONS.md.
void ObjectFinder::group_nodes(Topology& topology) {
  const auto is_obstacle = [&](int node) { return topology.node_class[node] == Class::kObstacle; };
  sets_.reset(topology.num_nodes());
  first_node_of_label_.assign(topology.labels.size(), -1);
  for (const Face& face : topology.faces) {
    if (topology.labels[face.label].label_class != Class::kObstacle) continue;
    int& first = first_node_of_label_[face.label];
    for (const int node : face.nodes) {
      if (!is_obstacle(node)) continue;
      if (first < 0) first = node;
      sets_.join(first, node);
    }
  }
  for (const Edge& edge : topology.edges) {
    if (is_obstacle(edge.a) && is_obstacle(edge.b)) sets_.join(edge.a, edge.b);
  }

  topology.objects.clear();
  topology.node_object.assign(topology.num_nodes(), -1);
  for (int node = 0; node < topology.num_nodes(); ++node) {
    if (!is_obstacle(node)) continue;
    const int root = sets_.root(node);
    if (root == node) {
      topology.node_object[node] = static_cast<int>(topology.objects.size());
      topology.objects.emplace_back();
    }
    topology.node_object[node] = topology.node_object[root];
  }
}

void ObjectFinder::set_boxes(Topology& topology) {
  boxes_m_.assign(topology.objects.size(), Eigen::AlignedBox3f());
  for (int node = 0; node < topology.num_nodes(); ++node) {
    const int object = topology.node_object[node];
    if (object >= 0) boxes_m_[object].extend(topology.node_m(node));
  }
  for (std::size_t i = 0; i < boxes_m_.size(); ++i) {
    topology.objects[i].center_m = 0.5F * boxes_m_[i].min() + 0.5F * boxes_m_[i].max();
    topology.objects[i].size_m = boxes_m_[i].sizes();
  }
}

// An object is the one of the previous frame that shares most nodes with it; ties to the first. The
// odom frame stands still, so the robot's own motion is out already.
void ObjectFinder::set_velocities(float time_step_s, Topology& topology) {
  if (!(time_step_s > 0.0F)) return;
  find_shared_nodes(topology);
  std::size_t most = 0;
  for (std::size_t begin = 0, end = 0; begin < shared_.size(); begin = end) {
    while (end < shared_.size() && shared_[end] == shared_[begin]) ++end;
    const bool is_first = begin == 0 || shared_[begin - 1].first != shared_[begin].first;
    if (!is_first && end - begin <= most) continue;
    most = end - begin;
    const auto [now, before] = shared_[begin];
    topology.objects[now].velocity_m_s =
        (topology.objects[now].center_m - previous_center_m_[before]) / time_step_s;
  }
}

void ObjectFinder::find_shared_nodes(const Topology& topology) {
  shared_.clear();
  std::size_t before = 0;
  for (int node = 0; node < topology.num_nodes(); ++node) {
    while (before < previous_id_.size() && previous_id_[before] < topology.node_id[node]) ++before;
    if (before == previous_id_.size()) break;
    if (previous_id_[before] != topology.node_id[node]) continue;
    if (topology.node_object[node] < 0 || previous_object_[before] < 0) continue;
    shared_.emplace_back(topology.node_object[node], previous_object_[before]);
  }
  std::sort(shared_.begin(), shared_.end());
}

// Suspected: in the moving space already, or moving towards it and there within sweep_time_s. The
// space lies where the heads look, as the attention's workspace does.
// PAPER: an object in the space stays suspected while it moves away; docs/EQUATIONS.md.
void ObjectFinder::set_suspected(const CloudView& cloud, Topology& topology) {
  if (const auto heads_m = mean_head_position(cloud)) heads_m_ = *heads_m;
  const LevelFrame frame{cloud.ahead, {heads_m_.x(), heads_m_.y(), 0.0F}};
  const float ahead_m = params_.space_ahead_m > 0.0F ? params_.space_ahead_m : cloud.range_max_m;
  const Eigen::AlignedBox3f space(
      Eigen::Vector3f(0.0F, -params_.space_lateral_m, floor_height_m(topology)),
      Eigen::Vector3f(ahead_m, params_.space_lateral_m, kInfinity));

  for (std::size_t i = 0; i < boxes_m_.size(); ++i) {
    Object& object = topology.objects[i];
    const Eigen::AlignedBox3f box = frame.turn(boxes_m_[i]);
    if (box.sizes().y() >= params_.max_object_width_m) continue;
    object.suspected = space.intersects(box);
    if (object.suspected || object.velocity_m_s.norm() < params_.static_speed_m_s) continue;
    const Eigen::Vector3f way_m = frame.turn(object.velocity_m_s) * params_.sweep_time_s;
    Eigen::AlignedBox3f swept = box;
    swept.extend(box.translated(way_m));
    const Eigen::Vector2f to_space_m =
        Eigen::Vector2f(0.5F * ahead_m, 0.0F) - box.center().head<2>();
    object.suspected = way_m.head<2>().dot(to_space_m) > 0.0F && space.intersects(swept);
  }
}

void ObjectFinder::remember(const Topology& topology) {
  previous_id_ = topology.node_id;
  previous_object_ = topology.node_object;
  previous_center_m_.clear();
  for (const Object& object : topology.objects) previous_center_m_.push_back(object.center_m);
}

}  // namespace ddgng
