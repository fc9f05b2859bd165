// SPDX-License-Identifier: BSD-3-Clause
// Up to four MaixSense A010 on serial lines as heads.
#pragma once

#include <memory>
#include <vector>

#include "sources/a010_head.h"
#include "sources/frame_source.h"
#include "sources/params.h"
#include "sources/ready_set.h"
#include "sources/reopening.h"

namespace sources {

class A010Source final : public FrameSource {
 public:
  /// `ready` outlives the source.
  A010Source(const SourceParams& params, ReadySet& ready);

  void poll(const base::Now& now, FrameSink& sink) override;

 private:
  struct Head {
    std::string device;
    std::unique_ptr<A010Head> unit;
    Reopening reopening;
    tof::DepthFrame frame;
    A010Stamp stamp;
    bool is_first = true;  ///< since the device was opened
  };

  void work(Head& head, const base::Now& now, FrameSink& sink);
  bool take(Head& head, const base::Now& now, FrameSink& sink);

  ReadySet& ready_;
  std::vector<Head> heads_;
};

}  // namespace sources
