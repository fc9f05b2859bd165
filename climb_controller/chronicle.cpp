// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/chronicle.h"

#include <string>
#include <utility>

namespace climb_controller {
namespace {

using climb::CommandVerdict;

const char* word(climb::Order order) {
  constexpr const char* kWords[] = {"none",  "arm",  "climb", "climb down",
                                    "pause", "hold", "reset", "disarm"};
  return kWords[static_cast<int>(order)];
}

std::string place(int axis) {
  if (axis < 0) return "servo bus";
  constexpr const char* kJoints[] = {"abduction", "hip", "knee", "jaw"};
  const auto leg = static_cast<climb::Leg>(axis / climb::kNumAxesPerLeg);
  return std::string("axis ") + std::to_string(axis) + " (" + climb::name(leg) + " " +
         kJoints[axis % climb::kNumAxesPerLeg] + ")";
}

/// The first object that stands behind the refusal; "" = none is known.
std::string culprit(const CycleReport& report) {
  const bool is_hold = report.policy == Policy::kNoHoldOnLoss;
  const bool is_torque = report.policy == Policy::kNoTorqueLimit;
  for (const can::ObjectIssue& issue : report.issues) {
    const bool concerns_hold = issue.index == 0x6007 || issue.index == 0x605A ||
                               issue.index == 0x1016 || issue.index == 0x6085;
    const bool concerns_torque = issue.index == 0x6072 || issue.index == 0x6077;
    if ((is_hold && concerns_hold) || (is_torque && concerns_torque)) {
      return " (" + can::describe(issue) + ")";
    }
  }
  return "";
}

std::string hexadecimal(std::uint32_t number) {
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string text;
  for (int shift = 28; shift >= 0; shift -= 4) {
    const std::uint32_t digit = number >> shift & 0xF;
    if (digit != 0 || !text.empty() || shift == 0) text += kDigits[digit];
  }
  return text + "h";
}

}  // namespace

void Chronicle::tell(const CycleReport& report) {
  tell_bus(report);
  tell_lines(report.lines);
  tell_answer(report);
  tell_state(report);
}

bool Chronicle::take_stop() {
  return std::exchange(has_stopped_, false);
}

void Chronicle::tell_state(const CycleReport& report) {
  const climb::ControllerOutput& output = report.output;
  if (output.refusal != refusal_ && output.refusal != climb::Refusal::kNone) {
    journal_.info(std::string("no grasp to be had: ") + climb::name(output.refusal));
  }
  refusal_ = output.refusal;
  if (output.state == state_ && output.reason == reason_) return;
  const bool is_new_state = output.state != state_;
  std::string text = climb::name(output.state);
  if (is_new_state) text += std::string(" after ") + climb::name(state_);
  if (output.reason != climb::Fault::kNone) text += std::string(": ") + climb::name(output.reason);
  state_ = output.state;
  reason_ = output.reason;
  if (is_latched(output.state)) {
    has_stopped_ = has_stopped_ || is_new_state;
    journal_.warning(text);
  } else {
    journal_.info(text);
  }
}

void Chronicle::tell_answer(const CycleReport& report) {
  if (report.num_answers == num_answers_) return;
  num_answers_ = report.num_answers;
  const std::string order = std::string("order ") + word(report.order);
  switch (report.verdict) {
    case CommandVerdict::kNone:
      return;
    case CommandVerdict::kAccepted:
      return journal_.info(order + " accepted");
    case CommandVerdict::kWrongSession:
      return journal_.warning(order + " refused: it was meant for another run of the controller");
    case CommandVerdict::kReplayed:
      return journal_.warning(order + " refused: its number was used before");
    case CommandVerdict::kNotNow:
      break;
  }
  const std::string why = report.policy != Policy::kNone ? name(report.policy)
                          : report.output.reason != climb::Fault::kNone
                              ? climb::name(report.output.reason)
                              : std::string("not in ") + climb::name(report.output.state);
  journal_.warning(order + " refused: " + why + culprit(report));
}

void Chronicle::tell_bus(const CycleReport& report) {
  if (report.bus_faults.size < num_faults_) num_faults_ = 0;
  for (; num_faults_ < report.bus_faults.size; ++num_faults_) {
    const can::Fault& fault = report.bus_faults.items[num_faults_];
    journal_.warning(place(fault.axis) + ": " + can::name(fault.cause) + " " +
                     hexadecimal(fault.detail));
  }
  if (report.issues.size < num_issues_) num_issues_ = 0;
  for (; num_issues_ < report.issues.size; ++num_issues_) {
    journal_.warning(can::describe(report.issues.items[num_issues_]));
  }
}

void Chronicle::tell_lines(const LineLevels& lines) {
  if (lines.lost != lines_lost_) {
    if (lines.lost) {
      journal_.warning("touch switches and E-stop cannot be read");
    } else {
      journal_.info("touch switches and E-stop are read again");
    }
  }
  lines_lost_ = lines.lost;
  if (lines.lost || lines.estop_clear == estop_clear_) return;
  estop_clear_ = lines.estop_clear;
  if (estop_clear_) {
    journal_.info("E-stop released");
  } else {
    journal_.warning("E-stop pressed, or its wire is broken");
  }
}

}  // namespace climb_controller
