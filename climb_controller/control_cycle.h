// SPDX-License-Identifier: BSD-3-Clause
// One control cycle: what the drives say -> climb::Controller -> what the drives are told, and the
// walk of the servo bus that the controller's requests and the operator's reset demand.
// No message, clock, thread or allocation inside: the live service, the drill and the tests in
// virtual time run this class and no other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "can/servo_bus.h"
#include "climb/controller.h"
#include "climb_controller/bus_walk.h"

namespace climb_controller {

/// What holds the robot when its drives have no torque.
enum class PowerOffHold : std::uint8_t {
  kNone,  ///< nothing, as long as nobody states otherwise: it never leaves the ground
  kBrake,
  kSelfLocking,  ///< the claws keep closed by themselves
};

struct CycleParams {
  climb::ControllerParams controller;
  PowerOffHold power_off_hold = PowerOffHold::kNone;
  /// Ground tests: drives that do not stop and hold by themselves when the controller is gone, or
  /// that cannot limit and measure torque, are accepted; it arms where it stands and never climbs.
  bool allow_no_hold_on_loss = false;
  BusWalkParams walk;
};

/// "" or the violated relation, naming the field.
std::string check(const CycleParams& params);

/// Levels, not edges.
struct LineLevels {
  climb::PerLeg<bool> touch{};
  bool estop_clear = false;  ///< the line says "run"
  bool lost = false;         ///< the lines cannot be read
};

/// Everything a cycle needs beside the bus. As constructed nothing is seen and nothing is wanted.
struct CycleInbox {
  LineLevels lines;
  climb::ImuReading imu;
  climb::LadderView ladder;                          ///< valid during step(); age_s is set inside
  std::int64_t ladder_received_us = -1'000'000'000;  ///< the newest accepted message
  climb::OperatorCommand command;                    ///< kNone = nothing new
  climb::FaultFlags faults = 0;  ///< found outside: overrun, suspended, terminate
};

/// Why an order that the states would allow is refused all the same.
enum class Policy : std::uint8_t {
  kNone,
  kNoHoldOnLoss,   ///< a drive would not hold by itself: see issues
  kNoTorqueLimit,  ///< a drive neither limits nor measures torque
  kGroundTest,     ///< climbing with allow_no_hold_on_loss
  kNoPowerOffHold  ///< climbing with PowerOffHold::kNone
};

const char* name(Policy policy);

/// A list of bounded length that does not allocate; what exceeds it is left out.
template <class T, std::size_t kCapacity>
struct Listed {
  std::array<T, kCapacity> items{};
  std::size_t size = 0;

  void assign(std::span<const T> from) {
    size = from.size() < kCapacity ? from.size() : kCapacity;
    for (std::size_t i = 0; i < size; ++i) items[i] = from[i];
  }
  const T* begin() const { return items.data(); }
  const T* end() const { return items.data() + size; }
};

struct CycleReport {
  std::int64_t now_us = 0;
  climb::ControllerOutput output;
  climb::FaultFlags faults = 0;  ///< of bus, lines, service and policy; the controller adds its own
  can::BusPhase bus_phase = can::BusPhase::kIdle;
  climb::PerAxis<can::AxisFeedback> axes{};
  LineLevels lines;
  Listed<can::Fault, 32> bus_faults;
  Listed<can::ObjectIssue, 64> issues;
  Policy policy = Policy::kNone;
  /// The last order that was answered.
  climb::Order order = climb::Order::kNone;
  std::int64_t order_seq = -1;
  climb::CommandVerdict verdict = climb::CommandVerdict::kNone;
  std::uint64_t num_answers = 0;
  bool is_resetting = false;  ///< a reset waits for the bus
};

/// Asked to end in this state, it first finishes the step in the air.
bool finishes_first(climb::ControllerState state);

/// From hand_over() until all drives stand and hold by themselves.
inline constexpr int kHandOverCycles = 20;

class ControlCycle {
 public:
  /// `params` pass check(); the bus has sixteen axes and outlives this.
  ControlCycle(const CycleParams& params, can::ServoBus& bus);

  /// Between cycles, as often as wanted.
  void poll(std::int64_t now_us) noexcept { bus_.poll(now_us); }

  /// Once per period.
  void step(std::int64_t now_us, const CycleInbox& inbox, CycleReport& report) noexcept;

  /// At the very end: drives that follow targets stop and hold by themselves. Nothing is decided
  /// afterwards; step() only keeps the bus going until the process ends.
  void hand_over() noexcept;

  const climb::Controller& controller() const { return controller_; }
  std::uint64_t session_id() const { return params_.controller.session_id; }

 private:
  void control(const CycleInbox& inbox);
  void read(const CycleInbox& inbox);
  climb::OperatorCommand order_of(const CycleInbox& inbox);
  climb::CommandVerdict judge(const climb::OperatorCommand& command);
  bool may_reset_bus(const LineLevels& lines) const;
  void answer(const climb::OperatorCommand& command, climb::CommandVerdict verdict);
  Policy policy_of_drives() const;
  Policy policy_against(climb::Order order) const;
  void send();
  void fill(CycleReport& report) const;

  CycleParams params_;
  can::ServoBus& bus_;
  BusWalk walk_;
  climb::Controller controller_;
  climb::ControllerInput input_;
  climb::ControllerOutput output_;
  climb::PerAxis<can::AxisFeedback> feedback_{};
  climb::PerAxis<can::AxisTarget> targets_{};
  climb::PerAxis<int> silent_cycles_{};
  std::int64_t now_us_ = 0;
  bool has_handed_over_ = false;

  std::int64_t last_seq_ = -1;
  climb::OperatorCommand waiting_;   ///< a reset that waits for the bus; kNone: none
  climb::OperatorCommand answered_;  ///< the last one
  climb::CommandVerdict verdict_ = climb::CommandVerdict::kNone;
  std::uint64_t num_answers_ = 0;
  Policy policy_ = Policy::kNone;  ///< why it was refused
};

}  // namespace climb_controller
