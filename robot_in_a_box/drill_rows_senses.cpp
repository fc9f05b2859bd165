// SPDX-License-Identifier: BSD-3-Clause
// The fault table as data, what the robot feels: IMU (row 27), warnings of drives (30).
#include <array>

#include "robot_in_a_box/drill_expect.h"
#include "robot_in_a_box/drill_tables.h"

namespace robot_in_a_box {
namespace {

using climb::Fault;
using climb::flag;
using S = climb::ControllerState;

// --- row 27: IMU ---------------------------------------------------------------------------------

bool is_armed(const Situation& at) {
  return is_powered(at.state) || (at.state == S::kArming && at.follows);
}
void tilt(CaseRun& run) {
  run.box().imu_turn = Eigen::AngleAxisd(0.35, Eigen::Vector3d::UnitY());
}
void fall(CaseRun& run) {
  run.box().imu_falls = true;
}
void silence_imu(CaseRun& run) {
  run.box().imu_silent = true;
}
bool holds_for_tilt(const CaseRun& run) {
  return holds_for(run, flag(Fault::kTilt));
}
bool holds_for_fall(const CaseRun& run) {
  return holds_for(run, flag(Fault::kFreeFall));
}
bool all_claws_close(const CaseRun& run) {
  if (!holds_for_fall(run)) return false;
  for (int leg = 0; leg < simulator::kNumLegs; ++leg) {
    if (run.axis(simulator::axis_of(leg, 3)).target > -0.55 * 10'430.0) return false;
  }
  return true;
}
bool holds_for_imu(const CaseRun& run) {
  return holds_for(run, flag(Fault::kImuSilent));
}

// --- row 30: warnings ----------------------------------------------------------------------------

bool in_rest(const Situation& at) {
  return at.state == S::kHold || is_unpowered(at.state);
}
bool stays_at_rest(const CaseRun& run) {
  return run.since_us() >= 500'000 && is_unchanged(run);
}
void warn_of_voltage(CaseRun& run) {
  run.box().plant().warn(run.some_axis(), 0x3120);
}
void warn_of_heat(CaseRun& run) {
  run.box().plant().warn(run.some_axis(), 0x4310);
}

constexpr std::array kSenseRows = {
    DrillRow{27, "a", "tilt", "20 deg", "FAULT_HOLD", is_armed, 1, tilt, nullptr, holds_for_tilt,
             harm_after_stop, nullptr, 50'000 + kT_us, 500'000},
    DrillRow{27, "b", "free fall", "0 g", "FAULT_HOLD", everywhere, 1, fall, nullptr,
             holds_for_fall, harm_after_stop, arm_meanwhile, 50'000 + kT_us, 700'000},
    DrillRow{27, "c", "free fall", "0 g", "all claws close", is_armed, 1, fall, nullptr,
             all_claws_close, harm_after_stop, nullptr, 50'000 + kT_us + 400'000, 1'000'000},
    DrillRow{27, "d", "IMU silent", "no more readings", "FAULT_HOLD", after_boot, 1, silence_imu,
             nullptr, holds_for_imu, harm_after_stop, arm_meanwhile, 100'000 + kT_us, 600'000},
    DrillRow{30, "a", "under-voltage warning", "EMCY 3120h", "finishes the step, HOLD", in_climbing,
             1, warn_of_voltage, nullptr, rests, harm_by_next_step, nullptr, 20'000'000,
             20'500'000},
    DrillRow{30, "b", "temperature warning", "EMCY 4310h", "finishes the step, HOLD", in_climbing,
             1, warn_of_heat, nullptr, rests, harm_by_next_step, nullptr, 20'000'000, 20'500'000},
    DrillRow{30, "c", "under-voltage warning", "EMCY 3120h", "not armed, torque stays", in_rest, 1,
             warn_of_voltage, nullptr, stays_at_rest, harm_after_stop, arm_meanwhile, 500'000,
             900'000},
};

}  // namespace

std::span<const DrillRow> rows_of_senses() {
  return kSenseRows;
}

}  // namespace robot_in_a_box
