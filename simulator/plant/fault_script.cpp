// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/fault_script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "base/rng.h"

namespace simulator {
namespace {

using enum FaultKind;

constexpr std::array<const char*, kNumFaultKinds> kNames = {"silent",
                                                            "no_heartbeat",
                                                            "no_state",
                                                            "wrong_length",
                                                            "slow",
                                                            "stuck",
                                                            "wrong_sign",
                                                            "emergency",
                                                            "reboot",
                                                            "pre_operational",
                                                            "under_voltage",
                                                            "frame_loss",
                                                            "frame_duplicate",
                                                            "frame_delay",
                                                            "touch_stuck_low",
                                                            "touch_stuck_high",
                                                            "no_force",
                                                            "rung_breaks",
                                                            "rung_weak",
                                                            "rung_breaks_on_touch",
                                                            "estop",
                                                            "estop_wire",
                                                            "bus_down",
                                                            "bus_stalled",
                                                            "bus_off",
                                                            "foreign_sync",
                                                            "junk_frames",
                                                            "undock"};

bool orders_before(const Fault& a, const Fault& b) {
  return a.time_us < b.time_us;
}

double random_value(FaultKind kind, base::Rng& rng) {
  switch (kind) {
    case kSlow:
      return 0.05 + 0.5 * rng.uniform();
    case kEmergency: {
      constexpr std::array<double, 4> kCodes = {0x2310, 0x3210, 0x4210, 0x7305};
      return kCodes[rng.below(4)];
    }
    case kFrameLoss:
    case kFrameDuplicate:
      return 0.05 + 0.9 * rng.uniform();
    case kFrameDelay:
      return std::floor(1.0 + 40.0 * rng.uniform());
    case kRungWeak:
      return 20.0 + 80.0 * rng.uniform();
    case kJunkFrames:
      return 1.0 + rng.below(20);
    default:
      return 0.0;
  }
}

/// Faults of frames on the way, at the axis' own port.
void set_port(const Fault& fault, bool on, PortFaults& port) {
  if (fault.kind == kFrameLoss) port.loss_share = on ? fault.value : 0.0;
  if (fault.kind == kFrameDuplicate) port.duplicate_share = on ? fault.value : 0.0;
  if (fault.kind == kFrameDelay) port.delay_us = on ? std::llround(fault.value * 1000.0) : 0;
}

/// "" or what is wrong with one line; a comment leaves `fault` as it is and says "empty".
std::string parse_line(std::string line, Fault& fault) {
  line = line.substr(0, line.find('#'));
  std::istringstream words(line);
  double time_s = 0.0;
  std::string kind;
  std::string value;
  if (line.find_first_not_of(" \t\r") == std::string::npos) return "empty";
  if (!(words >> time_s >> kind) || !(time_s >= 0.0 && time_s < 1e6)) return "needs TIME_S KIND";
  const auto found = std::find_if(kNames.begin(), kNames.end(),
                                  [&kind](const char* known) { return kind == known; });
  if (found == kNames.end()) return "unknown kind " + kind;
  fault.kind = static_cast<FaultKind>(found - kNames.begin());
  fault.time_us = static_cast<std::int64_t>(std::llround(time_s * 1e6));
  double duration_s = 0.0;
  if (words >> fault.target && words >> value) {
    char* end = nullptr;
    fault.value = std::strtod(value.c_str(), &end);  // knows 0x too
    if (end == value.c_str() || *end != '\0') return "VALUE is no number: " + value;
    words >> duration_s;
  }
  fault.duration_us = static_cast<std::int64_t>(std::llround(duration_s * 1e6));
  words.clear();
  std::string rest;
  if (words >> rest) return "not understood: " + rest;
  const int limit = num_targets(fault.kind);
  if (fault.target < 0 || (limit > 0 && fault.target >= limit)) return "no such TARGET";
  return "";
}

}  // namespace

const char* name(FaultKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

int num_targets(FaultKind kind) {
  if (kind <= kFrameDelay) return kNumAxes;
  if (kind <= kNoForce) return kNumLegs;
  return kind <= kRungBreaksOnTouch ? 0 : 1;
}

ParsedFaults parse_faults(std::string_view text) {
  ParsedFaults parsed;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    Fault fault;
    const std::string problem = parse_line(line, fault);
    if (problem == "empty") continue;
    if (!problem.empty()) {
      parsed.problem = "line " + std::to_string(number) + ": " + problem;
      return parsed;
    }
    parsed.faults.push_back(fault);
  }
  std::stable_sort(parsed.faults.begin(), parsed.faults.end(), orders_before);
  return parsed;
}

std::string to_text(const Fault& fault) {
  std::array<char, 160> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.6f %s %d %.17g %.6f",
                1e-6 * static_cast<double>(fault.time_us), name(fault.kind), fault.target,
                fault.value, 1e-6 * static_cast<double>(fault.duration_us));
  return buffer.data();
}

std::vector<Fault> random_faults(std::uint64_t seed, const RandomFaultParams& params) {
  base::Rng rng(seed);
  std::vector<Fault> faults;
  while (static_cast<int>(faults.size()) < params.num_faults) {
    Fault fault;
    fault.kind = static_cast<FaultKind>(rng.below(kNumFaultKinds - 1));
    if (fault.kind == kNoForce && !params.has_force_nodes) continue;
    const int targets = num_targets(fault.kind);
    fault.target = static_cast<int>(
        rng.below(static_cast<std::uint32_t>(targets > 0 ? targets : params.num_rungs)));
    const double share = rng.uniform();
    fault.time_us =
        params.from_us +
        static_cast<std::int64_t>(share * static_cast<double>(params.until_us - params.from_us));
    fault.value = random_value(fault.kind, rng);
    if (rng.below(2) == 0) fault.duration_us = 10'000 + 1000 * rng.below(1000);
    faults.push_back(fault);
  }
  std::stable_sort(faults.begin(), faults.end(), orders_before);
  return faults;
}

FaultPlayer::FaultPlayer(std::vector<Fault> faults, MemoryBus& bus)
    : faults_(std::move(faults)), port_(bus.attach(127)) {
  std::stable_sort(faults_.begin(), faults_.end(), orders_before);
}

void FaultPlayer::add(const Fault& fault) {
  const auto begun = faults_.begin() + static_cast<std::ptrdiff_t>(next_);
  faults_.insert(std::upper_bound(begun, faults_.end(), fault, orders_before), fault);
}

void FaultPlayer::apply(std::int64_t now_us, RobotPlant& plant, MemoryBus& bus) {
  for (CarriedFrame unread; bus.receive(port_, now_us, unread);) continue;
  for (std::size_t i = 0; i < running_.size();) {
    const Fault& fault = running_[i];
    if (now_us < fault.time_us + fault.duration_us) {
      ++i;
      continue;
    }
    set(fault, false, plant);
    set_port(fault, false, bus.faults(plant.port(fault.target % kNumAxes)));
    const bool of_bus = fault.kind == kBusDown || fault.kind == kBusStalled;
    if (of_bus) bus.set_condition(BusCondition::kUp, now_us);
    if (fault.kind == kUnderVoltage) plant.clear_warning(fault.target);
    running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  for (; next_ < faults_.size() && faults_[next_].time_us <= now_us; ++next_) {
    const Fault& fault = faults_[next_];
    set(fault, true, plant);
    happen(fault, now_us, plant, bus);
    if (fault.duration_us > 0) running_.push_back(fault);
    set_port(fault, true, bus.faults(plant.port(fault.target % kNumAxes)));
  }
}

}  // namespace simulator
