// SPDX-License-Identifier: BSD-3-Clause
// An inertial unit as the kernel's IIO shows it: a tree of attribute files and a FIFO for its
// buffer. The order of channels is a real one's (mpu6050: accelerometer, gyroscope, time stamp).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace sources {

class FakeIio {
 public:
  /// Makes root/devices and root/dev. Types: le:s16/16>>0, time stamp le:s64/64>>0.
  explicit FakeIio(const std::filesystem::path& root, const std::string& device = "iio:device0");
  ~FakeIio();
  FakeIio(const FakeIio&) = delete;
  FakeIio& operator=(const FakeIio&) = delete;

  std::string sysfs() const { return root_ / "devices"; }
  std::string dev() const { return root_ / "dev"; }

  void set(const std::string& attribute, const std::string& value) const;
  std::string get(const std::string& attribute) const;
  void remove(const std::string& attribute) const;

  /// One record of the layout above; counts are accelerometer and gyroscope.
  void send(const std::array<std::int16_t, 6>& counts, std::int64_t stamp_ns) const;
  void send(const std::vector<std::uint8_t>& bytes) const;

  /// The device is pulled out: its buffer ends, its folder goes.
  void unplug();

 private:
  std::filesystem::path root_, folder_, fifo_;
  int writer_ = -1;
};

}  // namespace sources
