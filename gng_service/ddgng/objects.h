// SPDX-License-Identifier: BSD-3-Clause
// Obstacle objects: connected groups of obstacle nodes with their boxes, velocities and suspicion
// (paper, section II-B). Suspected objects steer the density of the next frame.
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ddgng/cloud.h"
#include "ddgng/disjoint_sets.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace ddgng {

class ObjectFinder {
 public:
  ObjectFinder(const StructureParams& params, int max_nodes, int max_faces);

  /// Fills topology.objects (ascending by their first node) and node_object.
  void build(const CloudView& cloud, Topology& topology);

  /// Forgets the previous frame.
  void reset();

 private:
  void group_nodes(Topology& topology);
  void set_boxes(Topology& topology);
  void set_velocities(float time_step_s, Topology& topology);
  void find_shared_nodes(const Topology& topology);
  void set_suspected(const CloudView& cloud, Topology& topology);
  void remember(const Topology& topology);

  StructureParams params_;
  DisjointSets sets_;
  std::vector<int> first_node_of_label_;
  std::vector<Eigen::AlignedBox3f> boxes_m_;  ///< parallel to the objects
  std::vector<int> previous_id_, previous_object_;
  std::vector<Eigen::Vector3f> previous_center_m_;
  std::vector<std::pair<int, int>> shared_;  ///< (object now, object before) of each shared node
  Eigen::Vector3f heads_m_ = Eigen::Vector3f::Zero();
};

}  // namespace ddgng
