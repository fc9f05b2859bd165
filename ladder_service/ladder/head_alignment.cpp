// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/head_alignment.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace ladder {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d covariance_of(const HeadMoment& m) {
  Matrix3d covariance;
  covariance << m.xx_m2, m.xy_m2, m.xz_m2, m.xy_m2, m.yy_m2, m.yz_m2, m.xz_m2, m.yz_m2, m.zz_m2;
  return covariance;
}

void apply(const HeadCorrection& correction, const Vector3d& head_m, HeadMoment& m) {
  const Vector3d mean_m = m.mean_m.cast<double>();
  const Vector3d moved_m = mean_m + correction.turn_rad.cross(mean_m - head_m) + correction.shift_m;
  m.mean_m = moved_m.cast<float>();
  Matrix3d turn = Matrix3d::Identity();
  turn(2, 1) = correction.turn_rad.x();
  turn(1, 2) = -correction.turn_rad.x();
  turn(0, 2) = correction.turn_rad.y();
  turn(2, 0) = -correction.turn_rad.y();
  turn(1, 0) = correction.turn_rad.z();
  turn(0, 1) = -correction.turn_rad.z();
  const Matrix3d turned = turn * covariance_of(m) * turn.transpose();
  m.xx_m2 = static_cast<float>(turned(0, 0));
  m.xy_m2 = static_cast<float>(turned(0, 1));
  m.xz_m2 = static_cast<float>(turned(0, 2));
  m.yy_m2 = static_cast<float>(turned(1, 1));
  m.yz_m2 = static_cast<float>(turned(1, 2));
  m.zz_m2 = static_cast<float>(turned(2, 2));
}

/// No longer than this, same direction.
Vector3d bounded(const Vector3d& v, double most) {
  const double length = std::sqrt(v.squaredNorm());
  return length > most ? Vector3d(most / length * v) : v;
}

}  // namespace

HeadAlignment::HeadAlignment(const LadderParams& params) : params_(params.align) {
  if (!params_.enabled) return;
  const auto num_nodes = static_cast<std::size_t>(params.max_cloud_nodes);
  aligned_.id.reserve(num_nodes);
  aligned_.x_m.reserve(num_nodes);
  aligned_.y_m.reserve(num_nodes);
  aligned_.z_m.reserve(num_nodes);
  aligned_.node_class.reserve(num_nodes);
  aligned_.plane.reserve(num_nodes);
  aligned_.moments.reserve(kNumHeads * num_nodes);
  aligned_.planes.reserve(params_.max_planes);
  samples_.reserve(kNumHeads * num_nodes);
  const auto num_bars = static_cast<std::size_t>(3 * params.max_bars);
  misfits_m_.reserve(kNumHeads * (2 * num_bars + params_.max_planes));
}

void HeadAlignment::reset() {
  corrections_ = {};
  misfit_m_ = 0.0;
  is_correcting_ = false;
}

// Edges and suspected boxes are not copied: the default mode does not read them.
const NodeCloud& HeadAlignment::correct(const NodeCloud& cloud) {
  if (!params_.enabled || cloud.num_nodes() > static_cast<int>(aligned_.id.capacity()) ||
      cloud.planes.size() > aligned_.planes.capacity()) {
    return cloud;
  }
  aligned_.sequence = cloud.sequence;
  aligned_.id.assign(cloud.id.begin(), cloud.id.end());
  aligned_.x_m.assign(cloud.x_m.begin(), cloud.x_m.end());
  aligned_.y_m.assign(cloud.y_m.begin(), cloud.y_m.end());
  aligned_.z_m.assign(cloud.z_m.begin(), cloud.z_m.end());
  aligned_.node_class.assign(cloud.node_class.begin(), cloud.node_class.end());
  aligned_.plane.assign(cloud.plane.begin(), cloud.plane.end());
  aligned_.planes.assign(cloud.planes.begin(), cloud.planes.end());
  aligned_.moments.assign(cloud.moments.begin(), cloud.moments.end());
  aligned_.head_position_m = cloud.head_position_m;
  aligned_.head_valid = cloud.head_valid;
  aligned_.body_position_m = cloud.body_position_m;
  aligned_.pixel_pitch_rad = cloud.pixel_pitch_rad;
  aligned_.range_max_m = cloud.range_max_m;
  for (HeadMoment& m : aligned_.moments) {
    if (!cloud.head_valid[m.head]) continue;
    apply(corrections_[m.head], cloud.head_position_m[m.head].cast<double>(), m);
  }
  return aligned_;
}

void HeadAlignment::learn(const NodeCloud& cloud, const BarNodes& nodes, const BarSet& bars) {
  if (!params_.enabled) return;
  equations_ = {};
  misfits_m_.clear();
  for (int plane = 0; plane < static_cast<int>(cloud.planes.size()); ++plane) {
    sample_plane(cloud, plane);
    const Vector3d normal = cloud.planes[plane].normal.cast<double>();
    if (normal.allFinite()) add_distances(cloud, normal, params_.points_per_plane);
  }
  for (const std::vector<Bar>* kind : {&bars.rungs, &bars.rails}) {
    for (const Bar& bar : *kind) {
      sample_bar(cloud, nodes, bars, bar);
      const Vector3d& d = bar.axis.direction;
      const Vector3d ray = unit(bar.axis.origin_m - bar.eye_m, Vector3d::UnitX());
      const Vector3d depth = unit(ray - ray.dot(d) * d, Vector3d::UnitZ().cross(d));
      for (const Vector3d& across : {depth, Vector3d(d.cross(depth))}) {
        add_distances(cloud, across, params_.points_per_bar);
      }
    }
  }
  follow_misfit();
  solve(cloud);
}

void HeadAlignment::sample_plane(const NodeCloud& cloud, int plane) {
  samples_.clear();
  for (const HeadMoment& m : cloud.moments) {
    if (cloud.plane[m.node] != plane || !cloud.head_valid[m.head]) continue;
    if (!(m.weight >= params_.min_weight) || !m.mean_m.allFinite()) continue;
    samples_.push_back({m.head, m.mean_m.cast<double>()});
  }
}

void HeadAlignment::sample_bar(const NodeCloud& cloud, const BarNodes& nodes, const BarSet& bars,
                               const Bar& bar) {
  samples_.clear();
  for (const int k : bars.members_of(bar)) {
    for (int i = 0; i < nodes[k].num_moments; ++i) {
      const HeadMoment& m = cloud.moments[nodes[k].first_moment + i];
      if (!cloud.head_valid[m.head] || !(m.weight >= params_.min_weight)) continue;
      if (!m.mean_m.allFinite()) continue;
      samples_.push_back({m.head, m.mean_m.cast<double>()});
    }
  }
}

// Each head is drawn to what the heads agree on along the normal: the mean of their means.
void HeadAlignment::add_distances(const NodeCloud& cloud, const Vector3d& normal,
                                  double num_points) {
  std::array<double, kNumHeads> count{}, sum_m{}, uncorrected_m{};
  for (const Sample& sample : samples_) {
    const HeadCorrection& correction = corrections_[sample.head];
    const Vector3d arm_m = sample.point_m - cloud.head_position_m[sample.head].cast<double>();
    count[sample.head] += 1.0;
    sum_m[sample.head] += normal.dot(sample.point_m);
    uncorrected_m[sample.head] +=
        normal.dot(sample.point_m - correction.turn_rad.cross(arm_m) - correction.shift_m);
  }
  double num_heads = 0.0, offset_m = 0.0, uncorrected_mean_m = 0.0;
  for (int head = 0; head < kNumHeads; ++head) {
    if (count[head] < params_.min_nodes) continue;
    num_heads += 1.0;
    offset_m += sum_m[head] / count[head];
    uncorrected_mean_m += uncorrected_m[head] / count[head];
  }
  if (num_heads == 0.0) return;
  offset_m /= num_heads;
  uncorrected_mean_m /= num_heads;
  for (int head = 0; head < kNumHeads && num_heads > 1.0; ++head) {
    if (count[head] < params_.min_nodes) continue;
    const double off_m = uncorrected_m[head] / count[head] - uncorrected_mean_m;
    if (misfits_m_.size() == misfits_m_.capacity()) continue;
    misfits_m_.push_back(std::abs(off_m) * std::sqrt(num_heads / (num_heads - 1.0)));
  }
  const double information = num_points / (params_.sigma_point_m * params_.sigma_point_m);
  for (const Sample& sample : samples_) {
    if (count[sample.head] < params_.min_nodes) continue;
    const double weight = information / count[sample.head];
    const Vector3d arm_m = sample.point_m - cloud.head_position_m[sample.head].cast<double>();
    Vector6 row;
    row << arm_m.cross(normal), normal;
    equations_[sample.head].information += weight * row * row.transpose();
    equations_[sample.head].right += weight * (offset_m - normal.dot(sample.point_m)) * row;
  }
}

// A phase error bends what one head sees; to explain that by its mounting would spoil a good one.
// The median: a step taken for a plane, of which each head sees another part, is no misfit of
// heads.
void HeadAlignment::follow_misfit() {
  if (misfits_m_.empty()) return;
  const auto median = misfits_m_.begin() + static_cast<std::ptrdiff_t>(misfits_m_.size() / 2);
  std::nth_element(misfits_m_.begin(), median, misfits_m_.end());
  misfit_m_ += params_.gain * (*median - misfit_m_);
  if (misfit_m_ > params_.begin_misfit_m) is_correcting_ = true;
  if (misfit_m_ < params_.end_misfit_m) is_correcting_ = false;
}

// The correction so far counts as known to the mounting's tolerance, so that what nothing shows
// stays, or goes back to, zero.
void HeadAlignment::solve(const NodeCloud& cloud) {
  Vector6 prior;
  const double turn = 1.0 / (params_.sigma_turn_rad * params_.sigma_turn_rad);
  const double shift = 1.0 / (params_.sigma_shift_m * params_.sigma_shift_m);
  prior << turn, turn, turn, shift, shift, shift;
  for (int head = 0; head < kNumHeads; ++head) {
    if (!cloud.head_valid[head]) continue;
    HeadCorrection& correction = corrections_[head];
    if (!is_correcting_) {
      correction.turn_rad *= 1.0 - params_.gain;
      correction.shift_m *= 1.0 - params_.gain;
      continue;
    }
    Vector6 now;
    now << correction.turn_rad, correction.shift_m;
    const Matrix6 information = equations_[head].information + Matrix6(prior.asDiagonal());
    const Vector6 right = equations_[head].right - prior.cwiseProduct(now);
    const Vector6 step = information.llt().solve(right);
    if (!step.allFinite()) continue;
    const Vector3d turn_rad = correction.turn_rad + params_.gain * step.head<3>();
    const Vector3d shift_m = correction.shift_m + params_.gain * step.tail<3>();
    correction.turn_rad = bounded(turn_rad, params_.max_turn_rad);
    correction.shift_m = bounded(shift_m, params_.max_shift_m);
  }
}

}  // namespace ladder
