// SPDX-License-Identifier: BSD-3-Clause
// Many light climbs, each in a copy of this process, and what became of them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "robot_in_a_box/light_climb.h"

namespace robot_in_a_box {

struct LightScore {
  std::uint64_t seed = 0;
  LightEnd end = LightEnd::kTooLong;
  std::string reason;
  int rungs_climbed = 0;
  double seconds = 0.0;
  std::uint64_t frame_hash = 0;  ///< equal runs, equal numbers
  std::int64_t num_targets = 0;  ///< that the monitor checked
  std::int64_t num_violations = 0;
  std::string first_violation;  ///< "" = none
};

/// In the order of seeds.
std::vector<LightScore> run_light_climbs(std::uint64_t first_seed, int num_climbs, int num_jobs,
                                         const LightClimbParams& base = {});

std::int64_t num_violated(const std::vector<LightScore>& scores);
void print(const std::vector<LightScore>& scores);
/// False: the file cannot be written.
bool write_json(const std::vector<LightScore>& scores, const std::string& path);

}  // namespace robot_in_a_box
