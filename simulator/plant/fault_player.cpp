// SPDX-License-Identifier: BSD-3-Clause
// What each kind of fault does: states that are switched on and off, and events that happen once.
#include <cmath>

#include "simulator/plant/fault_script.h"

namespace simulator {
namespace {

using enum FaultKind;

constexpr std::uint16_t kUnderVoltageCode = 0x3120;

/// Extended, remote, too long for its kind, unknown, empty: all on a bus that others use.
BusFrame junk_frame(int number) {
  BusFrame frame;
  frame.bytes = {0xDE, 0xAD, 0xBE, 0xEF, 0x01, 0x02, 0x03, 0x04};
  switch (number % 5) {
    case 0:
      frame.id = kExtendedFlag | 0x181;
      break;
    case 1:
      frame.id = kRemoteFlag | 0x182;
      break;
    case 2:
      frame.id = 0x183;
      break;
    case 3:
      frame.id = 0x4C5;
      break;
    default:
      frame.id = 0x7F0;
  }
  frame.length = static_cast<std::uint8_t>(number * 3 % 8);
  return frame;
}

}  // namespace

void FaultPlayer::set(const Fault& fault, bool on, RobotPlant& plant) {
  const int target = fault.target;
  switch (fault.kind) {
    case kSilent:
      plant.drive(target).faults.silent = on;
      return;
    case kNoHeartbeat:
      plant.drive(target).faults.no_heartbeat = on;
      return;
    case kNoState:
      plant.drive(target).faults.no_state = on;
      return;
    case kWrongLength:
      plant.drive(target).faults.wrong_length = on;
      return;
    case kSlow:
      plant.drive(target).motor().speed_share = on ? fault.value : 1.0;
      return;
    case kStuck:
      plant.drive(target).motor().stuck = on;
      return;
    case kWrongSign:
      plant.drive(target).motor().reversed = on;
      return;
    case kTouchStuckLow:
    case kTouchStuckHigh: {
      const WireFault stuck =
          fault.kind == kTouchStuckLow ? WireFault::kStuckLow : WireFault::kStuckHigh;
      return plant.set_wire_fault(static_cast<Line>(target), on ? stuck : WireFault::kNone);
    }
    case kEstopWire:
      return plant.set_wire_fault(kEstopN, on ? WireFault::kStuckLow : WireFault::kNone);
    case kEstop:
      return plant.press_estop(on);
    case kNoForce:
      if (plant.has_force_nodes()) plant.force_node(target).broken_sensor = on;
      return;
    default:
      return;
  }
}

void FaultPlayer::happen(const Fault& fault, std::int64_t now_us, RobotPlant& plant,
                         MemoryBus& bus) {
  const bool has_rung = fault.target < plant.world().num_rungs();
  switch (fault.kind) {
    case kEmergency:
      return plant.inject(fault.target, static_cast<std::uint16_t>(fault.value));
    case kReboot:
      return plant.reboot(fault.target);
    case kPreOperational:
      return plant.drop_to_pre_operational(fault.target);
    case kUnderVoltage:
      return plant.warn(fault.target, kUnderVoltageCode);
    case kRungBreaks:
      if (has_rung) plant.world().rung(fault.target).break_at_us = now_us;
      return;
    case kRungWeak:
      if (has_rung) plant.world().rung(fault.target).break_load_N = fault.value;
      return;
    case kRungBreaksOnTouch:
      if (has_rung) plant.world().rung(fault.target).break_on_touch = true;
      return;
    case kBusDown:
      return bus.set_condition(BusCondition::kDown, now_us);
    case kBusStalled:
      return bus.set_condition(BusCondition::kStalled, now_us);
    case kBusOff: {
      BusFrame frame;
      frame.id = kBusOffError;
      frame.length = 8;
      bus.send(port_, frame, now_us);
      return;
    }
    case kForeignSync: {
      BusFrame frame;
      frame.id = 0x080;
      bus.send(port_, frame, now_us);
      return;
    }
    case kJunkFrames:
      for (int i = 0; i < static_cast<int>(std::fmin(fault.value, 1000.0)); ++i) {
        bus.send(port_, junk_frame(i), now_us);
      }
      return;
    case kUndock:
      return plant.set_docked(false);
    default:
      return;
  }
}

}  // namespace simulator
