// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/default_mode.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace ladder {

DefaultMode::DefaultMode(const LadderParams& params)
    : params_(params), detector_(params), tracker_(params), confirmation_(params), treads_(params) {
  order_.reserve(params.max_tracks);
}

void DefaultMode::reset() {
  detector_.reset();
  tracker_.reset();
  confirmation_.reset();
  treads_.reset();
}

void DefaultMode::update(const NodeCloud& cloud, LadderEstimate& estimate,
                         std::vector<RungSurface>& surfaces, std::vector<RailLine>& rails) {
  const Detections& found = detector_.detect(cloud);
  tracker_.update(found.bars);
  const std::vector<BarTrack>& tracks = tracker_.tracks();
  estimate.state = confirmation_.update(found, tracks);
  if (found.is_ladder) treads_.learn(found.bars);
  if (!found.is_ladder && estimate.state == LadderState::kNone) treads_.reset();
  const bool confirmed = estimate.state == LadderState::kConfirmed;
  estimate.spacing_m = confirmation_.spacing().spacing_m;
  estimate.spacing_sigma_m = confirmation_.spacing().sigma_m;

  choose_published(tracks);
  std::sort(order_.begin(), order_.end(), [&](int a, int b) {
    const double za = tracks[a].bar.middle_m().z();
    const double zb = tracks[b].bar.middle_m().z();
    return za < zb || (za == zb && a < b);
  });
  const Eigen::Vector3d body_m = cloud.body_position_m.cast<double>();
  estimate.rungs.clear();
  surfaces.clear();
  for (const int i : order_) {
    const BarTrack& track = tracks[i];
    estimate.rungs.push_back(to_rung(track, confirmed));
    const double range_m = std::sqrt((track.bar.middle_m() - body_m).squaredNorm());
    const double side_sigma_m = detector_.alignment().side_sigma_m(range_m);
    const bool is_known = track.wander_m() <= params_.affordance.max_wander_m &&
                          side_sigma_m <= params_.affordance.max_side_sigma_m &&
                          detector_.alignment().is_settled();
    surfaces.push_back({track.bar.seen, track.bar.attached, track.bar.tilt_sin,
                        margin_m(track, side_sigma_m), is_known, treads_.has_treads()});
  }
  write_rails(found, estimate, rails);
}

// Proven rungs; bars seen often enough and, unless they stood between rails, as long and as level
// as a rung.
bool DefaultMode::is_published(const BarTrack& track) const {
  if (track.is_proven) return true;
  if (track.presence < params_.track.trust_evidence) return false;
  const double length_m = track.bar.length_m();
  const double rise_m = std::abs(track.bar.end1_m.z() - track.bar.end0_m.z());
  return track.evidence > 0 || (length_m >= params_.test.min_width_m &&
                                rise_m <= params_.affordance.max_tilt_sin * length_m);
}

// One bar per bar height: the best supported.
void DefaultMode::choose_published(const std::vector<BarTrack>& tracks) {
  order_.clear();
  for (int i = 0; i < static_cast<int>(tracks.size()); ++i) {
    if (is_published(tracks[i])) order_.push_back(i);
  }
  const auto rank = [&](int i) {
    const BarTrack& track = tracks[i];
    return std::tuple(!track.is_proven, -track.bar.weight * track.bar.length_m(), track.id);
  };
  std::sort(order_.begin(), order_.end(), [&](int a, int b) { return rank(a) < rank(b); });
  std::size_t num_kept = 0;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const int track = order_[i];
    const bool is_duplicate =
        !tracks[track].is_proven &&
        std::any_of(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(num_kept),
                    [&](int kept) { return is_same_bar(tracks[kept].bar, tracks[track].bar); });
    if (!is_duplicate) order_[num_kept++] = track;
  }
  order_.resize(num_kept);
}

// Their middles lie within one bar height across, and they overlap along.
bool DefaultMode::is_same_bar(const MeasuredBar& a, const MeasuredBar& b) const {
  const Axis axis{a.middle_m(), unit(a.end1_m - a.end0_m, Eigen::Vector3d::UnitX())};
  const double bar_height_m = 2.0 * params_.bar.wide_half_height_m;
  return axis.distance(b.middle_m()) < bar_height_m &&
         std::abs(axis.along(b.middle_m())) < 0.5 * (a.length_m() + b.length_m());
}

// How far the ends may be off along the rung: by what the rung wanders from frame to frame, and by
// what the heads' mountings move all they see.
double DefaultMode::margin_m(const BarTrack& track, double side_sigma_m) const {
  return params_.affordance.margin_sigmas * std::max(track.wander_along_m(), side_sigma_m);
}

Rung DefaultMode::to_rung(const BarTrack& track, bool confirmed) const {
  const MeasuredBar& bar = track.bar;
  const bool trusted = confirmed && track.is_proven && track.num_missed < params_.track.max_missed;
  Rung rung;
  rung.id = track.id;
  rung.state = trusted ? RungState::kTrusted : RungState::kCandidate;
  rung.age = track.is_proven ? track.evidence : track.presence;
  rung.confidence = static_cast<double>(rung.age) / params_.track.max_evidence;
  constexpr double kDecimeter_m = 0.1;
  rung.evaluation = bar.num_inliers / ((1.0 + bar.num_outliers) * bar.length_m() / kDecimeter_m);
  rung.num_inliers = bar.num_inliers;
  rung.num_outliers = bar.num_outliers;
  rung.end0_m = bar.end0_m;
  rung.end1_m = bar.end1_m;
  rung.radius_m = bar.radius_m;
  rung.sag_m = bar.sag_m;
  rung.flags = track.flags(params_.measure);
  rung.covariance_m2 = track.covariance_m2(params_.track);
  return rung;
}

void DefaultMode::write_rails(const Detections& found, LadderEstimate& estimate,
                              std::vector<RailLine>& rails) const {
  rails.clear();
  const auto add = [&](const MeasuredRail& rail) {
    rails.push_back({rail.axis.at(rail.from_m), rail.axis.at(rail.to_m), rail.half_width_m});
  };
  // A confirmed ladder's own rails first, then whatever else stands upright now.
  for (const MeasuredRail& rail : confirmation_.rails()) add(rail);
  for (std::size_t i = found.is_ladder ? 2 : 0; i < found.rails.size(); ++i) {
    const auto known = [&](const MeasuredRail& rail) {
      return rail.axis.distance(found.rails[i].axis.origin_m) < params_.bar.rail_merge_offset_m;
    };
    const auto& own = confirmation_.rails();
    if (std::none_of(own.begin(), own.end(), known)) add(found.rails[i]);
  }
  estimate.rails.clear();
  for (const RailLine& rail : rails) estimate.rails.push_back({rail.end0_m, rail.end1_m});
}

}  // namespace ladder
