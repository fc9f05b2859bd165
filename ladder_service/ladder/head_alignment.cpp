// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/head_alignment.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

void apply(const HeadCorrection& correction, const RangeError& error, const Vector3d& head_m,
           HeadMoment& m) {
  const Vector3d mean_m = m.mean_m.cast<double>();
  const Vector3d arm_m = mean_m - head_m;
  const double range_m = std::sqrt(arm_m.squaredNorm());
  if (!(range_m > 0.0 && range_m < std::numeric_limits<double>::max())) return;
  const Vector3d moved_m = mean_m + correction.turn_rad.cross(arm_m) + correction.shift_m -
                           error.at(range_m) / range_m * arm_m;
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
  thicknesses_.reserve(kNumHeads * num_nodes);
  const auto num_bars = static_cast<std::size_t>(3 * params.max_bars);
  misfits_m_.reserve(kNumHeads * (2 * num_bars + params_.max_planes));
}

void HeadAlignment::reset() {
  equations_.clear();
  corrections_ = {};
  range_error_ = {};
  wall_ = floor_ = ladder_ = {};
  misfit_m_ = 0.0;
  num_frames_ = num_misfits_ = 0;
  is_misfit_ = false;
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
    apply(corrections_[m.head], range_error_, cloud.head_position_m[m.head].cast<double>(), m);
  }
  return aligned_;
}

void HeadAlignment::Told::begin_frame(const AlignParams& params) {
  sum_ *= params.keep;
  share_ = std::clamp(1.0 - sum_, 0.0, params.told_share);
  is_said_ = false;
}

double HeadAlignment::Told::say() {
  is_said_ = true;
  return share_;
}

void HeadAlignment::learn(const NodeCloud& seen, const BarNodes& nodes, const BarSet& bars,
                          const SeenLadder& ladder) {
  if (!params_.enabled) return;
  num_frames_ = std::min(num_frames_ + 1, params_.settle_frames);
  misfits_m_.clear();
  // One head alone has nothing to agree with.
  if (std::count(seen.head_valid.begin(), seen.head_valid.end(), true) < 2) return;
  equations_.forget(params_.keep);
  for (Told* told : {&wall_, &floor_, &ladder_}) told->begin_frame(params_);
  const int num_planes = std::min(params_.max_planes, static_cast<int>(seen.planes.size()));
  for (int plane = 0; plane < num_planes; ++plane) learn_plane(seen, nodes, plane);
  for (const std::vector<Bar>* kind : {&bars.rungs, &bars.rails}) {
    for (const Bar& bar : *kind) note_bar(seen, nodes, bars, bar);
  }
  if (ladder.found()) add_ladder({seen, nodes, bars}, ladder, params_, ladder_.say(), equations_);
  for (Told* told : {&wall_, &floor_, &ladder_}) told->end_frame();
  follow_misfit();
  solve();
}

void HeadAlignment::learn_plane(const NodeCloud& cloud, const BarNodes& nodes, int plane) {
  Surface surface;
  surface.normal = cloud.planes[plane].normal.cast<double>();
  if (!surface.normal.allFinite() || !(surface.normal.squaredNorm() > 0.5)) return;
  surface.along = unit(surface.normal.cross(Vector3d::UnitZ()), Vector3d::UnitX());
  surface.up = surface.normal.cross(surface.along);
  samples_.clear();
  for (const HeadMoment& m : cloud.moments) {
    if (cloud.plane[m.node] != plane) continue;
    const Vector3d point_m = m.mean_m.cast<double>();
    if (!point_m.allFinite() || is_at_corner(cloud, plane, point_m)) continue;
    if (is_contested(nodes, point_m)) continue;
    add_sample(cloud, m, surface.normal);
  }
  if (!is_on_plane(cloud.planes[plane])) return;
  measure_noise();
  equations_.begin_surface(surface.normal);
  add_surface(cloud, surface);
  add_gravity(cloud, plane, surface);
  equations_.end_surface();
  note_misfit(surface.normal);
}

void HeadAlignment::note_bar(const NodeCloud& cloud, const BarNodes& nodes, const BarSet& bars,
                             const Bar& bar) {
  const Vector3d& d = bar.axis.direction;
  const Vector3d ray = unit(bar.axis.origin_m - bar.eye_m, Vector3d::UnitX());
  const Vector3d depth = unit(ray - ray.dot(d) * d, Vector3d::UnitZ().cross(d));
  for (const Vector3d& across : {depth, Vector3d(d.cross(depth))}) {
    samples_.clear();
    for (const int k : bars.members_of(bar)) {
      for (int i = 0; i < nodes[k].num_moments; ++i) {
        add_sample(cloud, cloud.moments[nodes[k].first_moment + i], across);
      }
    }
    for (Sample& sample : samples_) sample.variance_m2 *= sample.thickness;
    note_misfit(across);
  }
}

void HeadAlignment::add_sample(const NodeCloud& cloud, const HeadMoment& m,
                               const Vector3d& normal) {
  if (!cloud.head_valid[m.head] || !(m.weight >= params_.min_weight)) return;
  if (!m.mean_m.allFinite() || samples_.size() == samples_.capacity()) return;
  const Vector3d point_m = m.mean_m.cast<double>();
  const Vector3d arm_m = point_m - cloud.head_position_m[m.head].cast<double>();
  const double range2_m2 = arm_m.squaredNorm();
  // A covariance about the points' own mean is too small by one of them.
  const double points = static_cast<double>(m.weight);
  const double thickness =
      normal.dot(covariance_of(m) * normal) * points / ((points - 1.0) * range2_m2);
  samples_.push_back({m.head, point_m, range2_m2 / points, thickness});
}

// How thick the nodes are is the noise. A node that holds more than the plane, a part of what
// stands before it or pixels on the edge of that, is thicker than noise makes the others; its mean
// is off the plane.
void HeadAlignment::measure_noise() {
  if (samples_.empty()) return;
  thicknesses_.clear();
  for (const Sample& sample : samples_) thicknesses_.push_back(sample.thickness);
  const auto median = thicknesses_.begin() + static_cast<std::ptrdiff_t>(thicknesses_.size() / 2);
  std::nth_element(thicknesses_.begin(), median, thicknesses_.end());
  const double most = params_.thick_max * *median;
  for (Sample& sample : samples_) sample.variance_m2 *= *median;
  std::erase_if(samples_, [&](const Sample& sample) { return sample.thickness > most; });
}

// Where most nodes lie elsewhere, even for heads that sit wrong, the plane is not theirs.
bool HeadAlignment::is_on_plane(const Plane& plane) const {
  const Vector3d normal = plane.normal.cast<double>();
  const auto is_far = [&](const Sample& sample) {
    return !(std::abs(normal.dot(sample.point_m) - plane.offset_m) < params_.far_m);
  };
  return 2 * std::count_if(samples_.begin(), samples_.end(), is_far) <
         static_cast<std::ptrdiff_t>(samples_.size());
}

// Nodes there won points of both planes: their mean is on neither.
bool HeadAlignment::is_at_corner(const NodeCloud& cloud, int plane, const Vector3d& point_m) const {
  for (int i = 0; i < static_cast<int>(cloud.planes.size()); ++i) {
    const Plane& other = cloud.planes[i];
    if (i == plane) continue;
    if (std::abs(other.normal.cast<double>().dot(point_m) - other.offset_m) < params_.corner_m) {
      return true;
    }
  }
  return false;
}

// What stands before the plane wins those of its points that noise brings nearer.
bool HeadAlignment::is_contested(const BarNodes& nodes, const Vector3d& point_m) const {
  const double reach_m = params_.contested_m;
  const BarNodes::Range range = nodes.between(point_m.z() - reach_m, point_m.z() + reach_m);
  for (int k = range.begin; k < range.end; ++k) {
    if ((nodes.position_m(k) - point_m).squaredNorm() < reach_m * reach_m) return true;
  }
  return false;
}

void HeadAlignment::add_surface(const NodeCloud& cloud, const Surface& surface) {
  std::array<double, kNumHeads> count{};
  Vector3d middle_m = Vector3d::Zero();
  for (const Sample& sample : samples_) {
    count[sample.head] += 1.0;
    middle_m += sample.point_m;
  }
  if (samples_.empty()) return;
  middle_m /= static_cast<double>(samples_.size());
  const double systematic_m2 = params_.sigma_plane_m * params_.sigma_plane_m;
  for (const Sample& sample : samples_) {
    if (count[sample.head] < params_.min_nodes) continue;
    const Vector3d place_m = sample.point_m - middle_m;
    AlignmentEquations::Sample row;
    row.head = sample.head;
    row.arm_m = sample.point_m - cloud.head_position_m[sample.head].cast<double>();
    row.off_m = surface.normal.dot(place_m);
    row.shape = {1.0, surface.along.dot(place_m), surface.up.dot(place_m)};
    row.weight = params_.frame_share / (sample.variance_m2 + systematic_m2);
    equations_.add(row);
  }
}

// The plane leans by its shape: its true normal is normal - along shape[1] - up shape[2].
void HeadAlignment::add_gravity(const NodeCloud& cloud, int plane, const Surface& surface) {
  const NodeClass kind = cloud.planes[plane].plane_class;
  const Vector3d& n = surface.normal;
  const double sigma2 = params_.sigma_gravity * params_.sigma_gravity;
  const auto add = [&](const Vector3d& level, Told& told) {
    equations_.add_condition({0.0, surface.along.dot(level), surface.up.dot(level)}, n.dot(level),
                             told.say() / sigma2);
  };
  if (kind == NodeClass::kWall && std::abs(n.z()) < params_.upright_max_sin) {
    add(Vector3d::UnitZ(), wall_);
  }
  const double level2 = 1.0 - params_.upright_max_sin * params_.upright_max_sin;
  if (kind == NodeClass::kSafeGround && n.z() * n.z() > level2) {
    add(Vector3d::UnitX(), floor_);
    add(Vector3d::UnitY(), floor_);
  }
}

// What noise alone would set them apart is no misfit.
void HeadAlignment::note_misfit(const Vector3d& normal) {
  std::array<double, kNumHeads> count{}, sum_m{}, variance_m2{};
  for (const Sample& sample : samples_) {
    count[sample.head] += 1.0;
    sum_m[sample.head] += normal.dot(sample.point_m);
    variance_m2[sample.head] += sample.variance_m2;
  }
  double num_heads = 0.0, mean_m = 0.0, noise_m2 = 0.0;
  for (int head = 0; head < kNumHeads; ++head) {
    if (count[head] < params_.min_nodes) continue;
    num_heads += 1.0;
    mean_m += sum_m[head] / count[head];
    noise_m2 += variance_m2[head] / (count[head] * count[head]);
  }
  if (num_heads < 2.0) return;
  mean_m /= num_heads;
  noise_m2 /= num_heads;
  for (int head = 0; head < kNumHeads; ++head) {
    if (count[head] < params_.min_nodes || misfits_m_.size() == misfits_m_.capacity()) continue;
    const double off_m = sum_m[head] / count[head] - mean_m;
    const double off_m2 = off_m * off_m * num_heads / (num_heads - 1.0);
    misfits_m_.push_back(std::sqrt(std::max(0.0, off_m2 - noise_m2)));
  }
}

// The median: a step taken for a plane, of which each head sees another part, is no misfit of
// heads.
void HeadAlignment::follow_misfit() {
  if (misfits_m_.empty()) return;
  const auto median = misfits_m_.begin() + static_cast<std::ptrdiff_t>(misfits_m_.size() / 2);
  std::nth_element(misfits_m_.begin(), median, misfits_m_.end());
  ++num_misfits_;
  misfit_m_ += std::max(params_.gain, 1.0 / num_misfits_) * (*median - misfit_m_);
  if (misfit_m_ > params_.begin_misfit_m) is_misfit_ = true;
  if (misfit_m_ < params_.end_misfit_m) is_misfit_ = false;
}

double HeadAlignment::side_sigma_m(double range_m) const {
  double turn2 = 0.0;
  for (const HeadCorrection& correction : corrections_) turn2 += correction.turn_rad.squaredNorm();
  const double share2 = turn2 / (3 * kNumHeads) / (params_.sigma_turn_rad * params_.sigma_turn_rad);
  const double turned_m = params_.sigma_turn_rad * range_m;
  const double shifted_m = params_.sigma_shift_m;
  return std::sqrt(share2 * (turned_m * turned_m / kNumHeads + shifted_m * shifted_m / 2.0));
}

// Heads that agree are well mounted: what is left of their corrections would be noise.
void HeadAlignment::solve() {
  const double share = std::clamp(misfit_m_ / params_.sigma_shift_m, params_.least_share, 1.0);
  const AlignmentPrior prior{share * params_.sigma_turn_rad, share * params_.sigma_shift_m,
                             params_.sigma_range_m};
  if (!equations_.solve(prior, corrections_, range_error_)) {
    equations_.clear();
    return;
  }
  for (HeadCorrection& correction : corrections_) {
    correction.turn_rad = bounded(correction.turn_rad, params_.max_turn_rad);
    correction.shift_m = bounded(correction.shift_m, params_.max_shift_m);
  }
  for (int knot = 0; knot < RangeError::kNumKnots; ++knot) {
    range_error_[knot] = std::clamp(range_error_[knot], -params_.max_range_m, params_.max_range_m);
  }
}

}  // namespace ladder
