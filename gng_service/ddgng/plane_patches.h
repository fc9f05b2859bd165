// SPDX-License-Identifier: BSD-3-Clause
// Bounded planes among the attention points. A surface that was missed as a plane early gets dense
// nodes, whose normals scatter, so that it never becomes a large label: this search breaks that
// lock-in. Beyond the paper; off by default.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "base/rng.h"
#include "ddgng/cloud.h"
#include "ddgng/plane_fit.h"
#include "ddgng/structure_params.h"

namespace ddgng {

class PlanePatches {
 public:
  explicit PlanePatches(const StructureParams& params);

  /// Replaces the patches by those among these points of the cloud. Random draws depend on
  /// (seed, cloud.sequence) alone.
  void find(const CloudView& cloud, std::span<const std::uint32_t> points);
  void clear() { patches_.clear(); }

  /// True when p lies within a patch's border and nearer to its plane than distance_m.
  bool contains(const Eigen::Vector3f& p, float distance_m) const;

  int size() const { return static_cast<int>(patches_.size()); }

 private:
  struct Patch {
    PlaneFit plane;
    Eigen::Vector2d low_m, high_m;  ///< along (long_axis, short_axis) from the mean
  };
  static constexpr int kCells = 128;  ///< per side of the grid about the mean

  void draw_sample(const CloudView& cloud, std::span<const std::uint32_t> points, base::Rng& rng);
  bool draw_plane(base::Rng& rng, PlaneFit& plane) const;
  bool find_best_plane(base::Rng& rng, PlaneFit& plane) const;
  void count_cells(const PlaneFit& plane, const CloudView& cloud,
                   std::span<const std::uint32_t> points);
  bool bound(const PlaneFit& plane, Patch& patch) const;
  bool is_occupied(int column, int row) const;

  StructureParams params_;
  std::vector<Eigen::Vector3d> sample_m_;
  std::vector<std::uint16_t> cells_;  ///< points per cell, row after row
  std::vector<Patch> patches_;
};

}  // namespace ddgng
