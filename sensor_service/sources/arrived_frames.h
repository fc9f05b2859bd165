// SPDX-License-Identifier: BSD-3-Clause
// The frames that one poll of several heads brought, handed over by their time.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "base/check.h"
#include "sources/frame_source.h"

namespace sources {

class ArrivedFrames {
 public:
  /// At most one per head.
  void add(const tof::DepthFrame& frame) {
    CHECK(num_frames_ < frames_.size(), "more frames than heads");
    std::size_t at = num_frames_++;
    for (; at > 0 && frames_[at - 1]->utime_us > frame.utime_us; --at)
      frames_[at] = frames_[at - 1];
    frames_[at] = &frame;
  }

  void hand_to(FrameSink& sink) const {
    for (std::size_t i = 0; i < num_frames_; ++i) sink.on_frame(*frames_[i]);
  }

 private:
  std::array<const tof::DepthFrame*, tof::kNumHeads> frames_{};
  std::size_t num_frames_ = 0;
};

/// How a head is called in front of what is said of it.
inline std::string name_of_head(int head, const std::string& device) {
  return "head " + std::to_string(head) + " (" + device + ") ";
}

}  // namespace sources
