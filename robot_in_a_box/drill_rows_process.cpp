// SPDX-License-Identifier: BSD-3-Clause
// The fault table as data, rows 20 to 26 and 32: the controller's process, the E-stop, clocks,
// rivals, the disk.
#include <array>
#include <cmath>
#include <csignal>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "robot_in_a_box/drill_expect.h"
#include "robot_in_a_box/drill_tables.h"

namespace robot_in_a_box {
namespace {

using climb::Fault;
using climb::flag;
using simulator::BusFrame;
using simulator::kNumAxes;
using simulator::PowerState;
using S = climb::ControllerState;

constexpr std::int64_t kHang_us = 1'000'000;
constexpr std::int64_t kHour_us = 3'600'000'000;

bool in_estop(const Situation& at) {
  return at.state == S::kEstop;
}

// --- rows 20 to 22: the process ------------------------------------------------------------------

void kill_controller(CaseRun& run) {
  run.box().kill();
}
void hang_controller(CaseRun& run) {
  run.box().hang(kHang_us);
}
/// Drives that followed targets no longer do, and keep their torque.
bool drives_stop(const CaseRun& run) {
  for (const PowerState power : run.truth().power) {
    if (power == PowerState::kOperationEnabled) return false;
  }
  return true;
}
bool has_enabled_drives(const CaseRun& run) {
  for (const PowerState power : run.truth_before().power) {
    if (power == PowerState::kOperationEnabled) return true;
  }
  return false;
}
std::int64_t left_alone_at(const CaseRun& run) {
  return has_enabled_drives(run) ? run.injected_us() : -1;
}
const char* harm_without_master(const CaseRun& run) {
  const bool should_stand = run.since_us() > 300'000 && run.since_us() < kHang_us;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const auto index = static_cast<std::size_t>(axis);
    const bool moves = std::fabs(run.truth().joint_rad_s[index]) > 0.02;
    if (should_stand && moves && !simulator::is_jaw(axis)) return "a joint moves after 300 ms";
    const bool had = has_torque(run.truth_before().power[index]);
    if (had && !has_torque(run.truth().power[index])) return "an axis lost its torque";
    const bool again = run.axis(axis).enabled_us > run.injected_us() + kHang_us;
    if (again) return "enabled again after it hung";
  }
  return harm_to_grasps(run);
}
void hang_a_little(CaseRun& run) {
  run.box().hang(15'000);
}
void hang_for_a_while(CaseRun& run) {
  run.box().hang(300'000);
}
void reset_and_arm_after_hanging(CaseRun& run) {
  reset_and_arm(run, 1'200'000);
}
void hang_for_four_cycles(CaseRun& run) {
  run.box().hang(50'000);
}
std::int64_t woken_at(const CaseRun& run, std::int64_t after_us) {
  return run.since_us() >= after_us ? run.injected_us() + after_us : -1;
}
std::int64_t reset_after_hanging_at(const CaseRun& run) {
  return woken_at(run, 1'200'000);
}
std::int64_t woken_after_second_at(const CaseRun& run) {
  return woken_at(run, kHang_us);
}
std::int64_t woken_after_cycles_at(const CaseRun& run) {
  return woken_at(run, 50'000);
}
bool holds_for_overrun(const CaseRun& run) {
  // After a second the drives have told their own losses, which stand higher in the table.
  return holds_for(run, flag(Fault::kOverrun) | flag(Fault::kServoState) |
                            flag(Fault::kServoFault) | flag(Fault::kServoSilent));
}
void terminate(CaseRun& run) {
  run.box().terminate();
}
/// The limb in the air has finished, then the drives were handed over and the process is gone.
bool ends_at_rest(const CaseRun& run) {
  return run.box().has_ended() && rests(run);
}
bool ends(const CaseRun& run) {
  return run.box().has_ended();
}
bool ends_at_once(const Situation& at) {
  return !climb_controller::finishes_first(at.state);
}
/// From the order to drives that stand and hold by themselves.
constexpr std::int64_t kHandingOver_us = climb_controller::kHandOverCycles * kT_us;
// --- rows 23 and 24: E-stop ----------------------------------------------------------------------

void press(CaseRun& run) {
  run.box().plant().press_estop(true);
}
void break_wire(CaseRun& run) {
  run.box().plant().set_wire_fault(simulator::kEstopN, simulator::WireFault::kStuckLow);
}
void lose_lines(CaseRun& run) {
  run.box().chip().lost = true;
}
bool stops_at_once(const CaseRun& run) {
  if (run.state() != S::kEstop) return false;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const AxisWatch& told = run.axis(axis);
    const bool followed = told.enabled_us >= run.injected_us() - kT_us;
    if (followed && told.quick_stop_us < run.injected_us()) {
      // The frames of this cycle are on the bus already, but are seen a moment later.
      const bool is_on_its_way = run.report().bus_phase == can::BusPhase::kStopped;
      if (!is_on_its_way) return false;
    }
  }
  return true;
}
const char* harm_in_estop(const CaseRun& run) {
  const std::int64_t since_us = run.reacted_us() >= 0 ? run.reacted_us() : INT64_MAX;
  for (int axis = 0; axis < kNumAxes; ++axis) {
    if (run.axis(axis).enabled_us > since_us) return "enabled during the E-stop";
    const auto index = static_cast<std::size_t>(axis);
    const bool had = has_torque(run.truth_before().power[index]);
    const bool lost = had && !has_torque(run.truth().power[index]);
    if (lost && run.before().state != S::kDisarming) return "an axis lost its torque";
  }
  return harm_to_grasps(run);
}
void release(CaseRun& run) {
  run.box().plant().press_estop(false);
}
bool stays_in_estop(const CaseRun& run) {
  return run.since_us() >= 800'000 && run.state() == S::kEstop;
}
const char* harm_by_starting(const CaseRun& run) {
  if (run.state() != S::kEstop) return "left ESTOP without the operator";
  for (int axis = 0; axis < kNumAxes; ++axis) {
    if (run.axis(axis).enabled_us > run.injected_us()) return "enabled without the operator";
  }
  return harm_to_grasps(run);
}
void reset_and_arm_soon(CaseRun& run) {
  reset_and_arm(run, 400'000);
}
std::int64_t reset_at(const CaseRun& run) {
  return run.since_us() >= 400'000 ? run.injected_us() + 400'000 : -1;
}

// --- rows 25 and 26: clocks and rivals -----------------------------------------------------------

void sleep_machine(CaseRun& run) {
  run.box().sleep(1'000'000);
}
void step_ahead(CaseRun& run) {
  run.box().perception().wall_step_us += kHour_us;
}
void step_back(CaseRun& run) {
  run.box().perception().wall_step_us -= kHour_us;
}
/// Silent before: then there is nothing to take.
bool takes_messages_again(const CaseRun& run) {
  return run.messages_since() > 100'000 || run.box().perception().silent;
}
bool holds_for_sleep(const CaseRun& run) {
  return holds_for(run, flag(Fault::kSuspended));
}
void send_id(CaseRun& run, std::uint32_t id, std::uint8_t length) {
  BusFrame frame;
  frame.id = id;
  frame.length = length;
  run.box().send_foreign(frame);
}
void rival_sync(CaseRun& run) {
  send_id(run, 0x080, 0);
}
void rival_sdo(CaseRun& run) {
  BusFrame frame;
  frame.id = 0x601;
  frame.length = 8;
  frame.bytes = {0x40, 0x41, 0x60, 0, 0, 0, 0, 0};
  run.box().send_foreign(frame);
}
void rival_feed_forward(CaseRun& run) {
  send_id(run, 0x37E, 8);
}
void rival_nmt(CaseRun& run) {
  BusFrame frame;
  frame.id = 0x000;
  frame.length = 2;
  frame.bytes = {0x01, 0x50, 0, 0, 0, 0, 0, 0};  // a node that is not there
  run.box().send_foreign(frame);
}
bool gives_way(const CaseRun& run) {
  const bool faulted = run.report().bus_phase == can::BusPhase::kFaulted;
  return faulted && holds_for(run, flag(Fault::kSecondController));
}
const char* harm_when_rivals(const CaseRun& run) {
  return harm_when_silent(run);
}
bool in_boot(const Situation& at) {
  return at.state == S::kBoot;
}
void keep_sync_up(CaseRun& run) {
  if (run.now_us() % kT_us == 0) send_id(run, 0x080, 0);
}
bool has_not_spoken(const CaseRun& run) {
  return run.since_us() >= 1'000'000;
}
const char* harm_by_speaking(const CaseRun& run) {
  return run.last_master_frame_us() >= 0 ? "spoke on a bus that has a master" : nullptr;
}

// --- row 32: the disk ----------------------------------------------------------------------------

/// Of this copy of the process: whatever it writes fails.
void fill_disk(CaseRun&) {
  const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
  if (full >= 0) {
    dup2(full, STDOUT_FILENO);
    dup2(full, STDERR_FILENO);
    close(full);
  }
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_FSIZE, &none);
}

constexpr std::array kProcessRows = {
    DrillRow{20, "", "controller gone", "kill -9", "drives quick-stop and hold", where_enabled, 1,
             kill_controller, left_alone_at, drives_stop, harm_without_master, nullptr,
             150'000 + kT_us, 800'000},
    DrillRow{21, "a", "controller hangs", "for 1 s", "drives quick-stop and hold", where_enabled, 1,
             hang_controller, left_alone_at, drives_stop, harm_without_master, nullptr,
             150'000 + kT_us, 2'000'000},
    DrillRow{21, "b", "controller hung", "for 1 s", "FAULT_HOLD, not enabled again", where_enabled,
             1, hang_controller, woken_after_second_at, holds_for_overrun, harm_without_master,
             nullptr, 2 * kT_us, 2'000'000},
    DrillRow{21, "c", "loop overrun", "50 ms", "FAULT_HOLD", where_enabled, 1, hang_for_four_cycles,
             woken_after_cycles_at, holds_for_overrun, harm_after_stop, nullptr, 2 * kT_us,
             600'000},
    DrillRow{21, "d", "loop overrun", "once, 15 ms", "counted only", everywhere, 1, hang_a_little,
             nullptr, takes_no_notice, harm_by_notice, nullptr, 300'000, 400'000},
    DrillRow{21, "e", "controller back", "hung for 0.3 s, reset and armed",
             "enabled where it stands", where_powered, 1, hang_for_a_while, reset_after_hanging_at,
             follows_again, harm_to_grasps, reset_and_arm_after_hanging, 6'000'000, 8'000'000},
    DrillRow{22, "a", "SIGTERM", "while it climbs", "finishes the step, HOLD, hands over",
             in_climbing, 1, terminate, nullptr, ends_at_rest, harm_by_next_step, nullptr,
             20'000'000 + kHandingOver_us, 20'800'000},
    DrillRow{22, "b", "SIGTERM", "elsewhere", "hands over, torque stays", ends_at_once, 1,
             terminate, nullptr, ends, harm_after_stop, arm_meanwhile, kHandingOver_us + 2 * kT_us,
             900'000},
    DrillRow{23, "a", "E-stop", "pressed", "quick stop, ESTOP", everywhere, 1, press, nullptr,
             stops_at_once, harm_in_estop, nullptr, 20'000, 500'000},
    DrillRow{23, "b", "E-stop", "wire broken", "quick stop, ESTOP", everywhere, 1, break_wire,
             nullptr, stops_at_once, harm_in_estop, nullptr, 20'000, 500'000},
    DrillRow{23, "c", "E-stop", "lines lost", "quick stop, ESTOP", everywhere, 1, lose_lines,
             nullptr, stops_at_once, harm_in_estop, nullptr, 20'000, 500'000},
    DrillRow{24, "a", "E-stop released", "nothing else", "nothing moves", in_estop, 1, release,
             nullptr, stays_in_estop, harm_by_starting, nullptr, 800'000, 1'000'000},
    DrillRow{24, "b", "E-stop released", "reset and armed", "enabled where it stands", in_estop, 1,
             release, reset_at, follows_again, harm_to_grasps, reset_and_arm_soon, 6'000'000,
             7'000'000},
    DrillRow{25, "a", "machine slept", "BOOTTIME runs ahead", "FAULT_HOLD", everywhere, 1,
             sleep_machine, nullptr, holds_for_sleep, harm_after_stop, nullptr, kT_us, 500'000},
    DrillRow{25, "b", "wall clock steps", "an hour ahead", "goes on; row 1 at most", everywhere, 1,
             step_ahead, nullptr, takes_messages_again, harm_by_notice, nullptr, 300'000, 400'000},
    DrillRow{25, "c", "wall clock steps", "an hour back", "goes on; row 1 at most", everywhere, 1,
             step_back, nullptr, takes_messages_again, harm_by_notice, nullptr, 300'000, 400'000},
    DrillRow{26, "a", "second controller", "its SYNC", "silent, FAULT_HOLD", after_boot, 1,
             rival_sync, nullptr, gives_way, harm_when_rivals, nullptr, kT_us, 600'000},
    DrillRow{26, "b", "second controller", "its SDO", "silent, FAULT_HOLD", after_boot, 1,
             rival_sdo, nullptr, gives_way, harm_when_rivals, nullptr, kT_us, 600'000},
    DrillRow{26, "c", "second controller", "its RPDO", "silent, FAULT_HOLD", after_boot, 1,
             rival_feed_forward, nullptr, gives_way, harm_when_rivals, nullptr, kT_us, 600'000},
    DrillRow{26, "d", "second controller", "its NMT", "silent, FAULT_HOLD", after_boot, 1,
             rival_nmt, nullptr, gives_way, harm_when_rivals, nullptr, kT_us, 600'000},
    DrillRow{26, "e", "second controller", "is there at the start", "says nothing", in_boot, 1,
             rival_sync, nullptr, has_not_spoken, harm_by_speaking, keep_sync_up, 1'000'000,
             1'500'000},
    DrillRow{32, "", "disk full", "every write of the process fails", "goes on", everywhere, 1,
             fill_disk, nullptr, takes_no_notice, harm_by_notice, nullptr, 300'000, 400'000},
};

}  // namespace

std::span<const DrillRow> rows_of_process() {
  return kProcessRows;
}

}  // namespace robot_in_a_box
