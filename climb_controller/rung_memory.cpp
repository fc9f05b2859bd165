// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/rung_memory.h"

#include <algorithm>

namespace climb_controller {
namespace {

constexpr std::int64_t kSuspicion_us = 1'000'000;  ///< longer ago, one sighting proves nothing

/// So much of the longest stretch that was graspable, and nothing hides the rung.
constexpr double kAsWell = 0.9;

Eigen::Vector3d middle_m(const climb::RungView& rung) {
  return 0.5 * (rung.end0_m + rung.end1_m);
}

/// From a point to the nearest one of the rung's line.
Eigen::Vector3d off_line_m(const Eigen::Vector3d& point_m, const climb::RungView& rung) {
  const Eigen::Vector3d axis = (rung.end1_m - rung.end0_m).normalized();
  const Eigen::Vector3d off_m = rung.end0_m - point_m;
  return off_m - off_m.dot(axis) * axis;
}

}  // namespace

std::string check(const RungMemoryParams& params) {
  if (!(params.memory_s >= 0.0 && params.memory_s <= 3600.0)) return "memory_s must be 0..3600";
  if (!(params.ahead_m >= -2.0 && params.ahead_m <= 2.0)) return "ahead_m must be -2..2";
  if (!(params.same_rung_m > 0.0 && params.same_rung_m < 0.1)) {
    return "same_rung_m must be above 0, below 0.1";
  }
  if (!(params.clear_m >= -2.0 && params.clear_m <= 2.0)) return "clear_m must be -2..2";
  if (!(params.damage_frames >= 1 && params.damage_frames <= params.sound_frames)) {
    return "damage_frames must be 1..sound_frames";
  }
  if (!(params.sound_frames <= 1000)) return "sound_frames must be at most 1000";
  return "";
}

void RungMemory::complete(std::int64_t now_us, const Eigen::Isometry3d& T_odom_body,
                          RungsSnapshot& snapshot) {
  const auto memory_us = static_cast<std::int64_t>(params_.memory_s * 1e6);
  std::erase_if(remembered_,
                [&](const Remembered& each) { return now_us - each.seen_us > memory_us; });
  const Eigen::Isometry3d T_body_odom = T_odom_body.inverse();
  const auto ahead_m = [&](const climb::RungView& rung) {
    return (T_body_odom * middle_m(rung)).x();
  };
  const auto is_ahead = [&](const climb::RungView& rung) {
    return ahead_m(rung) >= params_.ahead_m;
  };
  for (std::size_t i = 0; i < snapshot.rungs.size(); ++i) {
    const climb::RungView& seen = snapshot.rungs[i];
    if (seen.damaged) {
      if (ahead_m(seen) >= params_.clear_m) learn_damage(now_us, seen);
    } else if (seen.trusted) {
      learn(now_us, static_cast<int>(i), ahead_m(seen), snapshot);
    }
  }
  if (snapshot.confirmed) confirmed_us_ = now_us;
  bool is_any_added = false;
  for (const Remembered& each : remembered_) {
    if (each.is_damaged) {
      spoil(each, is_ahead(each.rung), snapshot);
    } else if (!is_ahead(each.rung) && each.graspable_m > 0.0) {
      add(each, snapshot);
      is_any_added = true;
    }
  }
  const bool was_ladder = now_us - confirmed_us_ <= memory_us;
  snapshot.confirmed = snapshot.confirmed || (is_any_added && was_ladder);
}

RungMemory::Remembered* RungMemory::find(const climb::RungView& seen) {
  const auto known = std::find_if(remembered_.begin(), remembered_.end(),
                                  [&](const Remembered& each) { return is_same(each.rung, seen); });
  return known == remembered_.end() ? nullptr : &*known;
}

RungMemory::Remembered* RungMemory::begin(const climb::RungView& seen) {
  if (remembered_.size() >= kMaxRungs) return nullptr;
  remembered_.emplace_back();
  remembered_.back().rung = seen;
  remembered_.back().rung.damaged = false;  // that is told beside it
  return &remembered_.back();
}

void RungMemory::learn_damage(std::int64_t now_us, const climb::RungView& seen) {
  Remembered* known = find(seen);
  if (known == nullptr) known = begin(seen);
  if (known == nullptr) return;
  // Something before a rung that passes is no damage.
  if (!known->is_damaged && now_us - known->suspected_us > kSuspicion_us) known->damage = 0;
  known->seen_us = known->suspected_us = now_us;
  known->num_clear = 0;
  known->damage = seen.trusted ? params_.sound_frames : known->damage + 1;
  known->damage = std::min(known->damage, params_.sound_frames);
  if (known->damage >= params_.damage_frames) known->is_damaged = true;
}

void RungMemory::learn(std::int64_t now_us, int index, double ahead_m,
                       const RungsSnapshot& snapshot) {
  const climb::RungView& seen = snapshot.rungs[static_cast<std::size_t>(index)];
  Remembered learned;
  learned.rung = seen;
  learned.seen_us = now_us;
  for (const climb::StretchView& stretch : snapshot.stretches) {
    if (stretch.rung_index != index || learned.num_stretches == learned.stretches.size()) continue;
    learned.stretches[learned.num_stretches++] = stretch;
    learned.graspable_m += stretch.to_m - stretch.from_m;
  }
  Remembered* known = find(seen);
  const int was_clear = known == nullptr ? 0 : known->num_clear;
  const bool is_clear = ahead_m >= params_.clear_m && learned.graspable_m > 0.0;
  learned.num_clear = std::min(was_clear + (is_clear ? 1 : 0), params_.sound_frames);
  if (known == nullptr) {
    if (!(learned.graspable_m > 0.0)) return;
    known = begin(seen);
    if (known != nullptr) *known = learned;
    return;
  }
  // What once looked damaged looks sound again: after as many looks as it takes, it is.
  if (known->damage > 0 && --known->damage == 0) known->is_damaged = false;
  learned.damage = known->damage;
  learned.is_damaged = known->is_damaged;
  learned.suspected_us = known->suspected_us;
  learned.rung.confidence = std::max(learned.rung.confidence, known->rung.confidence);
  known->rung.confidence = learned.rung.confidence;
  known->num_clear = learned.num_clear;
  const bool was_sound = known->graspable_m > 0.0;
  if (ahead_m >= params_.ahead_m || !was_sound) {
    *known = learned;
    if (!(learned.graspable_m > 0.0) && learned.damage == 0) forget(known);
    return;
  }
  // Where own legs hide parts of it, place and certainty are news; its thickness is none, nor what
  // could be grasped of it, unless it is seen about as well as ever.
  known->rung.end0_m = seen.end0_m;
  known->rung.end1_m = seen.end1_m;
  known->rung.covariance_m2 = seen.covariance_m2;
  known->seen_us = now_us;
  if (learned.graspable_m >= kAsWell * known->graspable_m) known->rung.radius_m = seen.radius_m;
  if (learned.graspable_m <= known->graspable_m) return;
  known->stretches = learned.stretches;
  known->num_stretches = learned.num_stretches;
  known->graspable_m = learned.graspable_m;
}

void RungMemory::forget(Remembered* known) {
  remembered_.erase(remembered_.begin() + (known - remembered_.data()));
}

void RungMemory::spoil(const Remembered& remembered, bool is_ahead, RungsSnapshot& snapshot) const {
  bool is_seen = false;
  for (climb::RungView& seen : snapshot.rungs) {
    if (!is_same(seen, remembered.rung)) continue;
    seen.damaged = is_seen = true;
  }
  if (is_seen || is_ahead || snapshot.rungs.size() == snapshot.rungs.capacity()) return;
  snapshot.rungs.push_back(remembered.rung);
  snapshot.rungs.back().trusted = snapshot.rungs.back().damaged = true;
}

void RungMemory::add(const Remembered& remembered, RungsSnapshot& snapshot) const {
  climb::RungView rung = remembered.rung;
  int index = -1;
  for (std::size_t i = 0; i < snapshot.rungs.size(); ++i) {
    const climb::RungView& seen = snapshot.rungs[i];
    if (!is_same(seen, rung)) continue;
    const bool is_sound = remembered.num_clear >= params_.sound_frames;
    if (seen.trusted && seen.damaged && !is_sound) return;
    index = static_cast<int>(i);
    if (seen.damaged) continue;
    // Seen again, though perhaps not well enough to be trusted anew: there it is.
    const Eigen::Vector3d moved_m = off_line_m(middle_m(rung), seen);
    rung.end0_m += moved_m;
    rung.end1_m += moved_m;
  }
  if (index < 0) {
    if (snapshot.rungs.size() == snapshot.rungs.capacity()) return;
    index = static_cast<int>(snapshot.rungs.size());
    snapshot.rungs.push_back(rung);
  } else {
    rung.id = snapshot.rungs[static_cast<std::size_t>(index)].id;
    snapshot.rungs[static_cast<std::size_t>(index)] = rung;
  }
  for (std::size_t i = 0; i < remembered.num_stretches; ++i) {
    if (snapshot.stretches.size() == snapshot.stretches.capacity()) return;
    const climb::StretchView& stretch = remembered.stretches[i];
    snapshot.stretches.push_back({index, stretch.from_m, stretch.to_m});
  }
}

bool RungMemory::is_same(const climb::RungView& a, const climb::RungView& b) const {
  return off_line_m(middle_m(a), b).norm() <= params_.same_rung_m;
}

}  // namespace climb_controller
