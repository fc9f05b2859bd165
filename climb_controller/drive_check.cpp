// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/drive_check.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace climb_controller {
namespace {

constexpr std::int64_t kListen_us = 300'000;
constexpr std::int64_t kLook_us = 500'000;
constexpr std::int64_t kSettle_us = 300'000;

/// 0 at 0, 1 at 1, at rest at both ends.
double quintic(double part) {
  const double x = std::min(part, 1.0);
  return x * x * x * (10.0 + x * (6.0 * x - 15.0));
}

std::string hex_of(std::uint32_t value, int num_digits) {
  static constexpr char kDigits[] = "0123456789ABCDEF";
  std::string text(static_cast<std::size_t>(num_digits), '0');
  for (auto digit = text.rbegin(); digit != text.rend(); ++digit, value >>= 4) {
    *digit = kDigits[value & 15];
  }
  return text + "h";
}

/// Without "axis 0: ": there is only one.
std::string issue_text(const can::ObjectIssue& issue) {
  const std::string text = can::describe(issue);
  return text.substr(text.find(": ") + 2);
}

std::string fault_text(const can::Fault& fault) {
  return std::string(can::name(fault.cause)) + " (" + hex_of(fault.detail, 4) + ")";
}

}  // namespace

std::string check(const DriveCheckParams& params) {
  can::AxisConfig axis = params.axis;
  const std::string problem = can::check(axis);
  if (!problem.empty()) return problem;
  if (!(std::isfinite(params.move_rad) && std::fabs(params.move_rad) <= 3.2)) {
    return "move_rad in -3.2..3.2";
  }
  if (!(params.speed_rad_s > 0.0 && params.speed_rad_s <= axis.max_velocity_rad_s)) {
    return "0 < speed_rad_s <= max_velocity_rad_s";
  }
  if (!(params.margin_rad > 0.0 && params.margin_rad <= 10.0)) return "margin_rad in 0..10";
  if (params.cycle_us < 1000 || params.cycle_us > 100'000 || params.cycle_us % 1000 != 0) {
    return "cycle_us is 1000..100000, whole milliseconds";
  }
  return "";
}

DriveCheck::DriveCheck(const DriveCheckParams& params, can::Transport& transport,
                       can::FlightRecorder* recorder)
    : params_(params), transport_(transport), recorder_(recorder), reader_(params.axis.node_id) {}

void DriveCheck::enter(Stage stage) {
  stage_ = stage;
  stage_since_us_ = now_us_;
}

void DriveCheck::poll(std::int64_t now_us) {
  now_us_ = now_us;
  if (stage_since_us_ < 0) stage_since_us_ = now_us;
  if (bus_) {
    bus_->poll(now_us);
  } else if (!is_done()) {
    advance_without_bus();
  }
}

void DriveCheck::cycle(std::int64_t now_us) {
  if (!bus_) return poll(now_us);
  now_us_ = now_us;
  bus_->begin_cycle(now_us, {&feedback_, 1});
  if (!is_done()) advance();
  bus_->end_cycle({now_us, {&target_, 1}});
}

void DriveCheck::advance_without_bus() {
  if (!transport_.maintain(now_us_)) return give_up("the CAN line is not usable");
  can::ReceivedFrame received;
  while (transport_.receive(received) == can::TransferStatus::kDone) {
    if (can::cia402::is_master_frame(received.frame)) {
      return give_up("another master speaks: frame " + hex_of(received.frame.id, 3));
    }
    reader_.take(received.frame);
  }
  if (stage_ == Stage::kListening) {
    if (elapsed_us() >= kListen_us) enter(Stage::kIdentifying);
    return;
  }
  if (const auto frame = reader_.next_frame(now_us_)) transport_.send(*frame);
  if (reader_.is_done()) start_bus();
}

void DriveCheck::start_bus() {
  report_.identity = reader_.identity();
  if (!report_.identity.answered) return give_up("no answer from this node");
  if (!report_.identity.position) return give_up("6064h position cannot be read");
  can::Cia402Params bus;
  bus.cycle_us = params_.cycle_us;
  bus.optional_objects = params_.optional_objects;
  // An ordinary process on a desk: a late cycle says nothing about the drive.
  bus.max_missed_cycles = 10;
  bus.line.max_stalled_cycles = 10;
  // Whoever else is on the bus may speak and is told nothing.
  for (int node = 1; node < can::cia402::kMasterNode; ++node) {
    if (node != params_.axis.node_id) bus.other_nodes.push_back(static_cast<std::uint8_t>(node));
  }
  can::AxisConfig& axis = bus.axes.emplace_back(params_.axis);
  report_.start_rad =
      can::rad_from_counts(axis, static_cast<std::int32_t>(*report_.identity.position));
  axis.min_rad = report_.start_rad + std::min(0.0, params_.move_rad) - params_.margin_rad;
  axis.max_rad = report_.start_rad + std::max(0.0, params_.move_rad) + params_.margin_rad;
  const std::string problem = can::check(bus);
  if (!problem.empty()) return give_up(problem);
  bus_.emplace(bus, transport_, recorder_);
  bus_->configure();
  enter(Stage::kConfiguring);
}

void DriveCheck::advance() {
  const can::BusPhase phase = bus_->phase();
  if (phase == can::BusPhase::kFaulted) return give_up("the bus failed");
  switch (stage_) {
    case Stage::kConfiguring:
    case Stage::kResetting:
      if (phase == can::BusPhase::kIdle) give_up("it cannot be configured");
      if (phase == can::BusPhase::kReady) enter(Stage::kLooking);
      break;
    case Stage::kLooking:
      if (elapsed_us() >= kLook_us) advance_configured();
      break;
    case Stage::kEnabling:
      if (phase == can::BusPhase::kStopped) give_up("it does not enable");
      if (phase != can::BusPhase::kEnabled) break;
      report_.start_rad = feedback_.position_rad;
      target_.position_rad = report_.start_rad;
      enter(Stage::kGoing);
      break;
    case Stage::kGoing:
      advance_move(report_.start_rad, report_.start_rad + params_.move_rad);
      break;
    case Stage::kReturning:
      advance_move(report_.start_rad + params_.move_rad, report_.start_rad);
      break;
    case Stage::kDisabling:
      if (phase == can::BusPhase::kReady || phase == can::BusPhase::kStopped) finish();
      break;
    default:
      break;
  }
}

void DriveCheck::advance_configured() {
  if (!bus_->faults().empty()) {
    if (!params_.reset_fault || was_reset_) {
      return give_up(params_.reset_fault ? "its fault cannot be reset" : "found in fault");
    }
    was_reset_ = true;
    bus_->rearm();
    return enter(Stage::kResetting);
  }
  if (params_.move_rad == 0.0) return finish();
  if (!bus_->enable()) return give_up("it may not be enabled");
  enter(Stage::kEnabling);
}

void DriveCheck::advance_move(double from_rad, double to_rad) {
  // The quintic's top speed is 15/8 of its mean.
  const double duration_us = 1e6 * 1.875 * std::fabs(to_rad - from_rad) / params_.speed_rad_s;
  if (!bus_->faults().empty()) return give_up("it failed while moving");
  report_.max_lag_rad =
      std::max(report_.max_lag_rad, std::fabs(target_.position_rad - feedback_.position_rad));
  const auto elapsed = static_cast<double>(elapsed_us());
  target_.position_rad = from_rad + (to_rad - from_rad) * quintic(elapsed / duration_us);
  if (elapsed < duration_us + static_cast<double>(kSettle_us)) return;
  if (stage_ == Stage::kGoing) {
    report_.reached_rad = feedback_.position_rad;
    return enter(Stage::kReturning);
  }
  report_.returned_rad = feedback_.position_rad;
  finish_move();
}

void DriveCheck::finish_move() {
  const double tolerance_rad =
      0.1 * std::fabs(params_.move_rad) + 2.0 / params_.axis.counts_per_rad;
  const double goal_rad = report_.start_rad + params_.move_rad;
  if (!(std::fabs(*report_.reached_rad - goal_rad) <= tolerance_rad)) {
    report_.problem = "it did not follow its target";
  } else if (!(std::fabs(*report_.returned_rad - report_.start_rad) <= tolerance_rad)) {
    report_.problem = "it did not come back";
  }
  bus_->disable();
  enter(Stage::kDisabling);
}

void DriveCheck::cancel() {
  if (!is_done()) give_up("cancelled");
}

void DriveCheck::give_up(const std::string& problem) {
  if (report_.problem.empty()) report_.problem = problem;
  if (bus_ && stage_ != Stage::kDisabling && bus_->disable()) return enter(Stage::kDisabling);
  finish();
}

void DriveCheck::finish() {
  stage_ = Stage::kDone;
  if (bus_) {
    report_.capabilities = bus_->capabilities();
    report_.issues.assign(bus_->issues().begin(), bus_->issues().end());
    report_.faults.assign(bus_->faults().begin(), bus_->faults().end());
    report_.num_malformed = bus_->num_malformed();
  }
  if (!report_.problem.empty()) return;
  const can::Capabilities& can_do = report_.capabilities;
  const bool fit = can_do.hold_on_loss && can_do.torque_limit && can_do.sync;
  report_.verdict = fit ? DriveVerdict::kFit : DriveVerdict::kGroundOnly;
}

std::string text_of(const DriveReport& report, const DriveCheckParams& params) {
  std::string text = "node " + std::to_string(params.axis.node_id) + "\n";
  const auto add = [&text](const char* what, const std::string& value) {
    text +=
        std::string("  ") + what + std::string(22 - std::string(what).size(), ' ') + value + "\n";
  };
  const auto number = [](const std::optional<std::uint32_t>& value, int num_digits) {
    return value ? hex_of(*value, num_digits) : std::string("not told");
  };
  const auto yes = [](bool value) { return std::string(value ? "yes" : "NO"); };
  const can::DriveIdentity& identity = report.identity;
  add("device type", number(identity.device_type, 8));
  add("vendor, product", number(identity.vendor, 8) + ", " + number(identity.product, 8));
  add("revision, serial", number(identity.revision, 8) + ", " + number(identity.serial_number, 8));
  add("supported modes", number(identity.modes, 8));
  add("statusword", number(identity.status_word, 4));
  const can::Capabilities& can_do = report.capabilities;
  add("holds on loss", yes(can_do.hold_on_loss));
  add("limits torque", yes(can_do.torque_limit));
  add("acts on SYNC", yes(can_do.sync));
  add("objects with issues", std::to_string(report.issues.size()));
  for (const can::ObjectIssue& issue : report.issues) {
    text += "    " + issue_text(issue) + (issue.forbids_motion ? ": forbids motion" : "") + "\n";
  }
  for (const can::Fault& fault : report.faults) text += "    fault: " + fault_text(fault) + "\n";
  if (report.num_malformed > 0) add("frames not understood", std::to_string(report.num_malformed));
  if (report.reached_rad) {
    const double counts = params.move_rad * params.axis.gear * params.axis.counts_per_rad;
    add("asked to move", std::to_string(params.move_rad) + " rad (" +
                             std::to_string(std::llround(counts)) + " counts)");
    add("moved", std::to_string(*report.reached_rad - report.start_rad) + " rad");
    add("largest lag", std::to_string(report.max_lag_rad) + " rad");
  }
  switch (report.verdict) {
    case DriveVerdict::kFit:
      return text + "PASS: fit for climbing\n";
    case DriveVerdict::kGroundOnly:
      return text + "GROUND TESTS ONLY: climbing is refused, see NO above and the objects named\n";
    case DriveVerdict::kUnfit:
      break;
  }
  return text + "FAIL: " + report.problem + "\n";
}

}  // namespace climb_controller
