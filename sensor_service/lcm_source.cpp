// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_service/lcm_source.h"

#include <algorithm>

#include "sensor_service/convert.h"

namespace sensor_service {
namespace {

constexpr std::size_t kMaxWaitingSamples = 256;  // more than a second of a 200 Hz unit

}  // namespace

LcmSource::LcmSource(runtime::Bus& bus)
    : samples_(bus.queue(runtime::channels::kImu, kMaxWaitingSamples)) {
  for (int head = 0; head < tof::kNumHeads; ++head) {
    frames_[head] = &bus.newest(runtime::channels::kTof[head]);
  }
}

void LcmSource::poll(const base::Now& now, sources::FrameSink& sink) {
  while (const ladder_msgs::imu_t* sample = samples_.take(now.utime_us)) {
    sink.on_imu(to_imu_sample(*sample));
  }
  std::array<const ladder_msgs::tof_frame_t*, tof::kNumHeads> arrived{};
  for (int head = 0; head < tof::kNumHeads; ++head)
    arrived[head] = frames_[head]->take(now.utime_us);
  std::stable_sort(arrived.begin(), arrived.end(), [](const auto* a, const auto* b) {
    return a != nullptr && (b == nullptr || a->utime < b->utime);
  });
  for (const ladder_msgs::tof_frame_t* frame : arrived) {
    if (frame != nullptr) sink.on_frame(to_depth_frame(*frame));
  }
}

}  // namespace sensor_service
