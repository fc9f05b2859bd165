// SPDX-License-Identifier: BSD-3-Clause
#include "sources/make_sources.h"

#include "sources/a010_source.h"
#include "sources/iio_imu.h"
#include "sources/v4l2_source.h"

namespace sources {

std::vector<std::unique_ptr<FrameSource>> make_device_sources(const SourceParams& params,
                                                              ReadySet& ready) {
  static KernelVideoCalls kernel;
  std::vector<std::unique_ptr<FrameSource>> made;
  if (params.kind == Kind::kLcm) return made;
  if (!params.imu.device.empty()) made.push_back(std::make_unique<IioImu>(params.imu, ready));
  if (params.kind == Kind::kV4l2) {
    made.push_back(std::make_unique<V4l2Source>(params, ready, kernel));
  } else {
    made.push_back(std::make_unique<A010Source>(params, ready));
  }
  return made;
}

}  // namespace sources
