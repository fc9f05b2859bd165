// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/planes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/rng.h"
#include "ddgng/classification.h"
#include "ddgng/heads.h"

namespace ddgng {

PlaneFinder::PlaneFinder(const StructureParams& params, int max_nodes, int max_faces)
    : params_(params),
      duplicate_cosine_(cosine_of_degrees(params.duplicate_angle_deg)),
      level_cosine_(cosine_of_degrees(params.level_within_deg)),
      upright_cosine_(cosine_of_degrees(90.0 - params.upright_within_deg)),
      ground_cosine_(cosine_of_degrees(params.safe_ground_slope_deg)) {
  sample_m_.reserve(params.plane_sample_points);
  rest_m_.reserve(params.plane_sample_points);
  offsets_m_.reserve(params.plane_sample_points);
  large_labels_.reserve(max_faces / std::max(1, params.large_faces) + 1);
  counted_for_.reserve(max_nodes);
}

void PlaneFinder::build(const CloudView& cloud, Topology& topology) {
  topology.planes.clear();
  topology.node_plane.assign(topology.num_nodes(), -1);
  const auto heads_m = mean_head_position(cloud);
  if (!heads_m || cloud.size() < static_cast<std::size_t>(params_.plane_sample_points)) return;
  heads_m_ = heads_m->cast<double>();

  sample_points(cloud);
  if (params_.floor_height_known) {
    const Eigen::Vector3d below_m(heads_m_.x(), heads_m_.y(), params_.floor_height_m);
    add_if_sound(PlaneFit::level(below_m), below_m, topology);
  }
  order_large_labels(topology);
  counted_for_.assign(topology.num_nodes(), -1);
  for (const int label : large_labels_) {
    const PlaneFit fit = fit_to_nodes(label, topology);
    add_if_sound(aligned_where_supported(refit_to_sample(fit)), fit.mean_m, topology);
  }
  add_level_plane_among_the_rest(topology);
  assign_nodes(topology);
}

void PlaneFinder::sample_points(const CloudView& cloud) {
  constexpr std::uint64_t kStream = 0x706C616E6573;  // "planes": not the numbers of the sampler
  base::Rng rng(params_.seed ^ kStream, cloud.sequence);
  sample_m_.clear();
  for (int i = 0; i < params_.plane_sample_points; ++i) {
    const std::uint32_t point = rng.below(static_cast<std::uint32_t>(cloud.size()));
    sample_m_.emplace_back(cloud.x_m[point], cloud.y_m[point], cloud.z_m[point]);
  }
}

void PlaneFinder::order_large_labels(const Topology& topology) {
  large_labels_.clear();
  for (int label = 0; label < static_cast<int>(topology.labels.size()); ++label) {
    if (is_large(params_, topology.labels[label])) large_labels_.push_back(label);
  }
  std::sort(large_labels_.begin(), large_labels_.end(), [&](int left, int right) {
    const float left_m2 = topology.labels[left].area_m2;
    const float right_m2 = topology.labels[right].area_m2;
    return left_m2 > right_m2 || (left_m2 == right_m2 && left < right);
  });
}

PlaneFit PlaneFinder::fit_to_nodes(int label, const Topology& topology) {
  PlaneSums sums;
  for (const Face& face : topology.faces) {
    if (face.label != label) continue;
    for (const int node : face.nodes) {
      if (counted_for_[node] == label) continue;
      counted_for_[node] = label;
      sums.add(topology.node_m(node).cast<double>());
    }
  }
  return sums.plane();
}

PlaneFit PlaneFinder::refit_to_sample(PlaneFit fit) const {
  constexpr int kRounds = 2;
  for (int round = 0; round < kRounds; ++round) {
    PlaneSums sums;
    for (const Eigen::Vector3d& p : sample_m_) {
      if (std::abs(fit.distance_m(p)) < params_.plane_refit_distance_m) sums.add(p);
    }
    if (sums.size() < params_.plane_min_points) break;
    fit = sums.plane();
  }
  return fit;
}

int PlaneFinder::num_on(const PlaneFit& fit) const {
  return static_cast<int>(
      std::count_if(sample_m_.begin(), sample_m_.end(), [&](const Eigen::Vector3d& p) {
        return std::abs(fit.distance_m(p)) < params_.plane_on_distance_m;
      }));
}

// Gravity is known: floors are level and walls upright, whatever pulls at their refit (the lowest
// step of a stair, the foot of a wall). The plane turned so wins unless the tilted one carries
// clearly more points (a ramp).
PlaneFit PlaneFinder::aligned_where_supported(const PlaneFit& fit) {
  const double slope_cosine = std::abs(fit.normal.z());
  const bool is_nearly_level = slope_cosine >= level_cosine_;
  if (!is_nearly_level && slope_cosine > upright_cosine_) return fit;
  const Eigen::Vector3d level_part(fit.normal.x(), fit.normal.y(), 0.0);
  const PlaneFit aligned =
      turned(fit, is_nearly_level ? Eigen::Vector3d::UnitZ() : level_part.normalized());
  const double least = static_cast<double>(params_.aligned_min_support) * num_on(fit);
  return num_on(aligned) >= least ? aligned : fit;
}

// With this normal, where most points are within the reach of the fit's own points.
PlaneFit PlaneFinder::turned(const PlaneFit& fit, const Eigen::Vector3d& normal) {
  PlaneFit result = fit;
  result.normal = normal;
  double low_m = std::numeric_limits<double>::infinity();
  double high_m = -low_m;
  for (const Eigen::Vector3d& p : sample_m_) {
    if (std::abs(fit.distance_m(p)) >= params_.plane_refit_distance_m) continue;
    low_m = std::min(low_m, result.distance_m(p));
    high_m = std::max(high_m, result.distance_m(p));
  }
  collect_offsets(result, low_m, high_m);
  result.mean_m += densest_offset_m() * normal;
  collect_offsets(result, -params_.plane_on_distance_m, params_.plane_on_distance_m);
  if (offsets_m_.empty()) return result;
  const auto median = offsets_m_.begin() + static_cast<std::ptrdiff_t>(offsets_m_.size() / 2);
  std::nth_element(offsets_m_.begin(), median, offsets_m_.end());
  result.mean_m += *median * normal;
  return result;
}

// Distances from the plane that lie between the two.
void PlaneFinder::collect_offsets(const PlaneFit& plane, double low_m, double high_m) {
  offsets_m_.clear();
  for (const Eigen::Vector3d& p : sample_m_) {
    const double offset_m = plane.distance_m(p);
    if (offset_m >= low_m && offset_m <= high_m) offsets_m_.push_back(offset_m);
  }
}

// A floor once missed draws the attention and gets dense nodes, whose normals scatter so that it
// never becomes a large label: among the points off all planes the level slab with most of them is
// tried, too. It must spread in both directions, else it is a strip of a wall.
void PlaneFinder::add_level_plane_among_the_rest(Topology& topology) {
  collect_rest(topology);
  offsets_m_.clear();
  for (const Eigen::Vector3d& p : rest_m_) offsets_m_.push_back(p.z());
  const double height_m = densest_offset_m();
  PlaneSums sums;
  for (const Eigen::Vector3d& p : rest_m_) {
    if (std::abs(p.z() - height_m) < params_.plane_on_distance_m) sums.add(p);
  }
  if (sums.size() < params_.plane_min_points) return;
  const PlaneFit fit = sums.plane();
  double spread_m2 = 0.0;
  for (const Eigen::Vector3d& p : rest_m_) {
    if (std::abs(p.z() - height_m) >= params_.plane_on_distance_m) continue;
    const double across_m = fit.short_axis.dot(p - fit.mean_m);
    spread_m2 += across_m * across_m / sums.size();
  }
  const double least_m = params_.level_min_spread_m;
  if (spread_m2 < least_m * least_m || std::abs(fit.normal.z()) < level_cosine_) return;
  add_if_sound(aligned_where_supported(fit), fit.mean_m, topology);
}

void PlaneFinder::collect_rest(const Topology& topology) {
  rest_m_.clear();
  for (const Eigen::Vector3d& p : sample_m_) {
    const bool is_on_a_plane =
        std::any_of(topology.planes.begin(), topology.planes.end(), [&](const Plane& plane) {
          return std::abs(plane.normal.cast<double>().dot(p) - plane.offset_m) <
                 params_.plane_refit_distance_m;
        });
    if (!is_on_a_plane) rest_m_.push_back(p);
  }
}

// The middle point of the slab with most points.
double PlaneFinder::densest_offset_m() {
  std::sort(offsets_m_.begin(), offsets_m_.end());
  const double slab_m = 2.0 * params_.plane_on_distance_m;
  std::size_t most = 0;
  double middle_m = 0.0;
  for (std::size_t low = 0, high = 0; low < offsets_m_.size(); ++low) {
    while (high < offsets_m_.size() && offsets_m_[high] - offsets_m_[low] < slab_m) ++high;
    if (high - low <= most) continue;
    most = high - low;
    middle_m = offsets_m_[low + most / 2];
  }
  return middle_m;
}

void PlaneFinder::add_if_sound(PlaneFit fit, const Eigen::Vector3d& center_m,
                               Topology& topology) const {
  if (static_cast<int>(topology.planes.size()) >= params_.max_planes) return;
  if (fit.distance_m(heads_m_) < 0.0) fit.normal = -fit.normal;
  if (is_duplicate(fit, center_m, topology) || !is_supported_and_opaque(fit)) return;
  Plane plane;
  plane.normal = fit.normal.cast<float>();
  plane.offset_m = static_cast<float>(fit.normal.dot(fit.mean_m));
  plane.plane_class = classify_slope(params_, plane.normal);
  topology.planes.push_back(plane);
}

// center_m: where the label lies; two planes are compared there.
bool PlaneFinder::is_duplicate(const PlaneFit& fit, const Eigen::Vector3d& center_m,
                               const Topology& topology) const {
  for (const Plane& plane : topology.planes) {
    const Eigen::Vector3d normal = plane.normal.cast<double>();
    if (std::abs(normal.dot(fit.normal)) > duplicate_cosine_ &&
        std::abs(normal.dot(center_m) - plane.offset_m) < params_.duplicate_distance_m) {
      return true;
    }
  }
  return false;
}

// A plane carries its share of the points, and few points lie behind it: the heads do not see
// through it. The front of a ladder fails. Under ground lies nothing at all; a plane through the
// tops of rubble has as many points below as above.
bool PlaneFinder::is_supported_and_opaque(const PlaneFit& fit) const {
  const bool is_ground = std::abs(fit.normal.z()) >= ground_cosine_;
  float num_on = 0.0F;
  float num_behind = 0.0F;
  float num_below = 0.0F;
  for (const Eigen::Vector3d& p : sample_m_) {
    const double distance_m = fit.distance_m(p);
    if (std::abs(distance_m) < params_.plane_on_distance_m) ++num_on;
    if (distance_m < -params_.plane_behind_distance_m) ++num_behind;
    if (is_ground && distance_m <= -params_.plane_on_distance_m) ++num_below;
  }
  return num_on >= params_.plane_min_support * static_cast<float>(sample_m_.size()) &&
         num_behind <= params_.plane_max_behind * num_on &&
         num_below <= params_.ground_max_below * num_on;
}

// The nearest plane within the distance; ties to the first.
void PlaneFinder::assign_nodes(Topology& topology) const {
  const Eigen::Vector3f heads_m = heads_m_.cast<float>();
  for (int node = 0; node < topology.num_nodes(); ++node) {
    const Eigen::Vector3f p = topology.node_m(node);
    float nearest_m =
        params_.node_plane_distance_m + params_.node_plane_per_range * (p - heads_m).norm();
    for (int i = 0; i < static_cast<int>(topology.planes.size()); ++i) {
      const Plane& plane = topology.planes[i];
      const float distance_m = std::abs(plane.normal.dot(p) - plane.offset_m);
      if (!(distance_m < nearest_m)) continue;
      nearest_m = distance_m;
      topology.node_plane[node] = i;
    }
    const int plane = topology.node_plane[node];
    topology.node_class[node] = plane < 0 ? Class::kObstacle : topology.planes[plane].plane_class;
  }
}

}  // namespace ddgng
