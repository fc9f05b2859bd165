// SPDX-License-Identifier: BSD-3-Clause
// Runs the fault table: every row in every situation that the tours reach, each case in a forked
// copy of the robot at that moment, and counts.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "robot_in_a_box/drill_case.h"
#include "robot_in_a_box/tour.h"

namespace robot_in_a_box {

struct DrillOptions {
  std::set<int> rows;        ///< empty = all
  std::set<TourKind> tours;  ///< empty = all
  int num_jobs = 0;          ///< 0 = one per processor
  std::uint64_t seed = 1;
  int every = 1;                    ///< only each n-th situation, for a quick look
  std::size_t num_misses_told = 5;  ///< of each row
};

struct RowScore {
  const DrillRow* row = nullptr;
  int cases = 0;
  int missed = 0;
  int unseen = 0;  ///< the fault never showed itself: not counted as a case
  std::int64_t worst_us = -1;
  std::vector<std::string> misses;  ///< the first ones: which case, and why
};

struct DrillScore {
  std::vector<RowScore> rows;
  int num_situations = 0;
};

DrillScore run_drill(const DrillOptions& options);

/// One case again, by the name that a miss is reported under ("11@climb:1234:0"), with every change
/// of state told. False: no such case.
bool replay_case(const std::string& name, std::uint64_t seed,
                 const std::function<void(const std::string& line)>& tell);

}  // namespace robot_in_a_box
