// SPDX-License-Identifier: BSD-3-Clause
// Faults by name, time and place, from a text or from a seed, and the player that brings them upon
// plant and bus. One line per fault: TIME_S KIND [TARGET [VALUE [DURATION_S]]], '#' begins a
// comment.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "simulator/plant/memory_bus.h"
#include "simulator/plant/robot_plant.h"

namespace simulator {

enum class FaultKind : std::uint8_t {
  // An axis 0..15
  kSilent,  ///< hears and sends nothing
  kNoHeartbeat,
  kNoState,      ///< TPDO1 missing
  kWrongLength,  ///< TPDO1 one byte short
  kSlow,         ///< value: share of the speed
  kStuck,
  kWrongSign,
  kEmergency,  ///< value: code
  kReboot,
  kPreOperational,  ///< falls out of operational
  kUnderVoltage,    ///< a warning, EMCY 3120h
  kFrameLoss,       ///< value: share
  kFrameDuplicate,  ///< value: share
  kFrameDelay,      ///< value: ms
  // A leg 0..3
  kTouchStuckLow,
  kTouchStuckHigh,
  kNoForce,  ///< NaN in the force, needs force nodes
  // A rung, by index
  kRungBreaks,
  kRungWeak,  ///< value: N
  kRungBreaksOnTouch,
  // Everything
  kEstop,
  kEstopWire,
  kBusDown,
  kBusStalled,
  kBusOff,       ///< the error frame alone
  kForeignSync,  ///< a second master: one SYNC
  kJunkFrames,   ///< value: how many frames of wrong kind and length
  kUndock,
};
inline constexpr int kNumFaultKinds = static_cast<int>(FaultKind::kUndock) + 1;

const char* name(FaultKind kind);
/// How many targets this kind has: 16 axes, 4 legs, the rungs (0 = as many as there are), or 1.
int num_targets(FaultKind kind);

struct Fault {
  std::int64_t time_us = 0;
  FaultKind kind{};
  int target = 0;
  double value = 0.0;
  std::int64_t duration_us = 0;  ///< 0 = until the end; ignored by what happens once
};

struct ParsedFaults {
  std::vector<Fault> faults;  ///< in order of time
  std::string problem;        ///< "" or line number and what is wrong
};
ParsedFaults parse_faults(std::string_view text);
std::string to_text(const Fault& fault);

struct RandomFaultParams {
  int num_faults = 3;
  std::int64_t from_us = 0;
  std::int64_t until_us = 5'000'000;
  int num_rungs = 16;
  bool has_force_nodes = false;
};
/// In order of time; never undocks.
std::vector<Fault> random_faults(std::uint64_t seed, const RandomFaultParams& params);

/// Attaches a port of its own to the bus for foreign frames.
class FaultPlayer {
 public:
  FaultPlayer(std::vector<Fault> faults, MemoryBus& bus);

  /// Begins and ends what is due by now. To be called before the plant advances to now.
  void apply(std::int64_t now_us, RobotPlant& plant, MemoryBus& bus);
  /// One more, in its place by time; one that is past begins at the next apply().
  void add(const Fault& fault);
  int num_begun() const { return static_cast<int>(next_); }

 private:
  void set(const Fault& fault, bool on, RobotPlant& plant);
  void happen(const Fault& fault, std::int64_t now_us, RobotPlant& plant, MemoryBus& bus);

  std::vector<Fault> faults_;
  std::size_t next_ = 0;
  std::vector<Fault> running_;
  int port_;
};

}  // namespace simulator
