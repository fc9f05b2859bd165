// SPDX-License-Identifier: BSD-3-Clause
// Which points draw the attention signals and where nodes are strong: made from the topology of one
// frame, used in the next (Alg. 1 and 2). Does not draw signals.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "ddgng/cloud.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace ddgng {

class Attention {
 public:
  /// Clouds hold at most max_points points.
  Attention(const StructureParams& params, std::size_t max_points);

  /// The regions follow from the structure of the previous frame and the heads of this one. Without
  /// a valid head the previous place of the heads stays.
  void set_regions(const Topology& previous, const CloudView& cloud);

  /// The attention set P_s: indices of the cloud's points in the regions, ascending; valid until
  /// the next call. Finite coordinates only. O(points x (planes or boxes)).
  std::span<const std::uint32_t> select(const CloudView& cloud);

  /// True where a node gets the strength delta_in (Alg. 2).
  bool contains(const Eigen::Vector3f& p) const;

 private:
  struct Box {
    Eigen::Vector3f low_m, high_m;
  };
  struct Workspace {
    Eigen::Vector3f heads_m = Eigen::Vector3f::Zero();    ///< mean position of the valid heads
    Eigen::Vector2f ahead = Eigen::Vector2f::UnitX();     ///< level
    float near_m = 0.0F, far_m = 0.0F, lateral_m = 0.0F;  ///< from the heads ahead, to either side
    Plane floor;                                          ///< points below it are left out
  };
  static constexpr std::size_t kBlock = 256;
  static constexpr std::size_t kMaxBoxes = 1024;

  void set_boxes(const Topology& previous);
  void set_workspace(const Topology& previous, const CloudView& cloud);
  void mark_in_boxes(const CloudView& cloud, std::size_t begin, std::size_t size);
  void mark_off_planes(const CloudView& cloud, std::size_t begin, std::size_t size);
  float clearance_m(const Eigen::Vector3f& p) const;

  StructureParams params_;
  std::size_t max_points_;
  std::vector<Box> boxes_;  ///< suspected objects, without margin
  Workspace workspace_;
  std::vector<Plane> planes_;                      ///< what attention leaves out
  std::array<std::uint32_t, kBlock> in_region_{};  ///< of one block of points: 1 or 0
  std::vector<std::uint32_t> selected_;
};

}  // namespace ddgng
