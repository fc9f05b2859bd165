// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/monitor.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

namespace simulator {
namespace {

constexpr std::int32_t kSameCounts = 2;
constexpr double kToldOpen_rad = 0.02;  ///< beyond where it stands, for a jaw told to open
constexpr std::uint16_t kUnderVoltageWarning = 0x3120;
constexpr std::uint16_t kTemperatureWarning = 0x4310;

[[gnu::format(printf, 1, 2)]] std::string text_of(const char* format, ...) {
  std::array<char, 200> buffer{};
  va_list arguments;
  va_start(arguments, format);
  // clang-tidy 14 does not see that va_start initialises its argument.
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized)
  std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
  va_end(arguments);
  return buffer.data();
}

/// Frames that only a master sends.
bool is_from_master(std::uint32_t id) {
  return id == 0x000 || id == 0x080 || id == 0x77F || (id > 0x200 && id < 0x280) ||
         (id > 0x300 && id < 0x380) || (id > 0x600 && id < 0x680);
}

bool is_axis_node(std::uint32_t node) {
  return node >= 1 && node <= kNumAxes;
}

double ms(std::int64_t time_us) {
  return 1e-3 * static_cast<double>(time_us);
}

}  // namespace

MonitorParams::MonitorParams(const PlantParams& plant) : drives(plant.drives) {
  for (int axis = 0; axis < kNumAxes; ++axis) {
    AxisRules& rule = rules[static_cast<std::size_t>(axis)];
    const bool front = leg_of(axis) < 2;
    if (joint_of(axis) == 0) rule = {-0.9, 0.9, 2.5};
    if (joint_of(axis) == 1) rule = {-2.6, 2.6, 2.5};
    if (joint_of(axis) == 2) rule = {front ? 0.15 : -2.7, front ? 2.7 : -0.15, 2.5};
    if (is_jaw(axis)) rule = {-0.60, 1.3, 6.0};
  }
}

std::string describe(const Violation& violation) {
  return text_of("%.3f ms I%d at %d: ", ms(violation.time_us), violation.invariant,
                 violation.place) +
         violation.text;
}

Monitor::Monitor(const MonitorParams& params) : params_(params) {}

void Monitor::violate(std::int64_t now_us, int invariant, int place, std::string text) {
  ++num_violations_;
  if (violations_.size() < kMaxKept) {
    violations_.push_back({now_us, invariant, place, std::move(text)});
  }
}

double Monitor::angle_rad(int axis, std::int32_t counts) const {
  const DriveParams& drive = params_.drives[static_cast<std::size_t>(axis)];
  return drive.sign * static_cast<double>(counts) / drive.counts_per_rad + drive.offset_rad;
}

void Monitor::on_frame(const CarriedFrame& carried) {
  const BusFrame& frame = carried.frame;
  if ((frame.id & kErrorFlag) != 0) {
    const bool bus_off = (frame.id & 0x40U) != 0;
    if (bus_off && !bus_fault_us_) bus_fault_us_ = carried.time_us;
    return;
  }
  if (!is_standard(frame)) return;
  if (is_from_master(frame.id)) return on_master_frame(carried);
  on_node_frame(carried);
}

void Monitor::on_master_frame(const CarriedFrame& carried) {
  const bool is_judged = params_.master_port < 0 || carried.port == params_.master_port;
  if (is_judged) check_line(carried);
  const std::uint32_t id = carried.frame.id;
  const std::uint32_t node = id & 0x7F;
  const bool is_target = id > 0x200 && id < 0x280 && is_axis_node(node);
  if (is_target && carried.frame.length >= 6) on_target(carried, static_cast<int>(node) - 1);
}

void Monitor::check_line(const CarriedFrame& carried) {
  const std::int64_t now_us = carried.time_us;
  const std::uint32_t id = carried.frame.id;
  if (bus_fault_us_ && now_us > *bus_fault_us_ + params_.latch_reaction_us) {
    violate(now_us, 7, -1,
            text_of("frame %03X sent %.1f ms after a bus fault", id, ms(now_us - *bus_fault_us_)));
  }
  const std::int64_t paused_us = std::max<std::int64_t>(
      0, std::min(now_us, paused_until_us_) - std::max(carried.handed_over_us, paused_from_us_));
  const std::int64_t age_us = now_us - carried.handed_over_us - paused_us;
  if (age_us > 2 * params_.cycle_us) {
    violate(now_us, 9, -1, text_of("frame %03X left %.1f ms late", id, ms(age_us)));
  }
}

void Monitor::on_target(const CarriedFrame& carried, int axis_index) {
  Axis& axis = axes_[static_cast<std::size_t>(axis_index)];
  const std::int64_t now_us = carried.time_us;
  const std::uint32_t word = number_at(carried.frame, 0, 2);
  const auto target = static_cast<std::int32_t>(number_at(carried.frame, 2, 4));
  const bool enables = (word & 0x0F) == 0x0F;
  if (enables) {
    ++num_targets_;
    if (!armed_) violate(now_us, 5, axis_index, text_of("control word %04X, not armed", word));
    const bool first = !axis.enabled;
    if (first && !axis.has_measured) {
      violate(now_us, 6, axis_index, "enabled before any measured position");
    } else if (first && !is_at_measured(axis, target)) {
      violate(now_us, 6, axis_index,
              text_of("first target %d, measured %d", target, axis.measured));
    }
    check_limits(now_us, axis_index, target);
    if (!first) check_stop(now_us, axis_index, target);
    if (is_jaw(axis_index)) check_release(now_us, axis_index, target);
  }
  axis.enabled = enables;
  axis.target = target;
  axis.has_target = true;
}

bool Monitor::is_at_measured(const Axis& axis, std::int32_t target) {
  return axis.has_measured && std::abs(target - axis.measured) <= kSameCounts;
}

void Monitor::check_limits(std::int64_t now_us, int axis_index, std::int32_t target) {
  const Axis& axis = axes_[static_cast<std::size_t>(axis_index)];
  const AxisRules& rule = params_.rules[static_cast<std::size_t>(axis_index)];
  const double scale = params_.drives[static_cast<std::size_t>(axis_index)].counts_per_rad;
  const double slack_rad = 1.0 / scale;
  const double angle = angle_rad(axis_index, target);
  // An axis that stands outside is enabled (I6) or held where it stands and may be led inwards.
  const bool stays = !axis.enabled || is_at_measured(axis, target);
  const double last = angle_rad(axis_index, stays ? axis.measured : axis.target);
  const double low = std::min(rule.min_rad, last) - slack_rad;
  const double high = std::max(rule.max_rad, last) + slack_rad;
  if (!(angle >= low && angle <= high)) {
    violate(now_us, 2, axis_index,
            text_of("target %.5f rad outside %.3f..%.3f", angle, rule.min_rad, rule.max_rad));
  }
  // To where it stands is no jump: what runs away is let go.
  if (stays) return;
  const double change = std::fabs(static_cast<double>(target) - axis.target);
  const double allowed =
      rule.max_velocity_rad_s * 1e-6 * static_cast<double>(params_.cycle_us) * scale + 1.0;
  if (!(change <= allowed)) {
    violate(now_us, 2, axis_index,
            text_of("target changed by %.0f counts, %.1f allowed", change, allowed));
  }
}

void Monitor::check_stop(std::int64_t now_us, int axis_index, std::int32_t target) {
  Axis& axis = axes_[static_cast<std::size_t>(axis_index)];
  const std::int32_t change = target - axis.target;
  if (!stop_since_us_ || now_us <= *stop_since_us_ + params_.stop_reaction_us) {
    const double scale = params_.drives[static_cast<std::size_t>(axis_index)].counts_per_rad;
    const double slack = params_.stop_slack_rad_s * 1e-6 * static_cast<double>(params_.cycle_us);
    axis.stop_speed = std::abs(change) + static_cast<std::int32_t>(slack * scale);
    return;
  }
  const int sign = params_.drives[static_cast<std::size_t>(axis_index)].sign;
  if (is_jaw(axis_index) && sign * change <= 0) return;
  if (is_at_measured(axis, target)) return;
  const std::int64_t since_us = now_us - *stop_since_us_ - params_.stop_reaction_us;
  const std::int32_t allowed = since_us > params_.stop_run_out_us ? 1 : axis.stop_speed + 1;
  if (std::abs(change) <= allowed) return;
  violate(now_us, 4, axis_index,
          text_of("target moved %d counts %.1f ms after the stop, %d allowed", change,
                  ms(now_us - *stop_since_us_), allowed));
}

void Monitor::check_release(std::int64_t now_us, int axis_index, std::int32_t target) {
  Leg& leg = legs_[static_cast<std::size_t>(leg_of(axis_index))];
  const bool opens = angle_rad(axis_index, target) > leg.held_jaw_rad + params_.jaw_opens_rad;
  const bool begins = opens && !leg.open_commanded;
  leg.open_commanded = opens;
  const Axis& jaw = axes_[static_cast<std::size_t>(axis_index)];
  const bool beyond = !jaw.has_measured || angle_rad(axis_index, target) >
                                               angle_rad(axis_index, jaw.measured) + kToldOpen_rad;
  if (beyond) leg.told_open_us = now_us;
  if (!begins || !leg.holds || docked_ || fallen_ || !has_truth_) return;
  const int others = num_confirmed_others(leg_of(axis_index), now_us - params_.confirmed_within_us);
  if (others >= 3) return;
  violate(now_us, 3, leg_of(axis_index),
          text_of("jaw commanded open while %d others are confirmed", others));
}

void Monitor::on_node_frame(const CarriedFrame& carried) {
  const BusFrame& frame = carried.frame;
  const std::uint32_t node = frame.id & 0x7F;
  if (!is_axis_node(node)) return;
  Axis& axis = axes_[node - 1];
  const std::uint32_t function = frame.id & 0x780;
  if (function == 0x180 && frame.length >= 6) {
    axis.measured = static_cast<std::int32_t>(number_at(frame, 2, 4));
    axis.has_measured = true;
    const std::uint32_t word = number_at(frame, 0, 2);
    if ((word & 0x4F) == 0x08 || (word & 0x4F) == 0x0F) trigger_stop(carried.time_us);
  }
  if (function == 0x080 && frame.length == 8) {
    const std::uint32_t code = number_at(frame, 0, 2);
    const bool is_warning =
        code == 0 || code == kUnderVoltageWarning || code == kTemperatureWarning;
    if (!is_warning) trigger_stop(carried.time_us);
  }
  if (function == 0x700 && frame.length == 1) {
    if (frame.bytes[0] == 0x00 && axis.operational) trigger_stop(carried.time_us);
    axis.operational = frame.bytes[0] == 0x05;
  }
}

void Monitor::trigger_stop(std::int64_t now_us) {
  if (armed_ && !stop_since_us_) stop_since_us_ = now_us;
}

int Monitor::num_confirmed_others(int leg, std::int64_t since_us) const {
  int num = 0;
  for (int other = 0; other < kNumLegs; ++other) {
    const Leg& that = legs_[static_cast<std::size_t>(other)];
    if (other != leg && !that.open_commanded && that.confirmed_us >= since_us) ++num;
  }
  return num;
}

bool Monitor::plant_took_lately(std::int64_t now_us) const {
  return std::any_of(legs_.begin(), legs_.end(),
                     [&](const Leg& leg) { return now_us - leg.taken_us <= params_.excused_us; });
}

void Monitor::check_loss(const PlantTruth& truth, int leg_index) {
  Leg& leg = legs_[static_cast<std::size_t>(leg_index)];
  const LegTruth& now = truth.legs[static_cast<std::size_t>(leg_index)];
  if (!leg.holds || now.holds) return;
  // A jaw that was told to close, and opens, obeys a broken drive.
  const bool was_told = truth.time_us - leg.told_open_us <= params_.opening_us;
  if (now.last_loss != LossCause::kOpened || !was_told) {
    leg.taken_us = truth.time_us;
    return;
  }
  // The switch opens before the claw lets go: confirmed lately counts.
  const bool was_confirmed = truth.time_us - leg.confirmed_us <= params_.opening_us;
  if (truth.docked || truth.fallen || !was_confirmed || plant_took_lately(truth.time_us)) return;
  const int others = num_confirmed_others(leg_index, truth.time_us - params_.confirmed_within_us);
  if (others < 3) {
    violate(truth.time_us, 1, leg_index, text_of("opened with %d others confirmed", others));
  }
}

void Monitor::on_truth(const PlantTruth& truth) {
  for (int leg = 0; leg < kNumLegs; ++leg) check_loss(truth, leg);
  int confirmed = 0;
  for (int index = 0; index < kNumLegs; ++index) {
    Leg& leg = legs_[static_cast<std::size_t>(index)];
    const LegTruth& now = truth.legs[static_cast<std::size_t>(index)];
    const int jaw_index = axis_of(index, kJointsPerLeg - 1);
    const Axis& jaw = axes_[static_cast<std::size_t>(jaw_index)];
    if (now.holds && jaw.has_measured) {
      const double jaw_rad = angle_rad(jaw_index, jaw.measured);
      leg.held_jaw_rad = leg.holds ? std::min(leg.held_jaw_rad, jaw_rad) : jaw_rad;
    }
    leg.holds = now.holds;
    leg.confirmed = now.bears && now.touch;
    if (leg.confirmed) leg.confirmed_us = truth.time_us;
    confirmed += leg.confirmed ? 1 : 0;
  }
  if (has_truth_ && docked_ && !truth.docked && confirmed < 3) {
    violate(truth.time_us, 1, -1, text_of("undocked with %d confirmed grasps", confirmed));
  }
  if (!truth.lines[kEstopN]) trigger_stop(truth.time_us);
  docked_ = truth.docked;
  fallen_ = truth.fallen;
  has_truth_ = true;
}

void Monitor::on_session(std::int64_t now_us, SessionEvent event) {
  static_cast<void>(now_us);
  armed_ = event == SessionEvent::kArmed || (armed_ && event != SessionEvent::kDisarmed);
  stop_since_us_.reset();
  bus_fault_us_.reset();
}

void Monitor::on_stop(std::int64_t now_us, int reason) {
  if (reason == 0) violate(now_us, 8, -1, "a stop without a reason");
  if (stop_reason_ && *stop_reason_ != reason) {
    violate(now_us, 8, -1, text_of("reason %d after reason %d", reason, *stop_reason_));
  }
  if (!stop_reason_) stop_reason_ = reason;
}

void Monitor::on_run(std::int64_t now_us) {
  static_cast<void>(now_us);
  stop_reason_.reset();
}

void Monitor::on_pause(std::int64_t from_us, std::int64_t until_us) {
  paused_from_us_ = from_us;
  paused_until_us_ = until_us;
}

}  // namespace simulator
