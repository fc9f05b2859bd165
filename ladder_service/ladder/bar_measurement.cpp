// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/bar_measurement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "ladder/backdrop.h"
#include "ladder/chord_depth.h"
#include "ladder/rectangular_bar.h"
#include "ladder/tread_test.h"

namespace ladder {

void mark(Stretches& stretches, double from_m, double to_m, double length_m) {
  if (length_m <= 0.0 || to_m < 0.0 || from_m > length_m) return;
  const double scale = kNumStretches / length_m;
  const int first = std::max(0, static_cast<int>(std::floor(std::max(0.0, from_m) * scale)));
  const int last = static_cast<int>(std::floor(std::min(length_m, to_m) * scale));
  for (int i = first; i <= std::min(last, kNumStretches - 1); ++i) stretches.set(i);
}

/// The bar's front line with the directions across it, and its stretch between the ends.
struct BarMeasurement::Fit {
  Axis axis;
  MomentSum sum;  ///< of the members away from the joints
  Eigen::Vector3d depth = Eigen::Vector3d::UnitX();
  Eigen::Vector3d height = Eigen::Vector3d::UnitZ();
  double from_m = 0.0;
  double to_m = 0.0;
  Eigen::Matrix3d spread_m2 = Eigen::Matrix3d::Zero();  ///< of the members, head by head if it can
  MeasuredBar out;
};

namespace {

void add_heads(const BarFrame& frame, const BarNode& node,
               std::array<MomentSum, kNumHeads>& heads) {
  for (int i = 0; i < node.num_moments; ++i) {
    const HeadMoment& m = frame.cloud.moments[node.first_moment + i];
    if (m.weight > 0.0F && m.mean_m.allFinite()) heads[m.head].add(to_sum(m));
  }
}

double inner_face_m(const Axis& bar, const MeasuredRail& rail, double inwards) {
  return nearest(bar, rail.axis).t + inwards * rail.half_width_m;
}

/// A head's own offset does not turn its lines: the covariances within the heads, added up, give
/// the direction free of the differences between heads.
Eigen::Matrix3d spread_within_heads(const std::array<MomentSum, kNumHeads>& heads,
                                    const MeasureParams& params, double& weight) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  weight = 0.0;
  for (const MomentSum& head : heads) {
    if (head.weight <= params.head_min_weight) continue;
    covariance += head.weight * head.covariance();
    weight += head.weight;
  }
  if (weight > 0.0) covariance /= weight;
  return covariance;
}

void move_back(double by_m, MeasuredBar& bar) {
  bar.front_m = by_m;
  bar.end0_m += by_m * bar.depth;
  bar.end1_m += by_m * bar.depth;
}

}  // namespace

std::optional<MeasuredBar> BarMeasurement::measure(const BarFrame& frame, int bar_index,
                                                   const Between& rails) const {
  const Bar& bar = frame.bars.rungs[bar_index];
  Fit fit;
  MeasuredBar& out = fit.out;
  out.bar = bar_index;
  if (!refit(frame, bar, rails, fit)) return std::nullopt;
  const Eigen::Vector3d ray = unit(fit.axis.origin_m - bar.eye_m, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d& d = fit.axis.direction;
  fit.depth = unit(ray - ray.dot(d) * d, Eigen::Vector3d::UnitZ().cross(d));
  fit.height = d.cross(fit.depth);
  find_ends(frame, bar, rails, fit);
  if (!out.reaches_end0 && !out.reaches_end1) return std::nullopt;
  if (fit.to_m - fit.from_m < params_.measure.stub_margin_m) return std::nullopt;
  out.weight = fit.sum.weight;
  out.is_wide = bar.wide;
  out.deep = weight_behind(frame.nodes, fit) / fit.sum.weight;
  const double trim_m = params_.measure.joint_trim_m;
  out.surplus =
      surplus_behind(frame.nodes,
                     {fit.axis, fit.from_m + trim_m, fit.to_m - trim_m, level_behind(fit)},
                     params_.test) /
      fit.sum.weight;
  find_radius(frame, bar, fit);
  find_sag(frame, bar, fit);
  if (rails.left != nullptr) out.tilt_sin = std::abs(d.dot(rails.left->axis.direction));
  mark_stretches(frame, bar, rails, fit);
  return out;
}

// One head sees the lower half of a rail, another the upper: their offset would tilt it.
Eigen::Vector3d BarMeasurement::rail_direction(
    const Bar& rail, const std::array<MomentSum, kNumHeads>& heads) const {
  const MeasureParams& p = params_.measure;
  double weight = 0.0;
  const PrincipalAxis within = principal_axis(spread_within_heads(heads, p, weight));
  if (weight <= p.head_min_share * rail.sum.weight || !within.is_linear(p.head_linearity)) {
    return rail.axis.direction;
  }
  const bool is_upwards = within.direction.dot(rail.axis.direction) >= 0.0;
  return is_upwards ? within.direction : Eigen::Vector3d(-within.direction);
}

MeasuredRail BarMeasurement::measure_rail(const BarFrame& frame, const Bar& rail,
                                          const Eigen::Vector3d& across) const {
  const MeasureParams& p = params_.measure;
  MeasuredRail out{rail.axis, rail.from_m, rail.to_m, p.rail_half_width_m};
  // Away from where rungs are joined, whose own points would pull it inwards.
  MomentSum sum;
  std::array<MomentSum, kNumHeads> heads, free_heads;
  for (const int k : frame.bars.members_of(rail)) {
    const bool joined =
        std::any_of(frame.bars.rungs.begin(), frame.bars.rungs.end(), [&](const Bar& rung) {
          return rung.axis.distance(frame.nodes.position_m(k)) < params_.test.on_rung_m;
        });
    add_heads(frame, frame.nodes[k], heads);
    if (joined) continue;
    sum.add(frame.nodes[k].sum);
    add_heads(frame, frame.nodes[k], free_heads);
  }
  out.axis.direction = rail_direction(rail, heads);
  if (sum.weight < p.min_weight) return out;
  // At a right angle to the rail: along it points lie far apart, whatever the noise.
  const Eigen::Vector3d ray = unit(-out.axis.across(rail.eye_m), Eigen::Vector3d::UnitX());
  const Eigen::Vector3d side =
      unit(across, unit(ray.cross(out.axis.direction), Eigen::Vector3d::UnitY()));
  double weight = 0.0;
  Eigen::Matrix3d covariance_m2 = spread_within_heads(free_heads, p, weight);
  if (weight <= p.head_min_share * sum.weight) covariance_m2 = sum.covariance();
  const SeenRail seen{ray, side, covariance_m2,
                      lost_m(frame, {rail.axis, rail.from_m, rail.to_m, rail.eye_m})};
  out.axis.origin_m = sum.mean();
  const RailFront front = find_front(seen);
  if (!(front.half_m > p.rail_width_switch_m)) {
    const double beside_m = beside_seen_m(out.half_width_m, front.half_seen_m, ray.dot(seen.side));
    out.axis.origin_m += beside_m * seen.side;
    return out;
  }
  // A wide one is a tube or a flat bar: its inner face is not beyond that of either.
  const double sine = ray.dot(seen.side);
  const double flat_m = beside_seen_m(front.half_m, front.half_seen_m, sine);
  const double round_m = mean_chord_depth_m(front.half_seen_m, front.half_seen_m) * sine;
  const double low_m = std::min(flat_m - front.half_m, round_m - front.half_seen_m);
  const double high_m = std::max(flat_m + front.half_m, round_m + front.half_seen_m);
  out.axis.origin_m += 0.5 * (low_m + high_m) * seen.side;
  out.half_width_m = 0.5 * (high_m - low_m);
  return out;
}

// Across the view points lie where they are seen; noise moves them along it.
RailFront BarMeasurement::find_front(const SeenRail& seen) {
  constexpr double kLeastCosine = 0.1;
  const double sine = seen.ray.dot(seen.side);
  const Eigen::Vector3d across_ray = seen.side - sine * seen.ray;
  const double cosine = std::max(kLeastCosine, std::sqrt(across_ray.squaredNorm()));
  const Eigen::Vector3d across = (sine > 0.0 ? -1.0 : 1.0) / cosine * across_ray;
  const double variance_m2 = std::max(0.0, across.dot(seen.covariance_m2 * across));
  RailFront front;
  front.half_seen_m = std::max(0.0, std::sqrt(3.0 * variance_m2) + seen.lost_m);
  if (!(variance_m2 > 0.0)) return front;
  const double bend = across.dot(seen.covariance_m2 * seen.ray) / variance_m2;
  front.half_m = front_share(bend, std::abs(sine) / cosine) * front.half_seen_m / cosine;
  return front;
}

bool BarMeasurement::refit(const BarFrame& frame, const Bar& bar, const Between& rails,
                           Fit& fit) const {
  const MeasureParams& p = params_.measure;
  double from_m = -std::numeric_limits<double>::max();
  double to_m = std::numeric_limits<double>::max();
  if (rails.left != nullptr) from_m = inner_face_m(bar.axis, *rails.left, 1.0) + p.joint_trim_m;
  if (rails.right != nullptr) to_m = inner_face_m(bar.axis, *rails.right, -1.0) - p.joint_trim_m;
  std::array<MomentSum, kNumHeads> heads;
  for (const int k : frame.bars.members_of(bar)) {
    const double t = bar.axis.along(frame.nodes.position_m(k));
    if (t < from_m || t > to_m) continue;
    fit.sum.add(frame.nodes[k].sum);
    add_heads(frame, frame.nodes[k], heads);
  }
  if (fit.sum.weight < p.min_weight) return false;
  fit.spread_m2 = fit.sum.covariance();
  PrincipalAxis spread = principal_axis(fit.spread_m2);
  double weight_in_heads = 0.0;
  const Eigen::Matrix3d within_m2 = spread_within_heads(heads, p, weight_in_heads);
  const PrincipalAxis within = principal_axis(within_m2);
  if (weight_in_heads > p.head_min_share * fit.sum.weight && within.is_linear(p.head_linearity)) {
    spread.direction = within.direction;
    fit.spread_m2 = within_m2;
  }
  if (spread.direction.dot(bar.axis.direction) < 0.0) spread.direction = -spread.direction;
  fit.axis = {fit.sum.mean(), spread.direction};
  return true;
}

void BarMeasurement::find_ends(const BarFrame& frame, const Bar& bar, const Between& rails,
                               Fit& fit) const {
  const MeasureParams& p = params_.measure;
  double seen_from_m = std::numeric_limits<double>::max();
  double seen_to_m = -seen_from_m;
  for (const int k : frame.bars.members_of(bar)) {
    const double t = fit.axis.along(frame.nodes.position_m(k));
    seen_from_m = std::min(seen_from_m, t);
    seen_to_m = std::max(seen_to_m, t);
  }
  fit.from_m = seen_from_m;
  fit.to_m = seen_to_m;
  if (rails.left != nullptr) {
    fit.from_m = inner_face_m(fit.axis, *rails.left, 1.0);
    fit.out.reaches_end0 = seen_from_m - fit.from_m <= p.stub_gap_m;
    if (!fit.out.reaches_end0) fit.from_m = seen_from_m - p.stub_margin_m;
  }
  if (rails.right != nullptr) {
    fit.to_m = inner_face_m(fit.axis, *rails.right, -1.0);
    fit.out.reaches_end1 = fit.to_m - seen_to_m <= p.stub_gap_m;
    if (!fit.out.reaches_end1) fit.to_m = seen_to_m + p.stub_margin_m;
  }
}

// Before something, the pixels on an edge show a mixture and are lost; before nothing, they show
// the bar alone and count.
double BarMeasurement::lost_m(const BarFrame& frame, const SeenStretch& bar) const {
  const MeasureParams& p = params_.measure;
  const double backed = backed_share(frame.cloud, bar);
  const double lost_px = backed * p.edge_lost_px - (1.0 - backed) * p.edge_gained_px;
  const double range_m = std::sqrt((bar.axis.origin_m - bar.eye_m).squaredNorm());
  return lost_px * range_m * frame.cloud.pixel_pitch_rad;
}

// Points spread evenly over the visible height 2 h have the variance h^2 / 3.
void BarMeasurement::find_radius(const BarFrame& frame, const Bar& bar, Fit& fit) const {
  const double variance_m2 = std::max(0.0, fit.height.dot(fit.spread_m2 * fit.height));
  fit.out.lost_m = lost_m(frame, {fit.axis, fit.from_m, fit.to_m, bar.eye_m});
  fit.out.radius_m = std::max(0.0, std::sqrt(3.0 * variance_m2) + fit.out.lost_m);
  fit.out.depth = fit.depth;
  fit.out.range_m = std::sqrt((fit.axis.origin_m - bar.eye_m).squaredNorm());
  fit.out.end0_m = fit.axis.at(fit.from_m);
  fit.out.end1_m = fit.axis.at(fit.to_m);
}

void BarMeasurement::push_back(double radius_m, MeasuredBar& bar) {
  constexpr double kLeastVisible = 0.3;  // of the radius
  const double visible_m = std::clamp(radius_m - bar.lost_m, kLeastVisible * radius_m, radius_m);
  move_back(mean_chord_depth_m(radius_m, visible_m), bar);
}

// Front and side together are on average as far before the axis, by cosine and sine of the angle.
void BarMeasurement::push_back_square(double height, MeasuredBar& bar) {
  move_back(bar.radius_m / height, bar);
}

void BarMeasurement::find_sag(const BarFrame& frame, const Bar& bar, Fit& fit) const {
  constexpr double kMargin = 0.07;  // of the length, at both ends
  constexpr double kMinWeight = 3.0;
  std::array<double, 3> weight{}, height_m{};
  const double length_m = fit.to_m - fit.from_m;
  for (const int k : frame.bars.members_of(bar)) {
    const Eigen::Vector3d w = frame.nodes.position_m(k) - fit.axis.origin_m;
    const double u = (w.dot(fit.axis.direction) - fit.from_m) / length_m;
    if (u < kMargin || u > 1.0 - kMargin) continue;
    const int third = u < 0.33 ? 0 : (u < 0.67 ? 1 : 2);
    weight[third] += frame.nodes.weight(k);
    height_m[third] += frame.nodes.weight(k) * w.dot(fit.height);
  }
  if (*std::min_element(weight.begin(), weight.end()) <= kMinWeight) return;
  for (int i = 0; i < 3; ++i) height_m[i] /= weight[i];
  fit.out.sag_m = std::abs(height_m[1] - 0.5 * (height_m[0] + height_m[2]));
  // The thirds' middles are (1 - 2 margin) / 3 of the length apart.
  fit.out.bend_tan = 2.0 * fit.out.sag_m / (length_m * (1.0 - 2.0 * kMargin) / 3.0);
}

Eigen::Vector3d BarMeasurement::level_behind(const Fit& fit) {
  return unit({fit.depth.x(), fit.depth.y(), 0.0}, Eigen::Vector3d::UnitX());
}

double BarMeasurement::weight_behind(const BarNodes& nodes, const Fit& fit) const {
  const LadderTestParams& p = params_.test;
  const Eigen::Vector3d& d = fit.axis.direction;
  const Eigen::Vector3d behind = level_behind(fit);
  const double rise_m = std::abs(d.z()) * std::max(-fit.from_m, fit.to_m) + p.deep_half_height_m;
  const double z_m = fit.axis.origin_m.z();
  const BarNodes::Range range = nodes.between(z_m - rise_m, z_m + rise_m);
  double weight = 0.0;
  for (int k = range.begin; k < range.end; ++k) {
    const Eigen::Vector3d w = nodes.position_m(k) - fit.axis.origin_m;
    const double t = w.dot(d);
    if (t < fit.from_m + params_.measure.joint_trim_m) continue;
    if (t > fit.to_m - params_.measure.joint_trim_m) continue;
    const double q = w.dot(behind);
    if (q < p.deep_from_m || q > p.deep_to_m) continue;
    if (std::abs(w.z() - t * d.z()) <= p.deep_half_height_m) weight += nodes.weight(k);
  }
  return weight;
}

void BarMeasurement::mark_stretches(const BarFrame& frame, const Bar& bar, const Between& rails,
                                    Fit& fit) const {
  const AffordanceParams& p = params_.affordance;
  const Eigen::Vector3d& d = fit.axis.direction;
  const double length_m = fit.to_m - fit.from_m;
  for (const int k : frame.bars.members_of(bar)) {
    // A node's points are spread evenly over so much on either side of its mean.
    const Eigen::Matrix3d covariance = frame.nodes[k].sum.covariance();
    const double reach_m = std::sqrt(3.0 * std::max(0.0, d.dot(covariance * d))) + p.seen_reach_m;
    const double t = fit.axis.along(frame.nodes.position_m(k)) - fit.from_m;
    mark(fit.out.seen, t - reach_m, t + reach_m, length_m);
    ++fit.out.num_inliers;
  }
  const double own_m = bar.wide ? params_.bar.wide_half_height_m : params_.bar.narrow_half_height_m;
  const double rise_m = std::abs(d.z()) * std::max(-fit.from_m, fit.to_m) + p.outlier_reach_m;
  const double z_m = fit.axis.origin_m.z();
  const BarNodes::Range range = frame.nodes.between(z_m - rise_m, z_m + rise_m);
  for (int k = range.begin; k < range.end; ++k) {
    if (frame.nodes.weight(k) < p.outlier_min_weight) continue;
    const Eigen::Vector3d& position = frame.nodes.position_m(k);
    const double t = fit.axis.along(position) - fit.from_m;
    if (t < 0.0 || t > length_m) continue;
    const double across_m = fit.axis.distance(position);
    if (across_m < own_m || across_m > p.outlier_reach_m) continue;
    const auto on_rail = [&](const MeasuredRail* rail) {
      return rail != nullptr && rail->axis.distance(position) < own_m;
    };
    if (on_rail(rails.left) || on_rail(rails.right)) continue;
    mark(fit.out.attached, t - p.clearance_m, t + p.clearance_m, length_m);
    ++fit.out.num_outliers;
  }
}

}  // namespace ladder
