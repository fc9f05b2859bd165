// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/ladder_confirmation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ladder/weighted_median.h"

namespace ladder {

Spacing fit_spacing(std::vector<double>& heights_m, const LadderTestParams& params) {
  std::sort(heights_m.begin(), heights_m.end());
  double step_m = std::numeric_limits<double>::max();
  for (std::size_t i = 1; i < heights_m.size(); ++i) {
    const double distance_m = heights_m[i] - heights_m[i - 1];
    if (distance_m > params.min_joint_distance_m) step_m = std::min(step_m, distance_m);
  }
  double n = 0.0, k = 0.0, kk = 0.0, h = 0.0, kh = 0.0, hh = 0.0;
  double number = 0.0;
  double last_m = heights_m.empty() ? 0.0 : heights_m.front();
  for (std::size_t i = 0; i < heights_m.size(); ++i) {
    const double steps = (heights_m[i] - last_m) / step_m;
    const double whole = std::floor(steps + 0.5);
    if (i > 0 && (whole < 1.0 || std::abs(steps - whole) > params.spacing_tolerance)) continue;
    number += i > 0 ? whole : 0.0;
    last_m = heights_m[i];
    const double height_m = heights_m[i] - heights_m.front();
    n += 1.0;
    k += number;
    kk += number * number;
    h += height_m;
    kh += number * height_m;
    hh += height_m * height_m;
  }
  if (n < 3.0) return {};
  const double skk = kk - k * k / n;
  const double skh = kh - k * h / n;
  const double shh = hh - h * h / n;
  const double residual_m2 = std::max(0.0, shh - skh * skh / skk) / (n - 2.0);
  const double least_m2 = params.height_sigma_m * params.height_sigma_m;
  return {static_cast<int>(n), skh / skk, std::sqrt(std::max(residual_m2, least_m2) / skk)};
}

namespace {

bool stands_at_a_place(double height_m, double sag_m, double spacing_m,
                       const LadderTestParams& params) {
  const double number = std::floor(height_m / spacing_m + 0.5);
  const double below_m = number * spacing_m - height_m;
  const double tolerance_m = params.spacing_tolerance * spacing_m;
  return below_m >= -tolerance_m && below_m <= tolerance_m + sag_m;
}

/// The place is none of a sound rung's: those are 0 and `steps` here.
bool is_between_others(double height_m, double spacing_m, double steps) {
  const double number = std::floor(height_m / spacing_m + 0.5);
  return number != 0.0 && number != steps;
}

}  // namespace

Spacing fit_spacing_beside(const std::vector<double>& heights_m,
                           const std::vector<DamagedHeight>& damaged,
                           const LadderTestParams& params) {
  if (heights_m.size() != 2) return {};
  const double low_m = std::min(heights_m[0], heights_m[1]);
  const double distance_m = std::max(heights_m[0], heights_m[1]) - low_m;
  constexpr int kMaxSteps = 3;
  for (int steps = 1; steps <= kMaxSteps; ++steps) {
    const double spacing_m = distance_m / steps;
    if (spacing_m < params.min_spacing_m || spacing_m > params.max_spacing_m) continue;
    const auto fits = [&](double end_m, double sag_m) {
      return stands_at_a_place(end_m - low_m, sag_m, spacing_m, params) &&
             is_between_others(end_m - low_m, spacing_m, steps);
    };
    const auto num_fitting = std::count_if(damaged.begin(), damaged.end(), [&](const auto& bar) {
      return fits(bar.end0_m, bar.sag_m) || fits(bar.end1_m, bar.sag_m);
    });
    if (num_fitting == 0) continue;
    // Of a difference of two heights.
    const double sigma_m = params.height_sigma_m * std::sqrt(2.0) / steps;
    return {2 + static_cast<int>(num_fitting), spacing_m, sigma_m};
  }
  return {};
}

LadderConfirmation::LadderConfirmation(const LadderParams& params) : params_(params) {
  rails_.reserve(2);
  heights_m_.reserve(params.max_tracks);
  radii_.reserve(params.max_tracks);
  damaged_.reserve(params.max_tracks);
}

void LadderConfirmation::reset() {
  state_ = LadderState::kUnknown;
  spacing_ = {};
  rails_.clear();
  num_rail_frames_ = 0;
}

LadderState LadderConfirmation::update(const Detections& found,
                                       const std::vector<BarTrack>& tracks) {
  if (found.is_ladder) follow_rails(found);
  const LadderTestParams& p = params_.test;
  const Spacing measured = measure(tracks);
  const bool is_ladder =
      measured.num_rungs >= p.min_rungs && measured.spacing_m >= p.min_spacing_m &&
      measured.spacing_m <= p.max_spacing_m && measured.sigma_m <= max_spacing_sigma_m();
  if (is_ladder) {
    state_ = LadderState::kConfirmed;
    spacing_ = measured;
    return state_;
  }
  // Near the top fewer rungs are in view than confirm a ladder: it stands while one of them does,
  // unless what is measured now speaks against it.
  const bool refuted = measured.num_rungs >= p.min_rungs;
  const bool has_rung = std::any_of(tracks.begin(), tracks.end(),
                                    [](const BarTrack& track) { return track.is_proven; });
  if (state_ == LadderState::kConfirmed && has_rung && !refuted) return state_;
  state_ = LadderState::kNone;
  spacing_ = {};
  if (!has_rung && !found.is_ladder) {
    rails_.clear();
    num_rail_frames_ = 0;
  }
  return state_;
}

void LadderConfirmation::follow_rails(const Detections& found) {
  constexpr double kSameRail_m = 0.10;
  const bool same = rails_.size() == 2 &&
                    rails_[0].axis.distance(found.rails[0].axis.origin_m) < kSameRail_m &&
                    rails_[1].axis.distance(found.rails[1].axis.origin_m) < kSameRail_m;
  if (!same) {
    rails_.assign(found.rails.begin(), found.rails.begin() + 2);
    num_rail_frames_ = 1;
    return;
  }
  ++num_rail_frames_;
  const double gain = std::max(params_.track.min_gain, 1.0 / num_rail_frames_);
  for (int i = 0; i < 2; ++i) {
    MeasuredRail& rail = rails_[i];
    const MeasuredRail& now = found.rails[i];
    // The ends are as seen now; the line is averaged at the new one's middle.
    const Eigen::Vector3d old_m = rail.axis.at(rail.axis.along(now.axis.origin_m));
    const Eigen::Vector3d direction =
        rail.axis.direction + gain * (now.axis.direction - rail.axis.direction);
    rail.axis = {old_m + gain * (now.axis.origin_m - old_m), unit(direction, now.axis.direction)};
    rail.from_m = now.from_m;
    rail.to_m = now.to_m;
    rail.half_width_m += gain * (now.half_width_m - rail.half_width_m);
  }
}

// A bent rung does not stand at its proper height, nor does one of which the view's edge leaves a
// part; a stub does.
bool LadderConfirmation::tells_height(const BarTrack& track) const {
  const unsigned damage = track.flags(params_.measure) & (kFlagBent | kFlagSagged | kFlagTilted);
  const double off_m = std::abs(track.bar.radius_m - radius_m_);
  return damage == 0 && off_m <= params_.measure.radius_alike * radius_m_;
}

// Of a thick bar less than half is seen, and the middle of that is no place on its axis.
double LadderConfirmation::max_spacing_sigma_m() const {
  constexpr double kOfRadius = 0.16;  // 100 mm rungs: 6.0 of 7.3 mm (tuning seeds)
  return std::max(params_.test.max_spacing_sigma_m, kOfRadius * radius_m_);
}

Spacing LadderConfirmation::measure(const std::vector<BarTrack>& tracks) {
  heights_m_.clear();
  damaged_.clear();
  if (rails_.empty()) return {};
  radii_.clear();
  for (const BarTrack& track : tracks) {
    if (track.is_proven) radii_.emplace_back(track.bar.radius_m, track.bar.weight);
  }
  radius_m_ = weighted_median(radii_);
  const Axis& left = rails_[0].axis;
  for (const BarTrack& track : tracks) {
    if (!track.is_proven) continue;
    if (tells_height(track)) {
      heights_m_.push_back(left.along(track.bar.middle_m()));
    } else {
      damaged_.push_back(
          {left.along(track.bar.end0_m), left.along(track.bar.end1_m), track.bar.sag_m});
    }
  }
  if (heights_m_.size() == 2) return fit_spacing_beside(heights_m_, damaged_, params_.test);
  return fit_spacing(heights_m_, params_.test);
}

}  // namespace ladder
