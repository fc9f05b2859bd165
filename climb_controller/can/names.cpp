// SPDX-License-Identifier: BSD-3-Clause
// Enumerators as words, for reports and dumps.
#include <array>
#include <cstdio>

#include "can/cia402.h"
#include "can/servo_bus.h"
#include "can/transport.h"

namespace can {
namespace {

template <std::size_t kSize, class Enum>
const char* entry(const std::array<const char*, kSize>& words, Enum value) {
  const auto index = static_cast<std::size_t>(value);
  return index < kSize ? words[index] : "?";
}

}  // namespace

const char* name(TransferStatus status) {
  static constexpr std::array<const char*, 6> kWords = {"done",         "would block", "no buffers",
                                                        "network down", "gone",        "refused"};
  return entry(kWords, status);
}

const char* name(FaultCause cause) {
  static constexpr std::array<const char*, kNumFaultCauses> kWords = {
      "silent",           "heartbeat lost",         "unexpected boot-up",
      "left operational", "left operation enabled", "emergency",
      "warning",          "enable timeout",         "target refused",
      "configuration",    "malformed frames",       "foreign master",
      "bus off",          "error passive",          "transmit stalled",
      "interface lost"};
  return entry(kWords, cause);
}

const char* name(BusPhase phase) {
  static constexpr std::array<const char*, 10> kWords = {
      "idle",     "listening", "configuring", "ready",     "rearming",
      "enabling", "enabled",   "stopped",     "disabling", "faulted"};
  return entry(kWords, phase);
}

const char* name(DriveState state) {
  static constexpr std::array<const char*, kNumDriveStates> kWords = {
      "unknown",     "not ready to switch on", "switch on disabled", "ready to switch on",
      "switched on", "operation enabled",      "quick stop active",  "fault reaction active",
      "fault"};
  return entry(kWords, state);
}

std::string describe(const ObjectIssue& issue) {
  std::array<char, 200> text{};
  const int length = std::snprintf(text.data(), text.size(), "axis %d: %04Xh:%u %s: ", issue.axis,
                                   issue.index, issue.subindex, issue.object_name);
  char* rest = text.data() + length;
  const std::size_t room = text.size() - static_cast<std::size_t>(length);
  switch (issue.kind) {
    case ObjectIssue::Kind::kSilent:
      std::snprintf(rest, room, "no answer");
      break;
    case ObjectIssue::Kind::kAborted:
      std::snprintf(rest, room, "%s (abort %08Xh)", cia402::abort_text(issue.abort_code),
                    issue.abort_code);
      break;
    case ObjectIssue::Kind::kMismatch:
      std::snprintf(rest, room, "wrote %u, reads back %u", issue.wanted, issue.found);
      break;
  }
  return text.data();
}

}  // namespace can
