// SPDX-License-Identifier: BSD-3-Clause
// Up to four 16-bit depth cameras of the kernel as heads.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "sources/frame_source.h"
#include "sources/params.h"
#include "sources/ready_set.h"
#include "sources/reopening.h"
#include "sources/v4l2_camera.h"

namespace sources {

class V4l2Source final : public FrameSource {
 public:
  /// A head that delivers nothing for so long is opened again.
  static constexpr std::int64_t kSilenceUs = 3'000'000;

  /// `ready` and `calls` outlive the source.
  V4l2Source(const SourceParams& params, ReadySet& ready, VideoCalls& calls);

  void poll(const base::Now& now, FrameSink& sink) override;

 private:
  struct Head {
    std::string device;
    std::unique_ptr<V4l2Camera> camera;
    Reopening reopening;
    std::vector<std::int16_t> depth_mm;
    tof::DepthFrame frame;
    FrameStamp stamp;
    bool is_first = true;  ///< since the device was opened
    std::int64_t last_frame_us = 0;
  };

  void open(Head& head, const base::Now& now, FrameSink& sink);
  bool take(Head& head, const base::Now& now, FrameSink& sink);
  void lose(Head& head, const std::string& problem, const base::Now& now, FrameSink& sink);

  ReadySet& ready_;
  std::vector<Head> heads_;
};

}  // namespace sources
