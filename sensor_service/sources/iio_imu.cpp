// SPDX-License-Identifier: BSD-3-Clause
#include "sources/iio_imu.h"

#include <cmath>

#include "sources/device_time.h"

namespace sources {

IioImu::IioImu(const ImuParams& params, ReadySet& ready)
    : params_(params),
      ready_(ready),
      device_(params),
      R_body_imu_(params.q_body_imu.normalized().toRotationMatrix()) {}

void IioImu::poll(const base::Now& now, FrameSink& sink) {
  if (!device_.is_open()) {
    if (reopening_.is_due(now.monotonic_us)) open(now, sink);
    if (!device_.is_open()) return;
  }
  const std::size_t num_records = device_.read(records_);
  for (std::size_t i = 0; i < num_records; ++i) hand_over(records_[i], now, sink);
  if (!device_.is_open()) {
    lose("is gone", now, sink);
  } else if (now.monotonic_us - last_record_us_ > kSilenceUs) {
    device_.close();
    lose("has sent nothing for 2 s", now, sink);
  }
}

void IioImu::open(const base::Now& now, FrameSink& sink) {
  const std::string problem = device_.open();
  if (!problem.empty()) {
    lose(problem, now, sink);
    return;
  }
  ready_.add(device_.fd());
  is_first_ = true;
  last_record_us_ = now.monotonic_us;
}

void IioImu::hand_over(const IioRecord& record, const base::Now& now, FrameSink& sink) {
  last_record_us_ = now.monotonic_us;
  if (is_first_) {
    is_first_ = false;
    reopening_.succeeded();
    const double rate = device_.samples_per_s();
    const bool is_slow = rate > 0.0 && rate < 0.9 * params_.samples_per_s;
    sink.on_device(
        !is_slow, "IMU (" + params_.device + ") delivers" +
                      (is_slow ? " only " + std::to_string(std::lround(rate)) + " samples/s" : ""));
  }
  const std::int64_t utime_us = device_.is_monotonic() ? utime_of_monotonic_us(record.stamp_us, now)
                                                       : utime_of_epoch_us(record.stamp_us, now);
  // Within a second it is disorder; farther back somebody has set the clock.
  if (utime_us <= last_utime_us_ && last_utime_us_ - utime_us < 1'000'000) {
    ++num_stale_;
    return;
  }
  last_utime_us_ = utime_us;
  sink.on_imu(
      {.utime_us = utime_us,
       .accelerometer_m_s2 = R_body_imu_ * Eigen::Vector3d(record.accelerometer_m_s2.data()),
       .gyroscope_rad_s = R_body_imu_ * Eigen::Vector3d(record.gyroscope_rad_s.data())});
}

void IioImu::lose(const std::string& problem, const base::Now& now, FrameSink& sink) {
  if (reopening_.failed(now.monotonic_us, problem))
    sink.on_device(false, "IMU (" + params_.device + ") " + problem);
}

}  // namespace sources
