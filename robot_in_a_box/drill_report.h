// SPDX-License-Identifier: BSD-3-Clause
// The results of a drill as a table for people and as JSON for machines.
#pragma once

#include <string>

#include "robot_in_a_box/drill.h"
#include "robot_in_a_box/random_drill.h"

namespace robot_in_a_box {

struct DrillReport {
  DrillScore table;
  std::set<int> not_asked_for;  ///< rows that --rows left out
  std::vector<SeedResult> seeds;
  KillScore kills;
};

/// Rows of 1..32 that nothing was run for, although asked for.
std::vector<int> rows_not_run(const DrillReport& report);
int num_missed(const DrillReport& report);

void print(const DrillReport& report);
/// False: the file cannot be written.
bool write_json(const DrillReport& report, const std::string& path);

}  // namespace robot_in_a_box
