// SPDX-License-Identifier: BSD-3-Clause
#include "can/flight_recorder.h"

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdio>
#include <ostream>

#include <linux/can.h>

#include "base/check.h"

namespace can {
namespace {

std::string seconds(std::int64_t time_us) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%010" PRId64 ".%06" PRId64, time_us / 1'000'000,
                time_us % 1'000'000);
  return text.data();
}

/// The entries of a ring in the order of their recording.
template <class Entry, class Visit>
void visit_oldest_first(const std::vector<Entry>& ring, std::uint64_t num_recorded, Visit visit) {
  const std::uint64_t num_kept = std::min<std::uint64_t>(num_recorded, ring.size());
  for (std::uint64_t i = num_recorded - num_kept; i < num_recorded; ++i) {
    visit(ring[i % ring.size()]);
  }
}

}  // namespace

std::string candump_line(std::int64_t time_us, const std::string& interface,
                         const CanFrame& frame) {
  std::array<char, 32> text{};
  const std::uint32_t id = frame.id | (frame.error ? CAN_ERR_FLAG : 0U);
  const bool wide = frame.extended || frame.error;
  std::snprintf(text.data(), text.size(), wide ? "%08X#" : "%03X#", id);
  std::string line = "(";
  line.append(seconds(time_us)).append(") ").append(interface).append(" ").append(text.data());
  if (frame.remote) {
    std::snprintf(text.data(), text.size(), "R%u", frame.dlc);
    return line + text.data();
  }
  for (std::size_t i = 0; i < frame.dlc; ++i) {
    std::snprintf(text.data(), text.size(), "%02X", frame.data[i]);
    line += text.data();
  }
  return line;
}

FlightRecorder::FlightRecorder(std::size_t num_frames, std::size_t num_events)
    : frames_(num_frames), events_(num_events) {
  CHECK(num_frames > 0 && num_events > 0, "a recorder keeps something");
}

void FlightRecorder::record(std::int64_t time_us, Direction direction, const CanFrame& frame) {
  frames_[num_frames_recorded_++ % frames_.size()] = {time_us, direction, frame};
}

void FlightRecorder::record(std::int64_t time_us, BusPhase phase) {
  Fault at;
  at.time_us = time_us;
  events_[num_events_recorded_++ % events_.size()] = {at, phase, false};
}

void FlightRecorder::record(const Fault& fault) {
  events_[num_events_recorded_++ % events_.size()] = {fault, BusPhase::kIdle, true};
}

void FlightRecorder::write_candump(std::ostream& out, const std::string& interface) const {
  visit_oldest_first(frames_, num_frames_recorded_, [&](const FrameEntry& entry) {
    if (entry.frame.fd) return;  // its bytes are not known
    out << candump_line(entry.time_us, interface, entry.frame) << '\n';
  });
}

void FlightRecorder::write_events(std::ostream& out) const {
  visit_oldest_first(events_, num_events_recorded_, [&](const EventEntry& entry) {
    out << seconds(entry.fault.time_us);
    if (!entry.is_fault) {
      out << " phase " << name(entry.phase) << '\n';
      return;
    }
    std::array<char, 16> detail{};
    std::snprintf(detail.data(), detail.size(), "%Xh", entry.fault.detail);
    out << " fault ";
    if (entry.fault.axis >= 0) out << "axis " << entry.fault.axis << ' ';
    out << name(entry.fault.cause) << ' ' << detail.data() << '\n';
  });
}

}  // namespace can
