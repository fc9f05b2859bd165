// SPDX-License-Identifier: BSD-3-Clause
// Large labels refitted to points of the cloud, and the nodes that lie on them. Beyond the paper:
// labels scatter where nodes are dense, planes do not. A ladder's front is no plane, because the
// heads see through it (opaque test). z is up: nearly level planes are tried exactly level,
// nearly upright ones exactly upright, and a floor that is no large label is looked for by height.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "ddgng/cloud.h"
#include "ddgng/plane_fit.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace ddgng {

class PlaneFinder {
 public:
  PlaneFinder(const StructureParams& params, int max_nodes, int max_faces);

  /// Fills topology.planes and node_plane; nodes on a plane take its class, the others become
  /// obstacles. A cloud too small to refit to gives no plane and leaves node_class as it is.
  void build(const CloudView& cloud, Topology& topology);

 private:
  void sample_points(const CloudView& cloud);
  void order_large_labels(const Topology& topology);
  PlaneFit fit_to_nodes(int label_index, const Topology& topology);
  PlaneFit refit_to_sample(PlaneFit fit) const;
  PlaneFit aligned_where_supported(const PlaneFit& fit);
  PlaneFit turned(const PlaneFit& fit, const Eigen::Vector3d& normal);
  void add_level_plane_among_the_rest(Topology& topology);
  void collect_rest(const Topology& topology);
  void collect_offsets(const PlaneFit& plane, double low_m, double high_m);
  double densest_offset_m();
  int num_on(const PlaneFit& fit) const;
  bool is_duplicate(const PlaneFit& fit, const Eigen::Vector3d& center_m,
                    const Topology& topology) const;
  bool is_supported_and_opaque(const PlaneFit& fit) const;
  void add_if_sound(PlaneFit fit, const Eigen::Vector3d& center_m, Topology& topology) const;
  void assign_nodes(Topology& topology) const;

  StructureParams params_;
  double duplicate_cosine_, level_cosine_, upright_cosine_, ground_cosine_;
  Eigen::Vector3d heads_m_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> sample_m_;
  std::vector<Eigen::Vector3d> rest_m_;  ///< of the sample: off all planes
  std::vector<int> large_labels_;        ///< largest area first
  std::vector<double> offsets_m_;        ///< along a normal
  std::vector<int> counted_for_;         ///< the last label that a node was counted for
};

}  // namespace ddgng
