// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/bar_tracker.h"

#include <algorithm>
#include <cmath>

namespace ladder {

Eigen::Matrix3d BarTrack::covariance_m2(const TrackParams& params) const {
  const double systematic_m2 = params.systematic_sigma_m * params.systematic_sigma_m;
  return averaging * scatter_m2 + systematic_m2 * Eigen::Matrix3d::Identity();
}

double BarTrack::wander_along_m() const {
  const Eigen::Vector3d along = unit(bar.end1_m - bar.end0_m, Eigen::Vector3d::UnitX());
  return std::sqrt(std::max(0.0, along.dot(scatter_m2 * along)));
}

std::uint16_t BarTrack::flags(const MeasureParams& params) const {
  unsigned bits = kFlagNone;
  if (bar.is_stub()) bits |= kFlagStub;
  if (bar.is_v || bar.bend_tan > params.bent_flag_tan) bits |= kFlagBent;
  if (bar.sag_m > params.sag_flag_m) bits |= kFlagSagged;
  if (bar.tilt_sin > params.tilt_flag_sin) bits |= kFlagTilted;
  return static_cast<std::uint16_t>(bits);
}

BarTracker::BarTracker(const LadderParams& params) : params_(params) {
  tracks_.reserve(params.max_tracks);
  matched_.reserve(params.max_bars);
}

void BarTracker::reset() {
  tracks_.clear();
  next_id_ = 1;
}

void BarTracker::update(const std::vector<MeasuredBar>& bars) {
  matched_.assign(bars.size(), 0);
  for (BarTrack& track : tracks_) {
    const int match = find_match(track, bars);
    if (match < 0) {
      miss(track);
    } else {
      matched_[match] = 1;
      take(track, bars[match]);
    }
  }
  std::erase_if(tracks_, [](const BarTrack& track) { return track.presence <= 0; });
  for (std::size_t i = 0; i < bars.size(); ++i) {
    if (!matched_[i] && static_cast<int>(tracks_.size()) < params_.max_tracks) begin(bars[i]);
  }
}

int BarTracker::find_match(const BarTrack& track, const std::vector<MeasuredBar>& bars) const {
  const Eigen::Vector3d middle_m = track.bar.middle_m();
  const Axis axis{middle_m, unit(track.bar.end1_m - track.bar.end0_m, Eigen::Vector3d::UnitX())};
  int best = -1;
  double best_m = params_.track.gate_across_m;
  for (int i = 0; i < static_cast<int>(bars.size()); ++i) {
    if (matched_[i]) continue;
    const Eigen::Vector3d other_m = bars[i].middle_m();
    if (std::abs(axis.along(other_m)) > params_.track.gate_along_m) continue;
    const double across_m = axis.distance(other_m);
    if (across_m >= best_m) continue;
    best_m = across_m;
    best = i;
  }
  return best;
}

void BarTracker::take(BarTrack& track, const MeasuredBar& bar) const {
  const TrackParams& p = params_.track;
  const bool same_kind = track.bar.on_ladder == bar.on_ladder;
  // Ends of a free bar and of a rung between rails are different things: do not average them.
  if (!same_kind && !track.is_proven) track.num_matches = 0;
  ++track.num_matches;
  ++track.presence;
  track.presence = std::min(track.presence, p.max_evidence);
  count_evidence(track, bar.on_ladder);
  if (!same_kind && track.is_proven && !bar.on_ladder) return;

  const double gain = std::max(p.min_gain, 1.0 / track.num_matches);
  const double shape_gain = std::max(p.shape_gain, 1.0 / track.num_matches);
  const bool opposed = (bar.end1_m - bar.end0_m).dot(track.bar.end1_m - track.bar.end0_m) < 0.0;
  const Eigen::Vector3d& end0_m = opposed ? bar.end1_m : bar.end0_m;
  const Eigen::Vector3d& end1_m = opposed ? bar.end0_m : bar.end1_m;
  const Eigen::Vector3d innovation_m = 0.5 * (end0_m + end1_m) - track.bar.middle_m();
  if (track.num_matches > 1) {
    track.scatter_m2 += std::max(p.min_gain, 1.0 / (track.num_matches + 1)) *
                        (innovation_m * innovation_m.transpose() - track.scatter_m2);
  }
  track.averaging =
      track.num_matches == 1 ? 1.0 : (1.0 - gain) * (1.0 - gain) * track.averaging + gain * gain;
  MeasuredBar next = bar;
  next.end0_m = track.bar.end0_m + gain * (end0_m - track.bar.end0_m);
  next.end1_m = track.bar.end1_m + gain * (end1_m - track.bar.end1_m);
  next.sag_m = track.bar.sag_m + shape_gain * (bar.sag_m - track.bar.sag_m);
  next.bend_tan = track.bar.bend_tan + shape_gain * (bar.bend_tan - track.bar.bend_tan);
  next.tilt_sin = track.bar.tilt_sin + shape_gain * (bar.tilt_sin - track.bar.tilt_sin);
  next.radius_m = track.bar.radius_m + shape_gain * (bar.radius_m - track.bar.radius_m);
  // What was as thick as the others and looks thin by now is hidden in part.
  const bool is_hidden = track.bar.is_alike && !bar.is_alike && bar.radius_m < track.bar.radius_m;
  if (is_hidden) next.radius_m = track.bar.radius_m;
  next.is_alike = bar.is_alike || is_hidden;
  track.bar = next;
}

void BarTracker::miss(BarTrack& track) const {
  --track.presence;
  count_evidence(track, false);
}

void BarTracker::count_evidence(BarTrack& track, bool on_ladder) const {
  const TrackParams& p = params_.track;
  track.evidence = std::clamp(track.evidence + (on_ladder ? 1 : -1), 0, p.max_evidence);
  track.num_missed = on_ladder ? 0 : track.num_missed + 1;
  if (track.evidence >= p.trust_evidence) track.is_proven = true;
  if (track.evidence < p.drop_evidence) track.is_proven = false;
}

void BarTracker::begin(const MeasuredBar& bar) {
  BarTrack track;
  track.id = next_id_++;
  track.bar = bar;
  track.num_matches = 1;
  track.presence = 1;
  const double prior_m2 = params_.track.prior_sigma_m * params_.track.prior_sigma_m;
  track.scatter_m2 = prior_m2 * Eigen::Matrix3d::Identity();
  count_evidence(track, bar.on_ladder);
  tracks_.push_back(track);
}

}  // namespace ladder
