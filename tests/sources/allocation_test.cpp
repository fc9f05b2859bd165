// SPDX-License-Identifier: BSD-3-Clause
// A step of a source that runs allocates nothing. Own program: it counts what operator new is asked
// for.
#include <gtest/gtest.h>
#include <unistd.h>

#include "fake_a010.h"
#include "fake_iio.h"
#include "recorded_cameras.h"
#include "recording_sink.h"
#include "sources/a010_source.h"
#include "sources/iio_imu.h"
#include "sources/v4l2_source.h"
#include "tests/support/allocation_counter.h"

namespace sources {
namespace {

/// Counts only: the tests' other sink keeps frames, which allocates.
struct CountingSink final : FrameSink {
  void on_imu(const tof::ImuSample& /*sample*/) override { ++num_samples; }
  void on_frame(const tof::DepthFrame& /*frame*/) override { ++num_frames; }
  void on_device(bool /*is_working*/, const std::string& /*text*/) override {}
  int num_samples = 0, num_frames = 0;
};

class Allocation : public ::testing::Test {
 protected:
  /// Bytes that one step asks for.
  std::size_t bytes_of_step(FrameSource& source) {
    clock_.monotonic_us += 5'000;
    const std::size_t before = test_support::allocated_bytes();
    source.poll(clock_.now(), sink_);
    return test_support::allocated_bytes() - before;
  }

  ReadySet ready_;
  TestClock clock_;
  CountingSink sink_;
};

// The counter works, or the tests below would prove nothing.
TEST(Counter, Counts) {
  static std::vector<int> kept;  // static: a compiler may leave out an allocation nobody sees
  const std::size_t before = test_support::allocated_bytes();
  kept.resize(10);
  EXPECT_GT(test_support::allocated_bytes(), before + kept.size());
}

// Four cameras at once. The double gives memory back only (its queues were filled beforehand).
TEST_F(Allocation, NonePerV4l2Frame) {
  RecordedCameras cameras;
  SourceParams params;
  params.v4l2.width_px = 8;
  params.v4l2.height_px = 6;
  for (int head = 0; head < 4; ++head) {
    params.heads[head].device = "/dev/video" + std::to_string(head);
    RecordedCamera& camera = cameras.at(params.heads[head].device);
    camera.keeps_calls = false;
    for (std::uint32_t i = 0; i < 600; ++i) {  // four are taken in a step
      camera.waiting.push_back({.counts = std::vector<std::uint16_t>(48, 1000), .sequence = i});
    }
  }
  V4l2Source source(params, ready_, cameras);
  for (int i = 0; i < 5; ++i) bytes_of_step(source);
  const int before = sink_.num_frames;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(bytes_of_step(source), 0U) << i;
  EXPECT_EQ(sink_.num_frames - before, 400);
}

// Images of the largest size.
TEST_F(Allocation, NonePerA010Image) {
  FakeA010 unit;
  SourceParams params;
  params.heads[0].device = unit.path();
  A010Source source(params, ready_);
  for (int i = 0; i < 100; ++i) {
    bytes_of_step(source);
    unit.work();
  }
  const std::vector<std::uint8_t> image =
      a010_packet(std::vector<std::uint8_t>(10'000, 51), 100, 1);
  for (int i = 0; i < 400; ++i) {  // a terminal holds 4 kB
    const auto begin = image.begin() + i % 4 * 2600;
    unit.send({begin, i % 4 == 3 ? image.end() : begin + 2600});
    const std::size_t num_bytes = bytes_of_step(source);
    if (i >= 8) {
      EXPECT_EQ(num_bytes, 0U) << i;
    }
  }
  EXPECT_EQ(sink_.num_frames, 100);
}

// A thousand samples.
TEST_F(Allocation, NonePerInertialSample) {
  const std::filesystem::path root = "/tmp/ladder-iio-bytes-" + std::to_string(getpid());
  {
    FakeIio device(root);
    ImuParams params;
    params.device = "iio:device0";
    params.sysfs = device.sysfs();
    params.dev = device.dev();
    IioImu source(params, ready_);
    bytes_of_step(source);
    for (int i = 0; i < 1000; ++i) {
      device.send({0, 0, 16'384, 0, 0, 0}, clock_.monotonic_us * 1000);
      const std::size_t num_bytes = bytes_of_step(source);
      if (i > 0) {
        EXPECT_EQ(num_bytes, 0U) << i;
      }
    }
    EXPECT_EQ(sink_.num_samples, 1000);
  }
  std::filesystem::remove_all(root);
}

}  // namespace
}  // namespace sources
