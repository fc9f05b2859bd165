// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/attention.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "ddgng/heads.h"

namespace ddgng {
namespace {

/// A floor that nothing lies below.
Plane no_floor() {
  return {Eigen::Vector3f::Zero(), -1e30F, Class::kUnknown};
}

/// The lowest safe ground where the heads stand. A table top cannot hide the floor beside it, as
/// the heads would see through it (opaque test of planes.h).
Plane lowest_ground(const std::vector<Plane>& planes, const Eigen::Vector3f& heads_m) {
  Plane lowest = no_floor();
  float lowest_m = 0.0F;
  for (const Plane& plane : planes) {
    if (plane.plane_class != Class::kSafeGround) continue;
    const float height_m =
        (plane.offset_m - plane.normal.head<2>().dot(heads_m.head<2>())) / plane.normal.z();
    if (lowest.plane_class == Class::kSafeGround && height_m >= lowest_m) continue;
    lowest = plane;
    lowest_m = height_m;
  }
  return lowest;
}

}  // namespace

Attention::Attention(const StructureParams& params, std::size_t max_points)
    : params_(params), max_points_(max_points) {
  workspace_.near_m = params.workspace_near_m;
  workspace_.lateral_m = params.workspace_lateral_m;
  workspace_.floor = no_floor();
  boxes_.reserve(kMaxBoxes);
  planes_.reserve(params.max_planes);
  selected_.resize(max_points);
}

void Attention::set_regions(const Topology& previous, const CloudView& cloud) {
  if (const auto heads_m = mean_head_position(cloud)) workspace_.heads_m = *heads_m;
  if (params_.attention == AttentionMode::kBoxes) {
    set_boxes(previous);
  } else {
    set_workspace(previous, cloud);
  }
}

void Attention::set_boxes(const Topology& previous) {
  boxes_.clear();
  for (const Object& object : previous.objects) {
    if (!object.suspected) continue;
    if (boxes_.size() == kMaxBoxes) break;
    const Eigen::Vector3f half_m = 0.5F * object.size_m;
    boxes_.push_back({object.center_m - half_m, object.center_m + half_m});
  }
}

void Attention::set_workspace(const Topology& previous, const CloudView& cloud) {
  const float ahead_m =
      params_.workspace_ahead_m > 0.0F ? params_.workspace_ahead_m : cloud.range_max_m;
  workspace_.far_m = ahead_m;
  workspace_.ahead = cloud.ahead;
  planes_.assign(previous.planes.begin(), previous.planes.end());
  workspace_.floor = lowest_ground(planes_, workspace_.heads_m);
}

std::span<const std::uint32_t> Attention::select(const CloudView& cloud) {
  CHECK(cloud.size() <= max_points_, "cloud within the capacity of the attention set");
  std::size_t num_selected = 0;
  for (std::size_t begin = 0; begin < cloud.size(); begin += kBlock) {
    const std::size_t size = std::min(kBlock, cloud.size() - begin);
    if (params_.attention == AttentionMode::kBoxes) {
      mark_in_boxes(cloud, begin, size);
    } else {
      mark_off_planes(cloud, begin, size);
    }
    for (std::size_t i = 0; i < size; ++i) {  // without branches: about half of the points pass
      selected_[num_selected] = static_cast<std::uint32_t>(begin + i);
      num_selected += in_region_[i];
    }
  }
  return {selected_.data(), num_selected};
}

// Points nearer to a plane than this belong to it.
float Attention::clearance_m(const Eigen::Vector3f& p) const {
  return params_.attention_plane_distance_m +
         params_.attention_plane_per_range * (p - workspace_.heads_m).norm();
}

// The loops below run over separate coordinates without branches, so that compilers vectorise them.
void Attention::mark_in_boxes(const CloudView& cloud, std::size_t begin, std::size_t size) {
  const float* const x_m = cloud.x_m.data() + begin;
  const float* const y_m = cloud.y_m.data() + begin;
  const float* const z_m = cloud.z_m.data() + begin;
  in_region_.fill(0);
  for (const Box& box : boxes_) {
    const Eigen::Vector3f low = box.low_m.array() - params_.sample_margin_m;
    const Eigen::Vector3f high = box.high_m.array() + params_.sample_margin_m;
    for (std::size_t i = 0; i < size; ++i) {
      in_region_[i] |= static_cast<std::uint32_t>(x_m[i] > low.x()) & (x_m[i] < high.x()) &
                       (y_m[i] > low.y()) & (y_m[i] < high.y()) & (z_m[i] > low.z()) &
                       (z_m[i] < high.z());
    }
  }
}

void Attention::mark_off_planes(const CloudView& cloud, std::size_t begin, std::size_t size) {
  const float* const x_m = cloud.x_m.data() + begin;
  const float* const y_m = cloud.y_m.data() + begin;
  const float* const z_m = cloud.z_m.data() + begin;
  const Workspace w = workspace_;
  const float above_m = params_.workspace_above_floor_m;
  const float distance_m = params_.attention_plane_distance_m;
  const float per_range = params_.attention_plane_per_range;
  std::array<float, kBlock> clear_m;  // farther than this from every plane
  for (std::size_t i = 0; i < size; ++i) {
    const float dx = x_m[i] - w.heads_m.x();
    const float dy = y_m[i] - w.heads_m.y();
    const float dz = z_m[i] - w.heads_m.z();
    const float floor_m = w.floor.normal.x() * x_m[i] + w.floor.normal.y() * y_m[i] +
                          w.floor.normal.z() * z_m[i] - w.floor.offset_m;
    clear_m[i] = distance_m + per_range * std::sqrt(dx * dx + dy * dy + dz * dz);
    const float ahead_m = w.ahead.x() * dx + w.ahead.y() * dy;
    const float aside_m = w.ahead.x() * dy - w.ahead.y() * dx;
    in_region_[i] = static_cast<std::uint32_t>(ahead_m > w.near_m) & (ahead_m < w.far_m) &
                    (std::abs(aside_m) < w.lateral_m) & (floor_m > above_m);
  }
  for (const Plane& plane : planes_) {
    const float nx = plane.normal.x();
    const float ny = plane.normal.y();
    const float nz = plane.normal.z();
    for (std::size_t i = 0; i < size; ++i) {
      const float off_m = nx * x_m[i] + ny * y_m[i] + nz * z_m[i] - plane.offset_m;
      in_region_[i] &= static_cast<std::uint32_t>(std::abs(off_m) > clear_m[i]);
    }
  }
}

bool Attention::contains(const Eigen::Vector3f& p) const {
  if (params_.attention == AttentionMode::kBoxes) {
    const float margin_m = params_.strength_margin_m;
    return std::any_of(boxes_.begin(), boxes_.end(), [&](const Box& box) {
      return (p.array() > box.low_m.array() - margin_m).all() &&
             (p.array() < box.high_m.array() + margin_m).all();
    });
  }
  const Workspace& w = workspace_;
  const Eigen::Vector3f d = p - w.heads_m;
  const float ahead_m = w.ahead.x() * d.x() + w.ahead.y() * d.y();
  const float aside_m = w.ahead.x() * d.y() - w.ahead.y() * d.x();
  const bool in_workspace =
      ahead_m > w.near_m && ahead_m < w.far_m && std::abs(aside_m) < w.lateral_m &&
      w.floor.normal.dot(p) - w.floor.offset_m > params_.workspace_above_floor_m;
  const float clear_m = clearance_m(p);
  return in_workspace && std::all_of(planes_.begin(), planes_.end(), [&](const Plane& plane) {
           return std::abs(plane.normal.dot(p) - plane.offset_m) > clear_m;
         });
}

}  // namespace ddgng
