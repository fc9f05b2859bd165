// SPDX-License-Identifier: BSD-3-Clause
#include "climb/way_back.h"

#include <algorithm>

namespace climb {
namespace {

constexpr double kFollow = 0.5;        ///< of what a new hold is off: it settles by some mm still
constexpr double kSlack_m = 0.002;     ///< of a place along its rung
constexpr double kLeastApart_m = 0.1;  ///< of two places whose line is the rung's axis

std::size_t side_of(Leg leg) {
  return lateral_sign(leg) > 0.0 ? 1 : 0;
}

Eigen::Vector3d off_line_m(const Eigen::Vector3d& point_m, const Eigen::Vector3d& on_line_m,
                           const Eigen::Vector3d& axis) {
  const Eigen::Vector3d off_m = point_m - on_line_m;
  return off_m - off_m.dot(axis) * axis;
}

}  // namespace

WayBack::WayBack(const ClimbParams& params) : claw_(params.robot.claw), params_(params.grasp) {
  known_.reserve(kMaxRungs);
  rungs_.reserve(kMaxRungs + kMaxSeen);
  stretches_.reserve(2 * kMaxRungs + kMaxSeen);
}

void WayBack::clear() {
  known_.clear();
  drift_m_.setZero();
}

void WayBack::leave(Leg leg, const LimbGoal& place) {
  const Eigen::Vector3d place_m = place.grasp_m - drift_m_;
  if (!place_m.allFinite() || !place.axis.allFinite()) return;
  Known* known = find(place_m);
  if (known == nullptr) {
    if (known_.size() == kMaxRungs) known_.erase(known_.begin());
    known_.emplace_back();
    known = &known_.back();
    known->id = kFirstId + num_ever_++;
    known->axis = place.axis;
  }
  known->places_m[side_of(leg)] = place_m;
  known->radius_m = place.radius_m > 0.0 ? place.radius_m : claw_.on_rung_radius_m;
  const auto& [right_m, left_m] = known->places_m;
  const bool is_wide = right_m && left_m && (*left_m - *right_m).norm() > kLeastApart_m;
  if (is_wide) known->axis = (*left_m - *right_m).normalized();
}

void WayBack::return_to(Leg leg, const Eigen::Vector3d& held_m) {
  Known* known = find(held_m - drift_m_);
  if (known == nullptr || !known->places_m[side_of(leg)]) return;
  const Eigen::Vector3d off_m = held_m - drift_m_ - *known->places_m[side_of(leg)];
  if (off_m.norm() <= params_.same_rung_m) drift_m_ += kFollow * off_m;
}

void WayBack::look(const LadderView& seen) {
  rungs_.clear();
  stretches_.clear();
  seen_age_s_ = seen.age_s;
  is_ladder_ = seen.confirmed || !known_.empty();
  for (const Known& known : known_) show(known);
  const std::size_t num_seen = std::min(seen.rungs.size(), kMaxSeen);
  for (std::size_t i = 0; i < num_seen; ++i) {
    const Eigen::Vector3d middle_m = 0.5 * (seen.rungs[i].end0_m + seen.rungs[i].end1_m);
    if (find(middle_m - drift_m_) != nullptr) continue;
    const int index = static_cast<int>(rungs_.size());
    rungs_.push_back(seen.rungs[i]);
    for (const StretchView& stretch : seen.stretches) {
      const bool is_of_it = stretch.rung_index == static_cast<int>(i);
      if (!is_of_it || stretches_.size() == stretches_.capacity()) continue;
      stretches_.push_back({index, stretch.from_m, stretch.to_m});
    }
  }
}

WayBack::Known* WayBack::find(const Eigen::Vector3d& point_m) {
  const auto known = std::find_if(known_.begin(), known_.end(), [&](const Known& each) {
    return off_line_m(point_m, each.any_m(), each.axis).norm() <= params_.same_rung_m;
  });
  return known == known_.end() ? nullptr : &*known;
}

void WayBack::show(const Known& known) {
  const double half_m = 0.5 * claw_.width_m + params_.claw_margin_m + kSlack_m;
  const int index = static_cast<int>(rungs_.size());
  const Eigen::Vector3d from_m = known.any_m();
  double high_m = half_m;
  for (const std::optional<Eigen::Vector3d>& place_m : known.places_m) {
    if (!place_m) continue;
    const double along_m = known.axis.dot(*place_m - from_m);
    stretches_.push_back({index, along_m, along_m + 2.0 * half_m});
    high_m = std::max(high_m, along_m + half_m);
  }
  RungView rung;
  rung.id = known.id;
  rung.trusted = true;
  rung.confidence = 1.0;
  rung.radius_m = known.radius_m;
  rung.end0_m = from_m + drift_m_ - half_m * known.axis;
  rung.end1_m = from_m + drift_m_ + high_m * known.axis;
  rungs_.push_back(rung);
}

}  // namespace climb
