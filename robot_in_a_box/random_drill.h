// SPDX-License-Identifier: BSD-3-Clause
// Random troubles from random situations under the nine invariants, and sudden deaths of the
// controller. A seed says everything: which tour, from when, which faults and orders.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot_in_a_box/drill_case.h"
#include "robot_in_a_box/tour.h"
#include "robot_in_a_box/trouble.h"

namespace robot_in_a_box {

struct SeedResult {
  std::uint64_t seed = 0;
  std::string situation;         ///< where the faults began
  std::uint64_t frame_hash = 0;  ///< of all frames from the start on: equal runs, equal numbers
  std::int64_t num_targets = 0;  ///< that the monitor checked
  std::int64_t num_violations = 0;
  std::string first_violation;  ///< "" = none
};

/// At least five simulated seconds per seed after the tour was left. In the order of seeds.
std::vector<SeedResult> run_random(std::uint64_t first_seed, int num_seeds, int num_jobs);

/// One seed again, with everything that happens told.
void tell_seed(std::uint64_t seed, const Tell& tell);

/// The controller disappears at random instants while drives follow targets.
struct KillScore {
  int kills = 0;
  int missed = 0;
  std::int64_t worst_us = 0;  ///< until all drives have begun their quick stop
  std::vector<std::string> misses;
};
KillScore run_kills(std::uint64_t seed, int num_kills, int num_jobs);

}  // namespace robot_in_a_box
