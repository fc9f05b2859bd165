// SPDX-License-Identifier: BSD-3-Clause
// Keeps what a source delivers, and a clock that tests turn by hand.
#pragma once

#include <string>
#include <vector>

#include "sources/frame_source.h"

namespace sources {

struct RecordingSink final : FrameSink {
  struct Frame {
    tof::DepthFrame frame;  ///< its depth_mm is no longer valid
    std::vector<std::int16_t> depth_mm;
  };

  void on_imu(const tof::ImuSample& sample) override { samples.push_back(sample); }
  void on_frame(const tof::DepthFrame& frame) override {
    frames.push_back({frame, {frame.depth_mm.begin(), frame.depth_mm.end()}});
  }
  void on_device(bool is_working, const std::string& text) override {
    reports.push_back((is_working ? "+ " : "- ") + text);
  }

  /// The newest report, "" when there was none.
  std::string last_report() const { return reports.empty() ? "" : reports.back(); }

  std::vector<tof::ImuSample> samples;
  std::vector<Frame> frames;
  std::vector<std::string> reports;
};

/// Both clocks at a fixed distance.
struct TestClock {
  static constexpr std::int64_t kEpochUs = 1'700'000'000'000'000;

  base::Now now() const { return {.monotonic_us = monotonic_us, .utime_us = utime_us()}; }
  std::int64_t utime_us() const { return kEpochUs + monotonic_us; }

  std::int64_t monotonic_us = 50'000'000;
};

}  // namespace sources
