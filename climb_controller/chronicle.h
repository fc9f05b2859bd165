// SPDX-License-Identifier: BSD-3-Clause
// Tells what changed from one report to the next in words: state and reason, faults of the bus,
// objects that a drive lacks, answers to orders, lines. Told once each, not every cycle.
#pragma once

#include <cstdint>

#include "climb_controller/control_cycle.h"
#include "runtime/journal.h"

namespace climb_controller {

class Chronicle {
 public:
  explicit Chronicle(runtime::Journal& journal) : journal_(journal) {}

  void tell(const CycleReport& report);

  /// True once after each stop that the operator must acknowledge.
  bool take_stop();

 private:
  void tell_state(const CycleReport& report);
  void tell_answer(const CycleReport& report);
  void tell_bus(const CycleReport& report);
  void tell_lines(const LineLevels& lines);

  runtime::Journal& journal_;
  climb::ControllerState state_ = climb::ControllerState::kBoot;
  climb::Fault reason_ = climb::Fault::kNone;
  climb::Refusal refusal_ = climb::Refusal::kNone;
  std::uint64_t num_answers_ = 0;
  std::size_t num_faults_ = 0;
  std::size_t num_issues_ = 0;
  bool lines_lost_ = false;
  bool estop_clear_ = true;
  bool has_stopped_ = false;
};

}  // namespace climb_controller
