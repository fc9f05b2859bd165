// SPDX-License-Identifier: BSD-3-Clause
#include "climb/safety.h"

#include "base/within.h"

namespace climb {
namespace {

constexpr double kRounding = 1.0 + 1e-9;  // a step of exactly v T, computed elsewhere, is allowed

bool is_sound(const AxisLimits& limits) {
  return std::isfinite(limits.min_rad) && std::isfinite(limits.max_rad) &&
         limits.min_rad < limits.max_rad && std::isfinite(limits.max_velocity_rad_s) &&
         limits.max_velocity_rad_s > 0.0 && std::isfinite(limits.max_torque_Nm) &&
         limits.max_torque_Nm > 0.0;
}

bool is_sound(const GateParams& params) {
  return std::isfinite(params.period_s) && params.period_s > 0.0 && params.max_age_us >= 0 &&
         std::isfinite(params.max_start_error_rad) && params.max_start_error_rad >= 0.0;
}

bool is_finite(const AxisCommand& command) {
  return std::isfinite(command.position_rad) && std::isfinite(command.velocity_rad_s) &&
         std::isfinite(command.torque_Nm) && std::isfinite(command.max_torque_Nm);
}

AxisLimits limits_of(const JointLimits& joint) {
  return {joint.min_rad, joint.max_rad, joint.max_velocity_rad_s, joint.peak_torque_Nm};
}

}  // namespace

const char* name(GateReason reason) {
  constexpr const char* kNames[kNumGateReasons] = {"passed",   "bad limits", "not started",
                                                   "stale",    "not finite", "position",
                                                   "velocity", "torque",     "rate"};
  return kNames[static_cast<int>(reason)];
}

PerAxis<AxisLimits> axis_limits(const RobotParams& robot, double jaw_slack_rad) {
  PerAxis<AxisLimits> limits;
  for (const Leg leg : kLegs) {
    limits[axis_of(leg, 0)] = limits_of(robot.abduction);
    limits[axis_of(leg, 1)] = limits_of(robot.hip);
    AxisLimits& knee = limits[axis_of(leg, 2)];
    knee = limits_of(robot.knee_bend);
    if (robot.knee_sign[leg] < 0.0) {
      knee.min_rad = -robot.knee_bend.max_rad;
      knee.max_rad = -robot.knee_bend.min_rad;
    }
    const ClawParams& claw = robot.claw;
    limits[axis_of(leg, kJaw)] = {claw.closed_rad - jaw_slack_rad, claw.open_rad + jaw_slack_rad,
                                  claw.max_velocity_rad_s, claw.max_torque_Nm};
  }
  return limits;
}

std::string check(const PerAxis<AxisLimits>& limits) {
  for (int axis = 0; axis < kNumAxes; ++axis) {
    if (!is_sound(limits[axis])) {
      return "axis " + std::to_string(axis) +
             ": limits must be finite, min_rad below max_rad, velocity and torque positive";
    }
  }
  return "";
}

SafetyGate::SafetyGate(const PerAxis<AxisLimits>& limits, const GateParams& params)
    : limits_(limits), params_(params), limits_verdict_{GateReason::kPassed, -1} {
  if (!is_sound(params)) limits_verdict_ = {GateReason::kBadLimits, -1};
  for (int axis = 0; axis < kNumAxes && limits_verdict_.passed(); ++axis) {
    if (!is_sound(limits_[axis])) limits_verdict_ = {GateReason::kBadLimits, axis};
  }
}

GateVerdict SafetyGate::start_at(const PerAxis<double>& measured_rad, double holding_torque_part) {
  started_ = false;
  if (!limits_verdict_.passed()) return limits_verdict_;
  if (!(holding_torque_part > 0.0 && holding_torque_part <= 1.0)) return {GateReason::kTorque, -1};
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const double slack_rad = params_.max_start_error_rad;
    const AxisLimits& limits = limits_[axis];
    if (!std::isfinite(measured_rad[axis])) return {GateReason::kNotFinite, axis};
    if (!base::within(measured_rad[axis], limits.min_rad - slack_rad, limits.max_rad + slack_rad)) {
      return {GateReason::kPosition, axis};
    }
    sent_[axis] = {measured_rad[axis], 0.0, 0.0, holding_torque_part * limits.max_torque_Nm};
  }
  started_ = true;
  return {GateReason::kPassed, -1};
}

GateVerdict SafetyGate::pass(const PerAxis<AxisCommand>& wanted, std::int64_t computed_us,
                             std::int64_t now_us) {
  const GateVerdict verdict = judge(wanted, computed_us, now_us);
  if (verdict.passed()) {
    sent_ = wanted;
  } else {
    for (AxisCommand& command : sent_) command.velocity_rad_s = 0.0;
  }
  return verdict;
}

GateVerdict SafetyGate::judge(const PerAxis<AxisCommand>& wanted, std::int64_t computed_us,
                              std::int64_t now_us) const {
  if (!limits_verdict_.passed()) return limits_verdict_;
  if (!started_) return {GateReason::kNotStarted, -1};
  const bool is_fresh = computed_us <= now_us && computed_us >= now_us - params_.max_age_us;
  if (!is_fresh) return {GateReason::kStale, -1};
  for (int axis = 0; axis < kNumAxes; ++axis) {
    const GateReason reason = judge_axis(wanted[axis], axis);
    if (reason != GateReason::kPassed) return {reason, axis};
  }
  return {GateReason::kPassed, -1};
}

GateReason SafetyGate::judge_axis(const AxisCommand& wanted, int axis) const {
  const AxisLimits& limits = limits_[axis];
  const double last_rad = sent_[axis].position_rad;
  if (!is_finite(wanted)) return GateReason::kNotFinite;
  // A start just outside the limits may be held or left inwards, never left outwards.
  const double low_rad = last_rad < limits.min_rad ? last_rad : limits.min_rad;
  const double high_rad = last_rad > limits.max_rad ? last_rad : limits.max_rad;
  if (!base::within(wanted.position_rad, low_rad, high_rad)) return GateReason::kPosition;
  const double max_velocity = limits.max_velocity_rad_s * kRounding;
  if (!base::within(wanted.velocity_rad_s, -max_velocity, max_velocity))
    return GateReason::kVelocity;
  if (!base::within(wanted.torque_Nm, -limits.max_torque_Nm, limits.max_torque_Nm)) {
    return GateReason::kTorque;
  }
  const bool may_limit = wanted.max_torque_Nm > 0.0 && wanted.max_torque_Nm <= limits.max_torque_Nm;
  if (!may_limit) return GateReason::kTorque;
  const double max_step_rad = limits.max_velocity_rad_s * params_.period_s * kRounding;
  if (!base::within(wanted.position_rad - last_rad, -max_step_rad, max_step_rad))
    return GateReason::kRate;
  return GateReason::kPassed;
}

}  // namespace climb
