// SPDX-License-Identifier: BSD-3-Clause
// One case of a drill: a robot in some situation, a fault that comes upon it, and what an observer
// of bus, plant and published state sees of the reaction. Rows of the fault table say what is
// injected and what is expected; this file keeps the clock.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "robot_in_a_box/situation.h"

namespace robot_in_a_box {

class CaseRun;

/// One way in which one row of the fault table can come true. Functions get the running case.
struct DrillRow {
  int number = 0;         ///< of the fault table
  const char* part = "";  ///< "a", "b".. where a row has several
  const char* fault = "";
  const char* injected = "";
  const char* reaction = "";
  /// Is there something to expect in this situation? `target`: 0 .. num_targets - 1.
  bool (*applies)(const Situation& situation) = nullptr;
  int num_targets = 1;
  void (*inject)(CaseRun& run) = nullptr;
  /// When it became visible to the controller, -1 = not yet. Null: as soon as it happens.
  std::int64_t (*visible_at)(const CaseRun& run) = nullptr;
  bool (*has_reacted)(const CaseRun& run) = nullptr;
  /// What must not be, from the injection on; nullptr = nothing is wrong.
  const char* (*harm)(const CaseRun& run) = nullptr;
  /// Further acts, each millisecond after the injection.
  void (*go_on)(CaseRun& run) = nullptr;
  std::int64_t bound_us = 0;
  std::int64_t watch_us = 500'000;  ///< after the injection
};

struct CaseResult {
  bool visible = false;  ///< the fault showed itself at all
  bool met = false;
  std::int64_t reaction_us = -1;  ///< from visible to reacted, -1 = never
  std::array<char, 160> why{};    ///< "" when met
};

/// What the master last told one axis.
struct AxisWatch {
  std::uint16_t control_word = 0;
  std::int32_t target = 0;
  std::int32_t measured = 0;
  std::int64_t told_us = -1;
  std::int64_t moved_us = -1;       ///< the target last changed by more than a count
  std::int64_t enabled_us = -1;     ///< last frame with 0x0F
  std::int64_t quick_stop_us = -1;  ///< last frame with 0x0B
};

class CaseRun : public BoxWatcher {
 public:
  CaseRun(ClimbBox& box, const DrillRow& row, int target, std::uint64_t seed);

  /// `instead` watches the box and passes everything on to this.
  CaseResult run(BoxWatcher* instead = nullptr);

  // --- for the rows ------------------------------------------------------------------------------
  ClimbBox& box() { return box_; }
  const ClimbBox& box() const { return box_; }
  const climb_controller::CycleReport& report() const { return report_; }
  const simulator::PlantTruth& truth() const { return truth_; }
  const simulator::PlantTruth& truth_before() const { return truth_before_; }
  const Situation& before() const { return before_; }
  climb::Fault reason_before() const { return reason_before_; }
  climb::ControllerState state() const { return report_.output.state; }
  climb::Fault reason() const { return report_.output.reason; }
  climb::LimbState limb(int leg) const {
    return report_.output.limbs[static_cast<std::size_t>(leg)];
  }
  int target() const { return target_; }
  base::Rng& rng() { return rng_; }
  std::int64_t now_us() const { return now_us_; }
  std::int64_t since_us() const { return now_us_ - injected_us_; }
  std::int64_t injected_us() const { return injected_us_; }
  std::int64_t visible_us() const { return visible_us_; }
  std::int64_t bound_us() const { return row_.bound_us; }
  std::int64_t reacted_us() const { return reacted_us_; }
  const AxisWatch& axis(int index) const { return axes_[static_cast<std::size_t>(index)]; }
  /// Of the limb that is under way; else front left.
  int moving_leg() const { return before_.leg >= 0 ? before_.leg : 0; }
  /// A leg that is not under way, another one for each target.
  int stance_leg() const { return (moving_leg() + 1 + target_ % 3) % climb::kNumLegs; }
  /// Any axis: even targets on the moving limb, odd ones on another.
  int some_axis() const { return axis_; }
  std::int64_t last_master_frame_us() const { return last_master_frame_us_; }
  /// Last frame of this id from anybody but the master.
  std::int64_t heard_us(std::uint32_t id) const { return heard_us_[id & 0x7FFU]; }
  std::int64_t messages_since() const { return box_.perception().received_us() - injected_us_; }
  /// For rows that need to remember something.
  std::int64_t memo = -1;

  // BoxWatcher
  void before(std::int64_t now_us) override;
  void on_frame(const simulator::CarriedFrame& carried) override;
  void on_truth(const simulator::PlantTruth& truth) override;
  void on_report(const climb_controller::CycleReport& report) override;

 private:
  void judge();
  void fail(const std::string& why);

  ClimbBox& box_;
  const DrillRow& row_;
  int target_;
  base::Rng rng_;
  int axis_ = 0;
  Situation before_;
  climb::Fault reason_before_;
  simulator::PlantTruth truth_before_;
  std::int64_t num_violations_before_ = 0;
  climb_controller::CycleReport report_;
  simulator::PlantTruth truth_;
  std::int64_t now_us_ = 0;
  std::int64_t inject_at_us_ = 0;
  std::int64_t injected_us_ = -1;
  std::int64_t visible_us_ = -1;
  std::int64_t reacted_us_ = -1;
  std::array<AxisWatch, simulator::kNumAxes> axes_;
  std::array<std::int64_t, 0x800> heard_us_{};
  std::int64_t last_master_frame_us_ = -1;
  CaseResult result_;
};

/// The whole table: every row 1..32 at least once.
std::span<const DrillRow> drill_rows();

}  // namespace robot_in_a_box
