// SPDX-License-Identifier: BSD-3-Clause
// An inertial unit under the kernel's IIO: six channels and a time stamp, set up through sysfs and
// read as records from its buffer. Units are IIO's: m/s^2 and rad/s, in the unit's own axes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sources/iio_channel.h"
#include "sources/params.h"

namespace sources {

/// One record in the unit's own axes.
struct IioRecord {
  std::array<double, 3> accelerometer_m_s2{};
  std::array<double, 3> gyroscope_rad_s{};
  std::int64_t stamp_us = 0;
};

class IioDevice {
 public:
  explicit IioDevice(const ImuParams& params);
  ~IioDevice();
  IioDevice(const IioDevice&) = delete;
  IioDevice& operator=(const IioDevice&) = delete;

  /// "" and the buffer fills, or what is missing.
  std::string open();
  void close();
  bool is_open() const { return fd_ >= 0; }
  int fd() const { return fd_; }

  /// Records that have arrived, the oldest first, as many as fit. Lost (see is_open()) when the
  /// device is gone.
  std::size_t read(std::span<IioRecord> records);

  /// Stamps are of CLOCK_MONOTONIC, else of the time since the epoch.
  bool is_monotonic() const { return is_monotonic_; }
  /// What the device chose, 0 = it does not say.
  double samples_per_s() const { return samples_per_s_; }

 private:
  static constexpr std::size_t kNumChannels = 7;  ///< three, three and the time stamp

  struct Channel {
    IioType type;
    int index = 0;
    double offset = 0.0, scale = 1.0;
    std::size_t at = 0;  ///< in the record
  };

  std::string find();
  std::string choose_channels();
  std::string read_channel(std::size_t channel);
  double shared_number(std::size_t channel, const std::string& what, double otherwise) const;
  void lay_out();
  void set_rate_and_trigger();
  std::string start();
  void decode(std::span<const std::uint8_t> bytes, IioRecord& record) const;

  ImuParams params_;
  std::string folder_;   ///< of the device in sysfs
  std::string special_;  ///< its buffer
  int fd_ = -1;
  bool is_monotonic_ = false;
  double samples_per_s_ = 0.0;
  std::array<Channel, kNumChannels> channels_{};
  std::size_t record_bytes_ = 0;
  std::vector<std::uint8_t> bytes_;  ///< read and not decoded yet
  std::size_t num_bytes_ = 0;
};

}  // namespace sources
