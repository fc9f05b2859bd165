// SPDX-License-Identifier: BSD-3-Clause
// An operator's day with one robot, as a script: start, arm in the dock, climb, and on the way one
// kind of trouble again and again, so that every state of controller and limbs is visited. What a
// drill injects comes on top.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <span>

#include "robot_in_a_box/situation.h"

namespace robot_in_a_box {

enum class TourKind : std::uint8_t {
  kClimb,          ///< nothing happens; disarmed at the top
  kPauses,         ///< the operator pauses in every situation
  kSilences,       ///< perception stops now and then
  kMisses,         ///< one touch switch after the other fails once
  kWithdrawals,    ///< targets are withdrawn on the way to them
  kStops,          ///< a fault in every situation, reset, armed again
  kEstops,         ///< the same by E-stop
  kLostFrontLeft,  ///< the rung under one limb breaks
  kLostFrontRight,
  kLostRearLeft,
  kLostRearRight
};
inline constexpr int kNumTourKinds = static_cast<int>(TourKind::kLostRearRight) + 1;

const char* name(TourKind kind);

/// The robot of a tour: a ladder of `num_rungs`, drills differ in nothing else.
ClimbBoxParams tour_params(TourKind kind, std::uint64_t seed);

class Tour {
 public:
  Tour(TourKind kind, ClimbBox& box) : kind_(kind), box_(box), rng_(kind_seed(kind)) {}

  /// What operator and world do before the next cycle of the box.
  void act();
  bool is_over() const { return over_; }

 private:
  static std::uint64_t kind_seed(TourKind kind) { return 77 + static_cast<std::uint64_t>(kind); }
  void work_through();
  void trouble();
  void pause();
  void silence();
  void miss();
  void withdraw();
  void stop(bool by_estop);
  void lose(climb::Leg leg);
  bool is_new();
  std::int64_t in_state_us() const { return box_.now_us() - state_since_us_; }

  TourKind kind_;
  ClimbBox& box_;
  base::Rng rng_;
  climb::ControllerState state_ = climb::ControllerState::kBoot;
  std::int64_t state_since_us_ = 0;
  std::set<Situation> troubled_;
  std::array<int, climb::kNumLegs> num_done_{};
  int leg_in_trouble_ = -1;
  std::int64_t trouble_since_us_ = 0;
  std::int64_t next_trouble_us_ = 0;
  bool was_up_ = false;
  bool over_ = false;
};

}  // namespace robot_in_a_box
