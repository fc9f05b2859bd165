// SPDX-License-Identifier: BSD-3-Clause
// The inertial unit of the robot through the kernel's IIO: turned into the body frame, in time
// since the epoch, opened again when it was gone.
#pragma once

#include <array>

#include "sources/frame_source.h"
#include "sources/iio_device.h"
#include "sources/params.h"
#include "sources/ready_set.h"
#include "sources/reopening.h"

namespace sources {

class IioImu final : public FrameSource {
 public:
  /// A unit that delivers nothing for so long is set up anew.
  static constexpr std::int64_t kSilenceUs = 2'000'000;

  /// `ready` outlives the source.
  IioImu(const ImuParams& params, ReadySet& ready);

  void poll(const base::Now& now, FrameSink& sink) override;

  /// Records that were not newer than the one before: not passed on.
  std::int64_t num_stale() const { return num_stale_; }

 private:
  void open(const base::Now& now, FrameSink& sink);
  void hand_over(const IioRecord& record, const base::Now& now, FrameSink& sink);
  void lose(const std::string& problem, const base::Now& now, FrameSink& sink);

  ImuParams params_;
  ReadySet& ready_;
  IioDevice device_;
  Reopening reopening_;
  Eigen::Matrix3d R_body_imu_;
  std::array<IioRecord, 64> records_{};
  bool is_first_ = true;  ///< since the device was opened
  std::int64_t last_record_us_ = 0;
  std::int64_t last_utime_us_ = 0;
  std::int64_t num_stale_ = 0;
};

}  // namespace sources
