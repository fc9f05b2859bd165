// SPDX-License-Identifier: BSD-3-Clause
// The one gate before every send: fresh -> finite -> limits -> rate. What does not pass as a whole
// is not sent at all: the last targets that passed are sent again (hold), with the reason told.
// Comparisons are in positive form, so that NaN fails each of them.
#pragma once

#include <cstdint>
#include <string>

#include "climb/axis.h"
#include "climb/params.h"

namespace climb {

struct AxisLimits {
  double min_rad = 0.0;
  double max_rad = 0.0;
  double max_velocity_rad_s = 0.0;
  double max_torque_Nm = 0.0;
};

/// From the robot's parameters; jaws may press `jaw_slack_rad` beyond their stops.
PerAxis<AxisLimits> axis_limits(const RobotParams& robot, double jaw_slack_rad = 0.1);

/// For one axis and one cycle.
struct AxisCommand {
  double position_rad = 0.0;
  double velocity_rad_s = 0.0;  ///< feed-forward
  double torque_Nm = 0.0;       ///< feed-forward
  double max_torque_Nm = 0.0;   ///< > 0
};

struct GateParams {
  double period_s = 0.01;             ///< of the control cycle; no step is judged by elapsed time
  std::int64_t max_age_us = 20'000;   ///< of a command: two cycles
  double max_start_error_rad = 0.02;  ///< a measured position may lie so far outside the limits
};

enum class GateReason : std::uint8_t {
  kPassed,
  kBadLimits,   ///< limits inverted, not finite or not positive: nothing ever passes
  kNotStarted,  ///< no measured position yet
  kStale,       ///< computed too long ago, or in the future
  kNotFinite,
  kPosition,
  kVelocity,
  kTorque,
  kRate  ///< a step larger than the axis can go in one period
};
inline constexpr int kNumGateReasons = static_cast<int>(GateReason::kRate) + 1;

const char* name(GateReason reason);

struct GateVerdict {
  GateReason reason = GateReason::kNotStarted;
  int axis = -1;  ///< the first one refused, -1 = all of them
  bool passed() const { return reason == GateReason::kPassed; }
};

class SafetyGate {
 public:
  SafetyGate(const PerAxis<AxisLimits>& limits, const GateParams& params);

  /// Before the first command: targets stand where the axes are. Refused (and not started) when a
  /// position is not finite or not plausible; the first command may then be that position only
  /// within one period's step.
  GateVerdict start_at(const PerAxis<double>& measured_rad, double holding_torque_part = 1.0);

  /// Nothing passes until the next start_at().
  void stop() { started_ = false; }
  bool started() const { return started_; }

  /// Afterwards sent() is `wanted`, or what was sent before with no speed in it.
  GateVerdict pass(const PerAxis<AxisCommand>& wanted, std::int64_t computed_us,
                   std::int64_t now_us);

  /// What may be put on the bus. Only meaningful while started().
  const PerAxis<AxisCommand>& sent() const { return sent_; }

 private:
  GateVerdict judge(const PerAxis<AxisCommand>& wanted, std::int64_t computed_us,
                    std::int64_t now_us) const;
  GateReason judge_axis(const AxisCommand& wanted, int axis) const;

  PerAxis<AxisLimits> limits_;
  GateParams params_;
  GateVerdict limits_verdict_;
  bool started_ = false;
  PerAxis<AxisCommand> sent_{};
};

/// "" or what is wrong with the first bad axis, in words.
std::string check(const PerAxis<AxisLimits>& limits);

}  // namespace climb
