// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/truth_line.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace simulator {

std::string truth_line(const PlantTruth& truth) {
  std::string claws;
  for (const LegTruth& leg : truth.legs) {
    claws.append(" ").append(leg.holds ? std::to_string(leg.rung_index) : "-");
    if (leg.holds && leg.touch) claws.append("*");
  }
  const auto num_in = [&truth](PowerState state) {
    return static_cast<int>(std::count(truth.power.begin(), truth.power.end(), state));
  };
  const int num_stopped = num_in(PowerState::kQuickStopActive);
  std::string stopped;
  if (num_stopped > 0) stopped.append("  stopped ").append(std::to_string(num_stopped));
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(), "enabled %2d%s  claws%s  z %.3f m%s%s%s",
                num_in(PowerState::kOperationEnabled), stopped.c_str(), claws.c_str(),
                truth.T_world_body.translation().z(), truth.docked ? "  docked" : "",
                truth.lines[kEstopN] ? "" : "  E-STOP", truth.fallen ? "  FALLEN" : "");
  return text.data();
}

}  // namespace simulator
