// SPDX-License-Identifier: BSD-3-Clause
// The door through which depth frames and inertial samples come in, whatever delivers them:
// recorded or simulated heads over LCM today, cameras later.
#pragma once

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
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// Hands over what has arrived since the last call, inertial samples first, frames by their time.
  /// Never blocks or throws.
  virtual void poll(const base::Now& now, FrameSink& sink) = 0;
};

}  // namespace sources
