// SPDX-License-Identifier: BSD-3-Clause
// Rungs stay where they were. The front heads see a rung well while it passes them; then the
// robot's own legs hide it, just when a claw wants it: a front leg its own target, all legs what
// lies under the belly. A rung that was trusted and sound is therefore remembered for a while, in
// odom; what is seen of it now moves it. Farther ahead no sound rung is remembered.
// Damage is remembered, where no own leg can pretend it: of a trusted rung at once, of one that is
// not trusted once it was seen several times. It wins over what looks sound until that was seen for
// long. And the other way round: a rung that was seen sound for as long, where no leg was before
// it, stays so when it passes between them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "climb_controller/perception_inbox.h"

namespace climb_controller {

struct RungMemoryParams {
  double memory_s = 90.0;  ///< 0 = nothing is remembered (own: two rungs take 60 s)
  /// Body x from which on only what is seen counts (run: a front leg under way hides its own
  /// target, at most so far ahead).
  double ahead_m = 0.70;
  /// Body x from which on damage is remembered (run: between the own legs a quarter of all looks at
  /// sound rungs says bent and sagged, farther ahead none of 4000). Nearer it counts at that
  /// moment, of a rung that was not seen sound in sound_frames messages from here on.
  double clear_m = 0.40;
  double same_rung_m = 0.05;  ///< nearer axes are the same rung (own: a fifth of a spacing)
  int damage_frames = 3;      ///< messages with a damaged rung that is not trusted (own)
  int sound_frames = 12;  ///< ... with a sound, trusted one, until it is no longer damaged (own)
};

/// "" or the violated relation, naming the field.
std::string check(const RungMemoryParams& params);

class RungMemory {
 public:
  explicit RungMemory(const RungMemoryParams& params) : params_(params) {
    remembered_.reserve(kMaxRungs);
  }

  /// Learns from what is seen and adds to it what is remembered. `T_odom_body`: as estimated now.
  void complete(std::int64_t now_us, const Eigen::Isometry3d& T_odom_body, RungsSnapshot& snapshot);

 private:
  static constexpr std::size_t kMaxRungs = 32;
  struct Remembered {
    climb::RungView rung;
    std::array<climb::StretchView, 4> stretches;  ///< what exceeds it is forgotten
    std::size_t num_stretches = 0;
    double graspable_m = 0.0;  ///< all stretches together
    std::int64_t seen_us = 0;
    std::int64_t suspected_us = -1'000'000'000'000;  ///< seen damaged
    int damage = 0;  ///< messages that say so, less those that say that it is sound
    bool is_damaged = false;
    int num_clear = 0;  ///< messages that say it is sound, clear of own legs
  };
  Remembered* find(const climb::RungView& seen);
  Remembered* begin(const climb::RungView& seen);
  void forget(Remembered* known);
  void learn(std::int64_t now_us, int index, double ahead_m, const RungsSnapshot& snapshot);
  void learn_damage(std::int64_t now_us, const climb::RungView& seen);
  void spoil(const Remembered& remembered, bool is_ahead, RungsSnapshot& snapshot) const;
  void add(const Remembered& remembered, RungsSnapshot& snapshot) const;
  bool is_same(const climb::RungView& a, const climb::RungView& b) const;

  RungMemoryParams params_;
  std::vector<Remembered> remembered_;
  std::int64_t confirmed_us_ = -1'000'000'000'000;
};

}  // namespace climb_controller
