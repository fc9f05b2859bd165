// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_service/lcm_source.h"

#include <algorithm>
#include <tuple>

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
  int num_arrived = 0;
  for (auto* mailbox : frames_) {
    if (const ladder_msgs::tof_frame_t* frame = mailbox->take(now.utime_us)) {
      arrived[num_arrived++] = frame;
    }
  }
  std::sort(arrived.begin(), arrived.begin() + num_arrived, [](const auto* a, const auto* b) {
    return std::tie(a->utime, a->head) < std::tie(b->utime, b->head);
  });
  for (int i = 0; i < num_arrived; ++i) sink.on_frame(to_depth_frame(*arrived[i]));
}

}  // namespace sensor_service
