// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/classification.h"

#include <algorithm>
#include <cmath>

namespace ddgng {
namespace {

constexpr float kRightAngle_rad = 1.57079637F;

/// Cosine of theta_n, Eq. (4); the caller excludes zero normals.
float slope_cosine(const Eigen::Vector3f& normal) {
  return std::clamp(normal.z() / normal.norm(), -1.0F, 1.0F);
}

// The mean of unit normals is shorter than this only when they cancel (a closed surface).
bool has_slope(const Eigen::Vector3f& normal) {
  return normal.norm() > 1e-3F;
}

}  // namespace

bool is_large(const StructureParams& params, const Label& label) {
  return label.area_m2 > params.large_area_m2 && label.num_faces >= params.large_faces;
}

Class classify_slope(const StructureParams& params, const Eigen::Vector3f& normal) {
  if (!has_slope(normal)) return Class::kObstacle;
  const float cosine = slope_cosine(normal);
  if (cosine >= static_cast<float>(cosine_of_degrees(params.safe_ground_slope_deg))) {
    return Class::kSafeGround;
  }
  if (std::abs(cosine) <=
      static_cast<float>(cosine_of_degrees(90.0 - params.wall_half_width_deg))) {
    return Class::kWall;
  }
  return Class::kObstacle;
}

float safety_degree(const Eigen::Vector3f& normal) {
  if (!has_slope(normal)) return 0.0F;
  const float cosine = slope_cosine(normal);
  if (cosine <= 0.0F) return 0.0F;
  return std::clamp(1.0F - arc_cosine(cosine) / kRightAngle_rad, 0.0F, 1.0F);
}

// PAPER: walls must be large too, else each facet of a rail would be a wall; docs/EQUATIONS.md.
void classify_labels(const StructureParams& params, Topology& topology) {
  for (Label& label : topology.labels) {
    const bool is_small =
        label.area_m2 < params.small_area_m2 || label.num_faces <= params.small_faces;
    label.label_class = is_small || !is_large(params, label) ? Class::kObstacle
                                                             : classify_slope(params, label.normal);
    label.safety = safety_degree(label.normal);
  }
}

void classify_nodes_by_labels(Topology& topology) {
  topology.node_class.assign(topology.num_nodes(), Class::kObstacle);
  for (const Face& face : topology.faces) {
    const Class face_class = topology.labels[face.label].label_class;
    if (face_class == Class::kObstacle) continue;
    for (const int node : face.nodes) {
      Class& node_class = topology.node_class[node];
      if (node_class != Class::kSafeGround) node_class = face_class;
    }
  }
}

// Abramowitz and Stegun 4.4.46: sqrt(1 - x) times a polynomial, |error| <= 2e-8 before rounding.
float arc_cosine(float cosine) {
  const double x = cosine;
  constexpr double kCoefficients[] = {-0.0012624911, 0.0066700901, -0.0170881256, 0.0308918810,
                                      -0.0501743046, 0.0889789874, -0.2145988016, 1.5707963050};
  double polynomial = 0.0;
  for (const double coefficient : kCoefficients) polynomial = polynomial * x + coefficient;
  return static_cast<float>(std::sqrt(1.0 - x) * polynomial);
}

}  // namespace ddgng
