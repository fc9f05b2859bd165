// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/rung_memory.h"

#include <algorithm>

namespace climb_controller {
namespace {

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
  return "";
}

void RungMemory::complete(std::int64_t now_us, const Eigen::Isometry3d& T_odom_body,
                          RungsSnapshot& snapshot) {
  const auto memory_us = static_cast<std::int64_t>(params_.memory_s * 1e6);
  std::erase_if(remembered_,
                [&](const Remembered& each) { return now_us - each.seen_us > memory_us; });
  const Eigen::Isometry3d T_body_odom = T_odom_body.inverse();
  const auto is_ahead = [&](const climb::RungView& rung) {
    return (T_body_odom * middle_m(rung)).x() >= params_.ahead_m;
  };
  for (std::size_t i = 0; i < snapshot.rungs.size(); ++i) {
    if (snapshot.rungs[i].trusted) learn(now_us, static_cast<int>(i), is_ahead, snapshot);
  }
  if (snapshot.confirmed) confirmed_us_ = now_us;
  bool is_any_added = false;
  for (const Remembered& each : remembered_) {
    if (is_ahead(each.rung)) continue;
    add(each, snapshot);
    is_any_added = true;
  }
  const bool was_ladder = now_us - confirmed_us_ <= memory_us;
  snapshot.confirmed = snapshot.confirmed || (is_any_added && was_ladder);
}

template <class IsAhead>
void RungMemory::learn(std::int64_t now_us, int index, const IsAhead& is_ahead,
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
  const auto known = std::find_if(remembered_.begin(), remembered_.end(),
                                  [&](const Remembered& each) { return is_same(each.rung, seen); });
  const bool is_full = remembered_.size() >= kMaxRungs;
  if (known != remembered_.end()) {
    learned.rung.confidence = std::max(learned.rung.confidence, known->rung.confidence);
    known->rung.confidence = learned.rung.confidence;
  }
  if (known == remembered_.end()) {
    if (!seen.damaged && learned.graspable_m > 0.0 && !is_full) remembered_.push_back(learned);
  } else if (is_ahead(seen)) {
    *known = learned;
    if (seen.damaged || !(learned.graspable_m > 0.0)) remembered_.erase(known);
  } else if (!seen.damaged) {
    // Where own legs hide parts of it: the place is news, its thickness is not, and what could be
    // grasped of it only when it is more.
    known->rung.end0_m = seen.end0_m;
    known->rung.end1_m = seen.end1_m;
    known->seen_us = now_us;
    if (learned.graspable_m <= known->graspable_m) return;
    known->stretches = learned.stretches;
    known->num_stretches = learned.num_stretches;
    known->graspable_m = learned.graspable_m;
  }
}

void RungMemory::add(const Remembered& remembered, RungsSnapshot& snapshot) const {
  climb::RungView rung = remembered.rung;
  int index = -1;
  for (std::size_t i = 0; i < snapshot.rungs.size(); ++i) {
    const climb::RungView& seen = snapshot.rungs[i];
    if (!is_same(seen, rung)) continue;
    if (seen.trusted && seen.damaged) return;
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
