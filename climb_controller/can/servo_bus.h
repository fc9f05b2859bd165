// SPDX-License-Identifier: BSD-3-Clause
// Servos behind one interface, whatever they speak: configure -> enable -> exchange every cycle ->
// stop or disable. A state machine driven by the time handed in: no threads, no sleeps, no clock.
// What a drive cannot do is told by Capabilities; whether that suffices to climb is the
// controller's policy, not this room's.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "can/fault.h"

namespace can {

/// True only if all axes of the bus can.
struct Capabilities {
  bool hold_on_loss = false;       ///< the drive stops and holds by itself when the master is gone
  bool torque_limit = false;       ///< torque can be limited per cycle and is measured
  bool sync = false;               ///< all axes latch targets and states at one instant
  bool absolute_position = false;  ///< position survives loss of power
};

enum class BusPhase : std::uint8_t {
  kIdle,         ///< heard, not configured; only listens
  kListening,    ///< 300 ms: is another master here?
  kConfiguring,  ///< objects are written and read back
  kReady,        ///< configured, states flow, no target is followed
  kRearming,     ///< drive faults are reset by edge
  kEnabling,
  kEnabled,  ///< targets are followed
  kStopped,  ///< after stop(): drives hold or are without torque, targets are ignored
  kDisabling,
  kFaulted,  ///< a bus fault is latched: nothing is sent
};

const char* name(BusPhase phase);

enum class StopKind : std::uint8_t {
  kHold,       ///< keep the last targets, torque on
  kQuickStop,  ///< each drive ramps down by itself and holds where its capability allows
  kTorqueOff,  ///< at once without torque: only with brakes set or on the ground
};

/// For one cycle and one axis. As constructed it is refused: no target is ever meant by accident.
struct AxisTarget {
  double position_rad = std::numeric_limits<double>::quiet_NaN();
  double velocity_rad_s = 0.0;  ///< feed-forward, where the bus sends it
  double torque_Nm = 0.0;       ///< feed-forward, where the bus sends it
  double max_torque_Nm = std::numeric_limits<double>::infinity();  ///< the axis' own limit if above
};

struct Targets {
  std::int64_t time_us = 0;  ///< when they were computed; older than two cycles = refused
  std::span<const AxisTarget> axes;
};

enum class DriveState : std::uint8_t {
  kUnknown,  ///< nothing heard
  kNotReadyToSwitchOn,
  kSwitchOnDisabled,
  kReadyToSwitchOn,
  kSwitchedOn,
  kOperationEnabled,
  kQuickStopActive,
  kFaultReactionActive,
  kFault,
};
inline constexpr int kNumDriveStates = static_cast<int>(DriveState::kFault) + 1;

const char* name(DriveState state);

/// The last known state of one axis; NaN = never heard.
struct AxisFeedback {
  DriveState state = DriveState::kUnknown;
  bool fresh = false;     ///< heard since the cycle before
  int missed_cycles = 0;  ///< cycles in a row without its state frame
  double position_rad = std::numeric_limits<double>::quiet_NaN();
  double torque_Nm = std::numeric_limits<double>::quiet_NaN();
  std::uint16_t status_word = 0;     ///< as received (6041h); 0 where the protocol has none
  std::uint16_t error_code = 0;      ///< last reported (603Fh or EMCY), 0 = none
  std::uint32_t digital_inputs = 0;  ///< 60FDh
};

/// One object that could not be configured.
struct ObjectIssue {
  enum class Kind : std::uint8_t { kSilent, kAborted, kMismatch };
  int axis = 0;
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  const char* object_name = "";
  Kind kind{};
  std::uint32_t abort_code = 0;  ///< kAborted
  std::uint32_t wanted = 0;      ///< kMismatch
  std::uint32_t found = 0;
  bool forbids_motion = false;  ///< else it costs a capability or nothing
};

/// "axis 3: 6007h abort connection option code: object does not exist (abort 06020000h)".
std::string describe(const ObjectIssue& issue);

class ServoBus {
 public:
  virtual ~ServoBus() = default;

  virtual int num_axes() const = 0;
  virtual BusPhase phase() const = 0;

  /// Of the axes as configured; all false before.
  virtual Capabilities capabilities() const = 0;

  /// Each (cause, axis) once, in the order seen, until rearm().
  virtual std::span<const Fault> faults() const = 0;

  /// Of the last configure().
  virtual std::span<const ObjectIssue> issues() const = 0;

  /// Requests; each begins at the next poll. False (and no effect) in a phase that does not allow
  /// it.
  virtual bool configure() = 0;  ///< from kIdle or kReady; listens 300 ms first if not yet speaking
  virtual bool enable() = 0;     ///< from kReady or kStopped; first target of each axis = measured
  virtual bool disable() = 0;    ///< from kEnabling, kEnabled or kStopped: walks down to no torque
  virtual bool stop(StopKind kind) = 0;  ///< in any phase that sends to drives
  /// Forgets the faults, purges what was not sent, resets drive faults by edge. Ends in kReady when
  /// all axes are still configured, else in kIdle; the fault comes back if its cause is not gone.
  virtual bool rearm() = 0;

  /// Receives and does what is due by time. As often as wanted between cycles.
  virtual void poll(std::int64_t now_us) = 0;

  /// One cycle = begin_cycle(), then end_cycle(); between them targets are computed from what has
  /// just been heard and requests made, so that a reaction leaves in the cycle of its cause.
  /// begin_cycle: poll; `feedback` gets every axis' last state. end_cycle: send targets (if
  /// enabled), then SYNC. Spans hold num_axes() elements; targets.axes may be empty while not
  /// enabled.
  virtual void begin_cycle(std::int64_t now_us, std::span<AxisFeedback> feedback) = 0;
  virtual void end_cycle(const Targets& targets) = 0;

  /// A whole cycle with targets from before.
  void exchange(std::int64_t now_us, const Targets& targets, std::span<AxisFeedback> feedback) {
    begin_cycle(now_us, feedback);
    end_cycle(targets);
  }
};

}  // namespace can
