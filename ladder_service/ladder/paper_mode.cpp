// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/paper_mode.h"

#include <algorithm>
#include <cmath>

#include "ladder/ladder_confirmation.h"

namespace ladder {
namespace {

double middle_z_m(const PaperRung& rung) {
  return 0.5 * (rung.end1_m.z() + rung.end2_m.z());
}

}  // namespace

PaperMode::PaperMode(const LadderParams& params) : params_(params), tracker_(params) {
  order_.reserve(params.max_tracks);
  heights_m_.reserve(params.max_tracks);
}

bool PaperMode::is_rail(const PaperRung& rung) const {
  return std::abs(rung.axis().direction.z()) > params_.paper.rail_min_dz;
}

void PaperMode::update(const NodeCloud& cloud, LadderEstimate& estimate,
                       std::vector<RungSurface>& surfaces, std::vector<RailLine>& rails) {
  tracker_.update(cloud);
  const auto rungs = tracker_.rungs();
  order_.clear();
  estimate.rungs.clear();
  estimate.rails.clear();
  surfaces.clear();
  rails.clear();
  for (int i = 0; i < static_cast<int>(rungs.size()); ++i) {
    const PaperRung& rung = rungs[i];
    if (!is_rail(rung)) {
      order_.push_back(i);
      continue;
    }
    const bool upwards = rung.end1_m.z() <= rung.end2_m.z();
    const Eigen::Vector3d& low_m = upwards ? rung.end1_m : rung.end2_m;
    const Eigen::Vector3d& high_m = upwards ? rung.end2_m : rung.end1_m;
    estimate.rails.push_back({low_m, high_m});
    rails.push_back({low_m, high_m, params_.measure.rail_half_width_m});
  }
  std::sort(order_.begin(), order_.end(), [&](int a, int b) {
    const double za = middle_z_m(rungs[a]);
    const double zb = middle_z_m(rungs[b]);
    return za < zb || (za == zb && a < b);
  });
  for (const int i : order_) {
    estimate.rungs.push_back(to_rung(cloud, rungs[i]));
    surfaces.push_back(to_surface(cloud, rungs[i], estimate.rungs.back()));
  }
  write_state(estimate);
}

Rung PaperMode::to_rung(const NodeCloud& cloud, const PaperRung& rung) const {
  const PaperParams& p = params_.paper;
  Rung shown;
  shown.id = rung.id;
  shown.state = rung.age > p.age_trusted ? RungState::kTrusted : RungState::kCandidate;
  shown.age = rung.age;
  shown.confidence = static_cast<double>(rung.age) / p.age_max;
  shown.evaluation = rung.evaluation;
  shown.num_inliers = rung.num_inliers;
  shown.num_outliers = rung.num_outliers;
  const Eigen::Vector3d middle_m = 0.5 * (rung.end1_m + rung.end2_m);
  const Eigen::Vector3d ahead = level_direction(cloud.body_position_m.cast<double>(), middle_m);
  const Eigen::Vector3d right = ahead.cross(Eigen::Vector3d::UnitZ());
  const bool points_right = (rung.end2_m - rung.end1_m).dot(right) >= 0.0;
  shown.end0_m = points_right ? rung.end1_m : rung.end2_m;
  shown.end1_m = points_right ? rung.end2_m : rung.end1_m;
  // The paper knows no radius and no variance: the prior, and what an inlier may be off.
  shown.radius_m = params_.measure.prior_radius_m;
  const double systematic_m2 = params_.track.systematic_sigma_m * params_.track.systematic_sigma_m;
  const double inlier_m2 = p.inlier_m * p.inlier_m / std::max(1, rung.num_inliers);
  shown.covariance_m2 = (systematic_m2 + inlier_m2) * Eigen::Matrix3d::Identity();
  return shown;
}

RungSurface PaperMode::to_surface(const NodeCloud& cloud, const PaperRung& rung,
                                  const Rung& shown) const {
  RungSurface surface;
  surface.may_be_offered = rung.age > params_.paper.age_affordance;
  surface.seen.set();
  const Axis axis{shown.end0_m, unit(shown.end1_m - shown.end0_m, Eigen::Vector3d::UnitX())};
  const double clearance_m = params_.affordance.clearance_m;
  for (const int id : rung.outlier_id) {
    const auto found = std::lower_bound(cloud.id.begin(), cloud.id.end(), id);
    if (found == cloud.id.end() || *found != id) continue;
    const double t = axis.along(cloud.node_m(static_cast<int>(found - cloud.id.begin())));
    mark(surface.attached, t - clearance_m, t + clearance_m, rung.length_m());
  }
  return surface;
}

void PaperMode::write_state(LadderEstimate& estimate) {
  // PAPER: has no ladder test; trusted rungs make a ladder as soon as they have a spacing, without
  // which no ladder can be told. docs/EQUATIONS.md
  heights_m_.clear();
  for (const Rung& rung : estimate.rungs) {
    if (rung.state != RungState::kTrusted) continue;
    heights_m_.push_back(0.5 * (rung.end0_m.z() + rung.end1_m.z()));
  }
  const Spacing spacing = fit_spacing(heights_m_, params_.test);
  estimate.state = spacing.spacing_m > 0.0 ? LadderState::kConfirmed : LadderState::kNone;
  estimate.spacing_m = spacing.spacing_m;
  estimate.spacing_sigma_m = spacing.sigma_m;
}

}  // namespace ladder
