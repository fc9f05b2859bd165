// SPDX-License-Identifier: BSD-3-Clause
// Head frames and inertial samples from LCM: a simulator, a recording, or a process that owns the
// cameras.
#pragma once

#include <array>

#include "runtime/bus.h"
#include "sources/frame_source.h"

namespace sensor_service {

class LcmSource final : public sources::FrameSource {
 public:
  explicit LcmSource(runtime::Bus& bus);
  void poll(const base::Now& now, sources::FrameSink& sink) override;

 private:
  std::array<runtime::Mailbox<ladder_msgs::tof_frame_t>*, tof::kNumHeads> frames_{};
  runtime::Queue<ladder_msgs::imu_t>& samples_;
};

}  // namespace sensor_service
