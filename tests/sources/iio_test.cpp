// SPDX-License-Identifier: BSD-3-Clause
// The kernel's IIO for an inertial unit, on a fake tree: types and layout of records, set-up,
// values, a device that goes and comes back.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/rng.h"
#include "fake_iio.h"
#include "recording_sink.h"
#include "sources/iio_imu.h"

namespace sources {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The kernel's type texts, and texts that only look like them.
TEST(IioType, Texts) {
  EXPECT_EQ(parse_iio_type("le:s16/16>>0"), (IioType{false, true, 16, 2, 0}));
  EXPECT_EQ(parse_iio_type("be:s12/16>>4\n"), (IioType{true, true, 12, 2, 4}));
  EXPECT_EQ(parse_iio_type("le:u24/32>>8"), (IioType{false, false, 24, 4, 8}));
  EXPECT_EQ(parse_iio_type("le:s64/64>>0"), (IioType{false, true, 64, 8, 0}));
  for (const char* text :
       {"", "le", "le:", "xe:s16/16>>0", "le:f16/16>>0", "le:s16", "le:s16/16", "le:s16/16>>",
        "le:s16/16>>x", "le:s16/16>>0 ", "le:s17/16>>0", "le:s16/24>>0", "le:s0/16>>0",
        "le:s12/16>>5", "le:s-1/16>>0", "le:s16/16>>-1", "le:s16/16X3>>0", "LE:s16/16>>0",
        "le:s99999999999/16>>0"}) {
    EXPECT_EQ(parse_iio_type(text), std::nullopt) << text;
  }
}

// Any bytes under any type decode to what arithmetic on single bits says.
TEST(IioType, DecodesLikeBitByBit) {
  base::Rng rng(3);
  for (int round = 0; round < 20'000; ++round) {
    IioType type;
    type.num_bytes = 1 << rng.below(4);
    type.num_bits = 1 + static_cast<int>(rng.below(8U * type.num_bytes));
    type.shift = static_cast<int>(rng.below(8U * type.num_bytes - type.num_bits + 1U));
    type.is_signed = rng.below(2) == 1;
    type.is_big_endian = rng.below(2) == 1;
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(type.num_bytes));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(rng.below(256));
    std::uint64_t expected = 0;
    for (int bit = 0; bit < type.num_bits; ++bit) {
      const int at = bit + type.shift;
      const int byte = type.is_big_endian ? type.num_bytes - 1 - at / 8 : at / 8;
      const std::uint64_t is_set = (bytes[byte] >> (at % 8)) & 1U;
      expected |= is_set << bit;
      if (type.is_signed && bit == type.num_bits - 1 && is_set == 1)
        for (int above = bit + 1; above < 64; ++above) expected |= std::uint64_t{1} << above;
    }
    ASSERT_EQ(decode_iio(type, bytes), static_cast<std::int64_t>(expected));
  }
}

// Elements are aligned to their own size, records to the largest: the kernel's rule.
TEST(IioType, Layout) {
  const IioType s16{.num_bits = 16, .num_bytes = 2}, s32{.num_bits = 32, .num_bytes = 4};
  const IioType s64{.num_bits = 64, .num_bytes = 8}, s8{.num_bits = 8, .num_bytes = 1};
  const std::vector<IioType> imu{s16, s16, s16, s16, s16, s16, s64};
  std::vector<std::size_t> at(imu.size());
  EXPECT_EQ(lay_out_record(imu, at), 24U);
  EXPECT_THAT(at, ElementsAre(0, 2, 4, 6, 8, 10, 16));
  const std::vector<IioType> mixed{s8, s32, s8, s16};
  at.resize(mixed.size());
  EXPECT_EQ(lay_out_record(mixed, at), 12U);
  EXPECT_THAT(at, ElementsAre(0, 4, 8, 10));
  EXPECT_EQ(lay_out_record({}, {}), 0U);
}

class Iio : public ::testing::Test {
 protected:
  Iio() : device_(std::make_unique<FakeIio>(root_)) {
    params_.device = "iio:device0";
    params_.sysfs = device_->sysfs();
    params_.dev = device_->dev();
  }
  ~Iio() override {
    device_.reset();
    std::filesystem::remove_all(root_);
  }

  void poll() {
    if (!imu_) imu_ = std::make_unique<IioImu>(params_, ready_);
    imu_->poll(clock_.now(), sink_);
  }
  void wait(std::int64_t duration_us) {
    for (const std::int64_t end = clock_.monotonic_us + duration_us; clock_.monotonic_us < end;) {
      clock_.monotonic_us += 5'000;
      poll();
    }
  }
  /// A sample taken just now.
  void send(const std::array<std::int16_t, 6>& counts) {
    device_->send(counts, clock_.monotonic_us * 1000);
  }

  const std::filesystem::path root_ = "/tmp/ladder-iio-" + std::to_string(getpid());
  std::unique_ptr<FakeIio> device_;
  ImuParams params_;
  ReadySet ready_;
  TestClock clock_;
  RecordingSink sink_;
  std::unique_ptr<IioImu> imu_;
};

// What is written into the tree before the first sample: only the seven channels, the rate, the
// clock, the buffer on.
TEST_F(Iio, SetUp) {
  poll();
  for (const char* channel : {"in_accel_x", "in_accel_y", "in_accel_z", "in_anglvel_x",
                              "in_anglvel_y", "in_anglvel_z", "in_timestamp"}) {
    EXPECT_EQ(device_->get(std::string("scan_elements/") + channel + "_en"), "1") << channel;
  }
  EXPECT_EQ(device_->get("scan_elements/in_temp_en"), "0");
  EXPECT_EQ(device_->get("sampling_frequency"), "200");
  EXPECT_EQ(device_->get("current_timestamp_clock"), "monotonic");
  EXPECT_EQ(device_->get("buffer/length"), "64");
  EXPECT_EQ(device_->get("trigger/current_trigger"), "mpu6050-dev0");
  EXPECT_EQ(device_->get("buffer/enable"), "1");
  imu_.reset();
  EXPECT_EQ(device_->get("buffer/enable"), "0");
}

// Counts become m/s^2 and rad/s by offset and scale of their own axis or of all, turned into the
// body frame, in time since the epoch.
TEST_F(Iio, Values) {
  params_.q_body_imu = {0.7071067811865476, 0.0, 0.0, 0.7071067811865476};  // x of the unit = y
  device_->set("in_accel_scale", "0.01");
  device_->set("in_accel_z_scale", "0.02");
  device_->set("in_accel_z_offset", "-100");
  device_->set("in_anglvel_scale", "0.001");
  device_->set("in_anglvel_offset", "10");
  poll();
  send({100, -200, 600, 990, -10, 0});
  clock_.monotonic_us += 2'000;
  poll();
  ASSERT_EQ(sink_.samples.size(), 1U);
  const tof::ImuSample& sample = sink_.samples[0];
  EXPECT_EQ(sample.utime_us, clock_.utime_us() - 2'000);
  EXPECT_TRUE(sample.accelerometer_m_s2.isApprox(Eigen::Vector3d(2.0, 1.0, 10.0), 1e-12));
  EXPECT_TRUE(sample.gyroscope_rad_s.isApprox(Eigen::Vector3d(0.0, 1.0, 0.01), 1e-12));
  EXPECT_THAT(sink_.reports, ElementsAre("+ IMU (iio:device0) delivers"));
}

// Records that arrive in pieces or many at once all come out, in order and whole.
TEST_F(Iio, PiecesAndHeaps) {
  poll();
  for (int i = 0; i < 200; ++i) {
    clock_.monotonic_us += 5'000;
    send({static_cast<std::int16_t>(i), 0, 0, 0, 0, 0});
    if (i % 70 == 0) poll();
  }
  wait(50'000);
  ASSERT_EQ(sink_.samples.size(), 200U);
  for (int i = 0; i < 200; ++i)
    EXPECT_NEAR(sink_.samples[i].accelerometer_m_s2.x(), i * 0.000598, 1e-12);

  clock_.monotonic_us += 5'000;
  std::vector<std::uint8_t> record(24, 1);
  const std::int64_t stamp_ns = clock_.monotonic_us * 1000;
  for (std::size_t i = 0; i < 8; ++i)
    record[16 + i] = static_cast<std::uint8_t>((stamp_ns >> (8 * i)) & 0xFF);
  device_->send({record.begin(), record.begin() + 11});
  poll();
  EXPECT_EQ(sink_.samples.size(), 200U);
  device_->send({record.begin() + 11, record.end()});
  poll();
  EXPECT_EQ(sink_.samples.size(), 201U);
}

// A kernel that cannot change the clock stamps with the time since the epoch; that is taken as it
// is.
TEST_F(Iio, RealTimeStamps) {
  device_->remove("current_timestamp_clock");
  std::filesystem::create_directory(root_ / "devices/iio:device0/current_timestamp_clock");
  poll();
  device_->send({0, 0, 1, 0, 0, 0}, (clock_.utime_us() - 1'234) * 1000);
  poll();
  ASSERT_EQ(sink_.samples.size(), 1U);
  EXPECT_EQ(sink_.samples[0].utime_us, clock_.utime_us() - 1'234);
}

// Samples that are not newer than the last are counted and kept back.
TEST_F(Iio, StaleSamples) {
  poll();
  send({1, 0, 0, 0, 0, 0});
  send({2, 0, 0, 0, 0, 0});
  device_->send({3, 0, 0, 0, 0, 0}, (clock_.monotonic_us - 1'000) * 1000);
  poll();
  EXPECT_EQ(sink_.samples.size(), 1U);
  EXPECT_EQ(imu_->num_stale(), 2);
}

// By its name, among others, under any number.
TEST_F(Iio, FoundByName) {
  FakeIio other(root_, "iio:device3");
  other.set("name", "lsm6dsx");
  params_.device = "name:lsm6dsx";
  poll();
  EXPECT_EQ(other.get("buffer/enable"), "1");
  EXPECT_EQ(device_->get("buffer/enable"), "0");
}

// A trigger that the operator made is set to the rate and attached.
TEST_F(Iio, NamedTrigger) {
  const std::filesystem::path trigger = root_ / "devices/trigger1";
  std::filesystem::create_directories(trigger);
  device_->set("../trigger1/name", "clock200");
  device_->set("../trigger1/sampling_frequency", "100");
  params_.trigger = "clock200";
  poll();
  EXPECT_EQ(device_->get("../trigger1/sampling_frequency"), "200");
  EXPECT_EQ(device_->get("trigger/current_trigger"), "clock200");
}

// What a unit may lack, each refused in words; nothing delivers.
TEST_F(Iio, WhatMayBeMissing) {
  device_->set("in_accel_scale", "much");
  poll();
  EXPECT_THAT(sink_.last_report(), HasSubstr("has no scale for in_accel_x"));
  device_->set("in_accel_scale", "0.01");
  device_->set("scan_elements/in_anglvel_y_type", "le:s16/16X2>>0");
  wait(500'000);
  EXPECT_THAT(sink_.last_report(), HasSubstr("does not say how in_anglvel_y lies"));
  device_->remove("scan_elements/in_timestamp_en");
  device_->set("scan_elements/in_anglvel_y_type", "le:s16/16>>0");
  wait(2'000'000);
  EXPECT_THAT(sink_.last_report(), HasSubstr("has no channel in_timestamp"));
  std::filesystem::remove_all(root_ / "devices/iio:device0/scan_elements");
  wait(3'000'000);
  EXPECT_THAT(sink_.last_report(), HasSubstr("has no scan_elements"));
  device_->unplug();
  wait(3'000'000);
  EXPECT_THAT(sink_.last_report(), HasSubstr("is not among"));
  EXPECT_THAT(sink_.samples, IsEmpty());
}

// A unit that keeps a slower rate than asked says so. (A number that the kernel lets nobody change
// stands for the attribute.)
TEST_F(Iio, SlowerThanAsked) {
  device_->remove("sampling_frequency");
  std::filesystem::create_symlink("/proc/sys/kernel/cap_last_cap",
                                  root_ / "devices/iio:device0/sampling_frequency");
  poll();
  send({1, 0, 0, 0, 0, 0});
  poll();
  EXPECT_THAT(sink_.last_report(), HasSubstr("- IMU (iio:device0) delivers only 4"));
  EXPECT_EQ(sink_.samples.size(), 1U);
}

// Gone while it runs: said once; back again under another number it is set up anew.
TEST_F(Iio, GoneAndBack) {
  params_.device = "name:mpu6050";
  poll();
  send({1, 0, 0, 0, 0, 0});
  wait(10'000);
  device_->unplug();
  wait(5'000'000);
  ASSERT_EQ(sink_.reports.size(), 3U);
  EXPECT_THAT(sink_.reports[1], HasSubstr("is gone"));
  EXPECT_THAT(sink_.reports[2], HasSubstr("is not among"));
  device_ = std::make_unique<FakeIio>(root_, "iio:device5");
  wait(2'100'000);
  EXPECT_EQ(device_->get("buffer/enable"), "1");
  send({2, 0, 0, 0, 0, 0});
  poll();
  EXPECT_EQ(sink_.samples.size(), 2U);
  EXPECT_THAT(sink_.last_report(), HasSubstr("delivers"));
}

// A unit that sends nothing (no trigger fires) is set up anew and said once.
TEST_F(Iio, Silent) {
  wait(10'000'000);
  EXPECT_THAT(sink_.reports, ElementsAre("- IMU (iio:device0) has sent nothing for 2 s"));
  send({1, 0, 0, 0, 0, 0});
  wait(2'500'000);
  EXPECT_EQ(sink_.samples.size(), 1U);
}

}  // namespace
}  // namespace sources
