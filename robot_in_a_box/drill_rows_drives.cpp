// SPDX-License-Identifier: BSD-3-Clause
// The fault table as data, rows 11..19: servos and bus.
#include <array>
#include <cmath>

#include "robot_in_a_box/drill_expect.h"
#include "robot_in_a_box/drill_tables.h"

namespace robot_in_a_box {
namespace {

using climb::Fault;
using climb::flag;
using simulator::BusFrame;
using S = climb::ControllerState;

constexpr climb::FaultFlags kAnyServo =
    flag(Fault::kServoSilent) | flag(Fault::kServoState) | flag(Fault::kServoFault);
constexpr climb::FaultFlags kNoFollowing = kAnyServo | flag(Fault::kTracking);

std::uint32_t node(const CaseRun& run) {
  return static_cast<std::uint32_t>(run.some_axis()) + 1;
}
std::int64_t heard_since(const CaseRun& run, std::uint32_t id) {
  // What the plant says at once carries the time of its last step.
  return run.heard_us(id) >= run.injected_us() - ClimbBox::kStep_us ? run.heard_us(id) : -1;
}

// --- rows 11 to 14: one servo --------------------------------------------------------------------

void silence_servo(CaseRun& run) {
  run.box().plant().drive(run.some_axis()).faults.silent = true;
}
void stop_heartbeat(CaseRun& run) {
  run.box().plant().drive(run.some_axis()).faults.no_heartbeat = true;
}
void raise_fault(CaseRun& run) {
  constexpr std::array<std::uint16_t, 4> kCodes = {0x2310, 0x3210, 0x4210, 0x7305};
  run.box().plant().inject(run.some_axis(), kCodes[run.rng().below(4)]);
}
std::int64_t emergency_at(const CaseRun& run) {
  return heard_since(run, 0x080 + node(run));
}
void reboot(CaseRun& run) {
  run.box().plant().reboot(run.some_axis());
}
std::int64_t boot_up_at(const CaseRun& run) {
  const std::int64_t heard_us = run.heard_us(0x700 + node(run));
  return heard_us > run.injected_us() ? heard_us : -1;
}
void drop_to_pre_operational(CaseRun& run) {
  run.box().plant().drop_to_pre_operational(run.some_axis());
}
void cut_torque(CaseRun& run) {
  run.box().plant().drive(run.some_axis()).set_torque_permitted(false);
}
std::int64_t state_at(const CaseRun& run) {
  const std::int64_t heard_us = run.heard_us(0x180 + node(run));
  return heard_us > run.injected_us() ? heard_us : -1;
}

bool holds_for_silence(const CaseRun& run) {
  return holds_for(run, flag(Fault::kServoSilent));
}
bool holds_for_heartbeat(const CaseRun& run) {
  return holds_for(run, flag(Fault::kHeartbeatLost));
}
bool holds_for_servo_fault(const CaseRun& run) {
  return holds_for(run, flag(Fault::kServoFault) | flag(Fault::kServoState));
}
bool holds_for_servo(const CaseRun& run) {
  return holds_for(run, kAnyServo);
}

// --- row 15: a servo that does not follow --------------------------------------------------------

int moving_joint(const CaseRun& run) {
  const int joint = simulator::joint_of(run.some_axis());
  return simulator::axis_of(run.moving_leg(), joint == 3 ? 1 : joint);
}
bool where_limbs_move(const Situation& at) {
  return at.leg >= 0 && at.follows && (is_powered(at.state) || at.state == S::kArming);
}
void get_stuck(CaseRun& run) {
  run.box().plant().drive(moving_joint(run)).motor().stuck = true;
}
void turn_the_wrong_way(CaseRun& run) {
  run.box().plant().drive(moving_joint(run)).motor().reversed = true;
}
void jump(CaseRun& run) {
  run.box().plant().drive(moving_joint(run)).faults.encoder_offset_rad = 0.2;
}
std::int64_t is_behind_at(const CaseRun& run) {
  const int axis = moving_joint(run);
  const std::int64_t emergency_us = heard_since(run, 0x080 + static_cast<std::uint32_t>(axis) + 1);
  if (emergency_us >= 0) return emergency_us;
  const AxisWatch& told = run.axis(axis);
  const double error_counts = std::fabs(static_cast<double>(told.target) - told.measured);
  return told.told_us >= run.injected_us() && error_counts > 0.30 * 10'430.0 ? run.now_us() : -1;
}
std::int64_t jump_told_at(const CaseRun& run) {
  const auto id = 0x180 + static_cast<std::uint32_t>(moving_joint(run)) + 1;
  return run.heard_us(id) > run.injected_us() ? run.heard_us(id) : -1;
}
bool holds_for_following(const CaseRun& run) {
  return holds_for(run, kNoFollowing);
}
const char* harm_but_for_joint(const CaseRun& run) {
  return run.truth().fallen && !run.truth_before().fallen ? "the robot fell" : nullptr;
}

// --- row 16: frames that should not be -----------------------------------------------------------

void send_junk(CaseRun& run, int num_frames) {
  for (int i = 0; i < num_frames; ++i) {
    BusFrame frame;
    frame.bytes = {0xDE, 0xAD, 0xBE, 0xEF, 1, 2, 3, 4};
    frame.length = static_cast<std::uint8_t>(i * 3 % 8);
    constexpr std::array<std::uint32_t, 5> kIds = {
        simulator::kExtendedFlag | 0x181U, simulator::kRemoteFlag | 0x182U, 0x1F0U, 0x4C5U, 0x7F0U};
    frame.id = kIds[static_cast<std::size_t>(i) % kIds.size()];
    run.box().send_foreign(frame);
  }
}
void send_much_junk(CaseRun& run) {
  send_junk(run, 14);
}
void send_some_junk(CaseRun& run) {
  send_junk(run, 9);
}
bool holds_for_junk(const CaseRun& run) {
  return holds_for(run, flag(Fault::kMalformedFrames));
}
// --- rows 17 to 19: the bus ----------------------------------------------------------------------

void go_bus_off(CaseRun& run) {
  BusFrame frame;
  frame.id = simulator::kBusOffError;
  frame.length = 8;
  run.box().send_foreign(frame);
}
void go_error_passive(CaseRun& run) {
  BusFrame frame;
  frame.id = simulator::kErrorFlag | 0x4U;
  frame.length = 8;
  frame.bytes[1] = 0x30;
  run.box().send_foreign(frame);
}
bool is_silent(const CaseRun& run) {
  const bool faulted = run.report().bus_phase == can::BusPhase::kFaulted;
  return faulted && holds_for(run, flag(Fault::kBusDown) | flag(Fault::kTransmitStalled));
}
void stall(CaseRun& run) {
  run.box().bus().set_condition(simulator::BusCondition::kStalled, run.now_us());
}
void refuse_frames(CaseRun& run) {
  run.box().bus().queue_length = 0;
  stall(run);
}
/// The first cycle whose frames do not leave.
std::int64_t first_stalled_cycle_at(const CaseRun& run) {
  const std::int64_t next_us = (run.injected_us() + kT_us - 1) / kT_us * kT_us;
  return run.now_us() >= next_us ? next_us : -1;
}
void come_back(CaseRun& run) {
  if (run.since_us() != 300'000) return;
  run.box().bus().queue_length = 40;
  run.box().bus().set_condition(simulator::BusCondition::kUp, run.now_us());
}
void go_down(CaseRun& run) {
  run.box().bus().set_condition(simulator::BusCondition::kDown, run.now_us());
}
void come_back_and_rearm(CaseRun& run) {
  come_back(run);
  reset_and_arm(run, 600'000);
}
std::int64_t reset_at(const CaseRun& run) {
  return run.since_us() >= 600'000 ? run.injected_us() + 600'000 : -1;
}

constexpr std::array kDriveRows = {
    DrillRow{11, "", "servo silent", "hears and sends nothing", "all hold, FAULT_HOLD", after_boot,
             2, silence_servo, nullptr, holds_for_silence, harm_but_for_axis, arm_meanwhile,
             30'000 + kT_us, 600'000},
    DrillRow{12, "", "servo heartbeat lost", "its states go on", "FAULT_HOLD", after_boot, 2,
             stop_heartbeat, nullptr, holds_for_heartbeat, harm_after_stop, nullptr,
             250'000 + kT_us, 800'000},
    DrillRow{13, "", "servo fault", "EMCY and fault state", "others hold, FAULT_HOLD", after_boot,
             2, raise_fault, emergency_at, holds_for_servo_fault, harm_but_for_axis, arm_meanwhile,
             kT_us, 600'000},
    DrillRow{14, "a", "servo restarts", "boot-up frame", "FAULT_HOLD, not enabled again",
             after_boot, 2, reboot, boot_up_at, holds_for_servo, harm_but_for_axis, arm_meanwhile,
             kT_us, 600'000},
    DrillRow{14, "b", "servo leaves operational", "pre-operational", "FAULT_HOLD", after_boot, 2,
             drop_to_pre_operational, nullptr, holds_for_servo, harm_but_for_axis, arm_meanwhile,
             30'000 + kT_us, 600'000},
    DrillRow{14, "c", "servo leaves 0x27", "its torque is cut", "FAULT_HOLD", where_enabled, 2,
             cut_torque, state_at, holds_for_servo, harm_but_for_axis, nullptr, kT_us, 600'000},
    DrillRow{15, "a", "servo stuck", "a joint of the limb under way", "FAULT_HOLD",
             where_limbs_move, 1, get_stuck, is_behind_at, holds_for_following, harm_but_for_joint,
             nullptr, 2 * kT_us, 2'000'000},
    DrillRow{15, "b", "servo turns the wrong way", "a joint of the limb under way", "FAULT_HOLD",
             where_limbs_move, 1, turn_the_wrong_way, is_behind_at, holds_for_following,
             harm_but_for_joint, nullptr, 2 * kT_us, 2'000'000},
    DrillRow{15, "c", "position jumps", "by 0.2 rad, the limb under way", "FAULT_HOLD",
             where_limbs_move, 1, jump, jump_told_at, holds_for_following, harm_but_for_joint,
             nullptr, 2 * kT_us, 1'000'000},
    DrillRow{16, "a", "bad frames", "14 at once", "FAULT_HOLD", after_boot, 1, send_much_junk,
             nullptr, holds_for_junk, harm_after_stop, nullptr, kT_us, 500'000},
    DrillRow{16, "b", "bad frames", "9 at once", "ignored", everywhere, 1, send_some_junk, nullptr,
             takes_no_notice, harm_by_notice, nullptr, 300'000, 400'000},
    DrillRow{17, "a", "bus off", "error frame", "silent, FAULT_HOLD", after_boot, 1, go_bus_off,
             nullptr, is_silent, harm_when_silent, nullptr, kT_us, 600'000},
    DrillRow{17, "b", "error passive", "error frame", "silent, FAULT_HOLD", after_boot, 1,
             go_error_passive, nullptr, is_silent, harm_when_silent, nullptr, kT_us, 600'000},
    DrillRow{18, "a", "transmit queue stalls", "nothing leaves, then all could",
             "silent, FAULT_HOLD, nothing stale", after_boot, 1, stall, first_stalled_cycle_at,
             is_silent, harm_when_silent, come_back, 2 * kT_us, 700'000},
    DrillRow{18, "b", "no buffers", "no frame is taken, then all could",
             "silent, FAULT_HOLD, nothing stale", after_boot, 1, refuse_frames,
             first_stalled_cycle_at, is_silent, harm_when_silent, come_back, 2 * kT_us, 700'000},
    DrillRow{19, "a", "interface down", "for 0.3 s", "silent, FAULT_HOLD", after_boot, 1, go_down,
             nullptr, is_silent, harm_when_silent, come_back, kT_us, 1'500'000},
    DrillRow{19, "b", "interface back", "down for 0.3 s, reset and armed",
             "enabled where it stands", where_powered, 1, go_down, reset_at, follows_again,
             harm_to_grasps, come_back_and_rearm, 6'000'000, 7'000'000},
};

}  // namespace

std::span<const DrillRow> rows_of_drives() {
  return kDriveRows;
}

}  // namespace robot_in_a_box
