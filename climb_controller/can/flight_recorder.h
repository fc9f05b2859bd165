// SPDX-License-Identifier: BSD-3-Clause
// The last frames in both directions and the last phases and faults, in rings of fixed size: what
// a person wants to see after something went wrong. Recording costs a copy; text is made on demand.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "can/can_frame.h"
#include "can/servo_bus.h"

namespace can {

/// One line as `candump -L` writes it, without the line's end:
/// "(1700000000.000123) can0 181#2706000000000000".
std::string candump_line(std::int64_t time_us, const std::string& interface, const CanFrame& frame);

class FlightRecorder {
 public:
  explicit FlightRecorder(std::size_t num_frames = 8192, std::size_t num_events = 256);

  enum class Direction : std::uint8_t { kSent, kReceived };
  void record(std::int64_t time_us, Direction direction, const CanFrame& frame);
  void record(std::int64_t time_us, BusPhase phase);
  void record(const Fault& fault);

  /// Oldest first. Readable by candump's tools, tshark and canmatrix' users.
  void write_candump(std::ostream& out, const std::string& interface) const;

  /// Oldest first: "0.310000 phase ready", "0.420000 fault axis 3 silent 3h".
  void write_events(std::ostream& out) const;

 private:
  struct FrameEntry {
    std::int64_t time_us = 0;
    Direction direction{};
    CanFrame frame;
  };
  struct EventEntry {
    Fault fault;  ///< its time also for a phase
    BusPhase phase{};
    bool is_fault = false;
  };

  std::vector<FrameEntry> frames_;
  std::vector<EventEntry> events_;
  std::uint64_t num_frames_recorded_ = 0;
  std::uint64_t num_events_recorded_ = 0;
};

}  // namespace can
