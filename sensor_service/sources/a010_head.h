// SPDX-License-Identifier: BSD-3-Clause
// The talk with one MaixSense A010: silence it, set it up by AT commands, let it send, take images
// out of what it sends. Time is handed in; nothing waits.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sources/a010_frame.h"
#include "sources/params.h"
#include "sources/serial_line.h"

namespace sources {

/// What goes with an image besides its pixels.
struct A010Stamp {
  std::int64_t begun_us = 0;  ///< its first byte was seen, CLOCK_MONOTONIC
  int number = 0;             ///< 0..4095, then again from 0
  int sensor_temperature = 0, driver_temperature = 0;
};

class A010Head {
 public:
  A010Head(const A010Params& params, int frames_per_s);

  /// "" and the talk has begun, or what failed.
  std::string open(const std::string& device, std::int64_t now_us);
  void close() { line_.close(); }
  bool is_open() const { return line_.is_open(); }
  int fd() const { return line_.fd(); }

  /// Reads and answers what has arrived. "" or why the unit was given up; it is closed then.
  std::string work(std::int64_t now_us);

  /// Whether an image has come since the last call, the newest if several: depth_mm() holds it.
  bool take(A010Stamp& stamp);

  /// Row by row from the upper left, side_px() each way.
  std::span<const std::int16_t> depth_mm() const { return depth_mm_; }
  int side_px() const { return A010Parser::kLargestSide_px / params_.binning; }
  const A010Parser& parser() const { return parser_; }

 private:
  void send(int index, std::int64_t now_us);
  std::string talk(std::int64_t now_us);
  std::string listen(std::int64_t now_us);
  void keep(const A010Frame& frame);
  bool read_answer();

  A010Params params_;
  std::vector<std::string> commands_;
  SerialLine line_;
  A010Parser parser_;
  int command_ = 0;  ///< whose answer is awaited; the last has none: images follow
  int num_attempts_ = 0;
  std::uint32_t last_bytes_ = 0;  ///< of the answer, the newest lowest
  std::int64_t sent_us_ = 0;
  std::int64_t last_frame_us_ = 0;
  std::int64_t begun_us_ = 0;  ///< the packet that is arriving
  bool has_image_ = false;
  A010Stamp stamp_;
  std::vector<std::int16_t> depth_mm_;
};

}  // namespace sources
