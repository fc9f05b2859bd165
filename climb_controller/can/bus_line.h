// SPDX-License-Identifier: BSD-3-Clause
// The line under a servo bus, with the watch that every protocol needs: error frames, frames that
// are not what they should be, cycles that do not get out. After a fault of the bus it sends
// nothing at all until cleared.
#pragma once

#include <array>
#include <cstdint>

#include "can/fault_log.h"
#include "can/flight_recorder.h"
#include "can/transport.h"

namespace can {

struct BusLineParams {
  int max_stalled_cycles = 2;    ///< >= 1: so many cycles in a row without getting out = fault
  int max_malformed_per_s = 10;  ///< 1..31: more = fault
};

class BusLine {
 public:
  /// All three outlive the line; `recorder` may be null.
  BusLine(Transport& transport, FaultLog& faults, FlightRecorder* recorder, BusLineParams params)
      : transport_(transport), faults_(faults), recorder_(recorder), params_(params) {}

  /// Faults are only raised while watching; frames are received and recorded always.
  void watch(bool watching) { is_watching_ = watching; }
  bool is_faulted() const { return is_faulted_; }

  /// Opens or re-opens what is lost. To be called first in every poll.
  void begin_poll(std::int64_t now_us);

  /// The next data frame; error frames and frames of another format are dealt with here.
  /// False when no frame waits.
  bool receive(ReceivedFrame& received);

  /// A frame that ought to be ours but makes no sense.
  void count_malformed();

  /// Frames wait to leave: whoever sends out of turn waits for them.
  bool is_busy() const { return is_usable_ && transport_.has_unsent_frames(); }

  /// A frame handed over so long ago that has not left = fault: the watch where nothing is sent in
  /// cycles.
  void watch_unsent(std::int64_t max_us);

  /// False: this cycle must stay silent, because frames of an earlier one have not left yet.
  bool begin_cycle();

  /// False when it did not get out; nothing is ever sent later instead.
  bool send(const CanFrame& frame);

  /// Counts a cycle in which a frame did not get out.
  void end_cycle();

  void raise(FaultCause cause, int axis, std::uint32_t detail);

  /// Re-arming: purges, forgets, speaks again. False (and a new fault) if the line is not usable.
  bool clear();

  std::uint64_t num_malformed() const { return num_malformed_; }

 private:
  void take_error_frame(const CanFrame& frame);
  void stalled();

  Transport& transport_;
  FaultLog& faults_;
  FlightRecorder* recorder_;
  BusLineParams params_;
  std::int64_t now_us_ = 0;
  bool is_usable_ = false;
  bool is_watching_ = false;
  bool is_faulted_ = false;
  bool is_cycle_complete_ = true;
  int num_stalled_cycles_ = 0;
  std::int64_t unsent_since_us_ = -1;  ///< the first frame after the last time that none waited
  std::array<std::int64_t, 32> malformed_us_{};  ///< times of the last malformed frames, a ring
  std::uint64_t num_malformed_ = 0;
  std::uint64_t num_malformed_at_clear_ = 0;
};

}  // namespace can
