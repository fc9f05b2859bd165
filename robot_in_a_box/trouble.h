// SPDX-License-Identifier: BSD-3-Clause
// Random troubles from a seed: faults of the plant by script; orders, sensors and the process by
// chance. The same seed upon the same box brings the same troubles at the same times.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rng.h"
#include "robot_in_a_box/climb_box.h"
#include "simulator/plant/fault_script.h"

namespace robot_in_a_box {

/// Takes one line of what happens.
using Tell = std::function<void(const std::string& line)>;

struct TroubleParams {
  std::int64_t until_us = 4'000'000;  ///< from now on: faults of the plant begin before
  int max_faults = 4;                 ///< of the plant, at least one; 0 = none
  std::uint32_t order_every = 60;     ///< cycles between orders at random, on average; 0 = none
  std::uint32_t begin_every = 150;    ///< cycles between other troubles, on average
};

/// Watches the box while it lives; the box outlives it.
class Trouble : public BoxWatcher {
 public:
  Trouble(ClimbBox& box, std::uint64_t seed, const TroubleParams& params, Tell tell = {});

  /// Before each cycle. Nothing new begins unless it may.
  void act(bool may_begin);

  // BoxWatcher
  void before(std::int64_t now_us) override;
  void on_frame(const simulator::CarriedFrame&) override {}
  void on_truth(const simulator::PlantTruth& truth) override;
  void on_report(const climb_controller::CycleReport&) override {}

 private:
  void begin();
  void give_order();
  void say(const std::string& what) const;

  ClimbBox& box_;
  TroubleParams params_;
  base::Rng rng_;
  std::vector<simulator::Fault> faults_;
  simulator::FaultPlayer player_;
  Tell tell_;
  std::string told_;
  std::size_t num_violations_told_ = 0;
};

}  // namespace robot_in_a_box
