// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/plane_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace ddgng {
namespace {

constexpr int kSamplePoints = 700;
constexpr int kMinPoints = 300;     // fewer attention points hold no surface
constexpr int kMinSampleLeft = 80;  // nor do fewer points of the sample
constexpr int kMaxPatches = 6;
constexpr int kMaxFailures = 2;          // planes without a patch before the search ends
constexpr int kDraws = 60;               // planes drawn per patch
constexpr int kPartnerDraws = 30;        // points drawn to find two near the first
constexpr double kPartnerNear_m = 0.04;  // a plane is drawn through points this far apart
constexpr double kPartnerFar_m = 0.35;
constexpr double kVoteDistance_m = 0.02;
constexpr double kFitDistance_m = 0.03;
constexpr double kRemoveDistance_m = 0.035;
constexpr double kMinVotes = 0.06 * kSamplePoints;
constexpr double kBorder_m = 0.02;  // beyond the cells
constexpr int kMinPointsPerCell = 2;

Eigen::Vector3d point_m(const CloudView& cloud, std::uint32_t i) {
  return {cloud.x_m[i], cloud.y_m[i], cloud.z_m[i]};
}

/// Coordinates in the plane, from its mean.
Eigen::Vector2d in_plane_m(const PlaneFit& plane, const Eigen::Vector3d& p) {
  const Eigen::Vector3d offset_m = p - plane.mean_m;
  return {offset_m.dot(plane.long_axis), offset_m.dot(plane.short_axis)};
}

}  // namespace

PlanePatches::PlanePatches(const StructureParams& params) : params_(params) {
  sample_m_.reserve(kSamplePoints);
  cells_.resize(kCells * kCells);
  patches_.reserve(kMaxPatches);
}

void PlanePatches::find(const CloudView& cloud, std::span<const std::uint32_t> points) {
  patches_.clear();
  if (points.size() < kMinPoints) return;
  constexpr std::uint64_t kStream = 0x70617463686573;  // "patches": not the numbers of the sampler
  base::Rng rng(params_.seed ^ kStream, cloud.sequence);
  draw_sample(cloud, points, rng);
  int num_failures = 0;
  PlaneFit plane;
  while (static_cast<int>(patches_.size()) < kMaxPatches &&
         num_failures<kMaxFailures&& static_cast<int>(sample_m_.size())> kMinSampleLeft &&
         find_best_plane(rng, plane)) {
    count_cells(plane, cloud, points);
    Patch patch;
    if (bound(plane, patch)) {
      patches_.push_back(patch);
    } else {
      ++num_failures;
    }
    const auto is_on = [&](const Eigen::Vector3d& p) {
      return std::abs(plane.distance_m(p)) <= kRemoveDistance_m;
    };
    sample_m_.erase(std::remove_if(sample_m_.begin(), sample_m_.end(), is_on), sample_m_.end());
  }
}

void PlanePatches::draw_sample(const CloudView& cloud, std::span<const std::uint32_t> points,
                               base::Rng& rng) {
  sample_m_.clear();
  for (int i = 0; i < kSamplePoints; ++i) {
    const std::uint32_t drawn = rng.below(static_cast<std::uint32_t>(points.size()));
    sample_m_.push_back(point_m(cloud, points[drawn]));
  }
}

// The plane with most votes, refitted to its voters; false when no plane has enough.
bool PlanePatches::find_best_plane(base::Rng& rng, PlaneFit& best) const {
  int most_votes = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    PlaneFit plane;
    if (!draw_plane(rng, plane)) continue;
    int num_votes = 0;
    for (const Eigen::Vector3d& p : sample_m_) {
      if (std::abs(plane.distance_m(p)) < kVoteDistance_m) ++num_votes;
    }
    if (num_votes <= most_votes) continue;
    most_votes = num_votes;
    best = plane;
  }
  if (most_votes < kMinVotes) return false;
  PlaneSums sums;
  for (const Eigen::Vector3d& p : sample_m_) {
    if (std::abs(best.distance_m(p)) < kFitDistance_m) sums.add(p);
  }
  best = sums.plane();
  return true;
}

// A plane through three near points of the sample.
bool PlanePatches::draw_plane(base::Rng& rng, PlaneFit& plane) const {
  const auto draw = [&]() -> const Eigen::Vector3d& {
    return sample_m_[rng.below(static_cast<std::uint32_t>(sample_m_.size()))];
  };
  const Eigen::Vector3d& first_m = draw();
  std::array<Eigen::Vector3d, 2> side_m;
  int num_found = 0;
  for (int i = 0; i < kPartnerDraws && num_found < 2; ++i) {
    const Eigen::Vector3d offset_m = draw() - first_m;
    const double length_m = offset_m.norm();
    if (length_m > kPartnerNear_m && length_m < kPartnerFar_m) side_m[num_found++] = offset_m;
  }
  if (num_found < 2) return false;
  const Eigen::Vector3d cross_m2 = side_m[0].cross(side_m[1]);
  const double length_m2 = cross_m2.norm();
  if (length_m2 < 1e-3) return false;
  plane = PlaneFit::level(first_m);
  plane.normal = cross_m2 / length_m2;
  return true;
}

void PlanePatches::count_cells(const PlaneFit& plane, const CloudView& cloud,
                               std::span<const std::uint32_t> points) {
  constexpr int kMiddle = kCells / 2;
  std::fill(cells_.begin(), cells_.end(), std::uint16_t{0});
  for (const std::uint32_t i : points) {
    const Eigen::Vector3d p = point_m(cloud, i);
    if (std::abs(plane.distance_m(p)) >= kFitDistance_m) continue;
    const Eigen::Vector2d cell = in_plane_m(plane, p) / params_.patch_cell_m;
    const double column = std::floor(cell.x()) + kMiddle;
    const double row = std::floor(cell.y()) + kMiddle;
    if (!(column >= 0 && column < kCells && row >= 0 && row < kCells)) continue;
    std::uint16_t& count = cells_[static_cast<int>(row) * kCells + static_cast<int>(column)];
    if (count < std::numeric_limits<std::uint16_t>::max()) ++count;
  }
}

bool PlanePatches::is_occupied(int column, int row) const {
  return cells_[row * kCells + column] >= kMinPointsPerCell;
}

// The patch spans the interior cells (those with four occupied neighbours) and one cell about them.
// A ladder, all border, has hardly any.
bool PlanePatches::bound(const PlaneFit& plane, Patch& patch) const {
  int num_occupied = 0;
  int num_interior = 0;
  Eigen::AlignedBox2d cells;
  for (int row = 1; row + 1 < kCells; ++row) {
    for (int column = 1; column + 1 < kCells; ++column) {
      if (!is_occupied(column, row)) continue;
      ++num_occupied;
      if (!is_occupied(column - 1, row) || !is_occupied(column + 1, row) ||
          !is_occupied(column, row - 1) || !is_occupied(column, row + 1)) {
        continue;
      }
      ++num_interior;
      cells.extend(Eigen::Vector2d(column - 1, row - 1));
      cells.extend(Eigen::Vector2d(column + 2, row + 2));
    }
  }
  const float interior_m2 =
      static_cast<float>(num_interior) * params_.patch_cell_m * params_.patch_cell_m;
  if (num_interior == 0 || interior_m2 < params_.patch_min_interior_m2 ||
      static_cast<float>(num_interior) <
          params_.patch_min_interior_share * static_cast<float>(num_occupied)) {
    return false;
  }
  const double cell_m = params_.patch_cell_m;
  patch.plane = plane;
  patch.low_m = (cells.min().array() - kCells / 2) * cell_m - kBorder_m;
  patch.high_m = (cells.max().array() - kCells / 2) * cell_m + kBorder_m;
  return true;
}

bool PlanePatches::contains(const Eigen::Vector3f& p, float distance_m) const {
  const Eigen::Vector3d q = p.cast<double>();
  return std::any_of(patches_.begin(), patches_.end(), [&](const Patch& patch) {
    if (std::abs(patch.plane.distance_m(q)) >= distance_m) return false;
    const Eigen::Vector2d at_m = in_plane_m(patch.plane, q);
    return (at_m.array() > patch.low_m.array()).all() &&
           (at_m.array() < patch.high_m.array()).all();
  });
}

}  // namespace ddgng
