// SPDX-License-Identifier: BSD-3-Clause
// The door through which depth frames and inertial samples come in, whatever delivers them: heads
// over LCM (a simulator, a recording, a process that owns cameras), V4L2 cameras, serial heads.
#pragma once

#include <string>

#include "base/clock.h"
#include "tof/depth_frame.h"
#include "tof/gravity.h"

namespace sources {

/// Takes what a source delivers.
class FrameSink {
 public:
  virtual ~FrameSink() = default;
  virtual void on_imu(const tof::ImuSample& sample) = 0;
  /// The pixels are the source's and valid during the call.
  virtual void on_frame(const tof::DepthFrame& frame) = 0;
  /// A device begins to deliver (is_working), or is refused or lost: which and why, for a person.
  virtual void on_device(bool is_working, const std::string& text) = 0;
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Hands over what has arrived since the last call, inertial samples first, frames by their time.
  /// Never blocks for data or throws; a device that is gone is opened again when it is back.
  virtual void poll(const base::Now& now, FrameSink& sink) = 0;
};

}  // namespace sources
