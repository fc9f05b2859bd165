// SPDX-License-Identifier: BSD-3-Clause
// The words in which a simulated scene is described on a command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulator/simulation.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
}

namespace simulator {

class SimulationOptions {
 public:
  /// Adds the options to `app`, which must be parsed while this stands.
  explicit SimulationOptions(CLI::App& app);
  SimulationOptions(const SimulationOptions&) = delete;
  SimulationOptions& operator=(const SimulationOptions&) = delete;

  /// What was parsed. Throws std::invalid_argument for a name that nobody knows.
  SimulationParams params() const;

 private:
  SimulationParams simulation_;
  std::string scene_ = "plain";
  std::string layout_ = "heads_still";
  std::string depth_ = "radial";
  std::vector<int> dead_heads_;
  std::optional<double> diameter_m_, rail_diameter_m_, wall_reflectance_;
  std::string section_ = "round";
  std::optional<double> removal_s_;
  int removed_rung_ = 2;
};

}  // namespace simulator
