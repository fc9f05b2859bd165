// SPDX-License-Identifier: BSD-3-Clause
// Cameras of the kernel as depth heads: vivid (a camera that can be pulled out) and v4l2loopback
// (fed with depth images of our own), and the whole sensor_service on one of them.
#include "sources/v4l2_source.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/bus.h"
#include "runtime/clock.h"
#include "tests/hardware/video_devices.h"
#include "tests/sources/recording_sink.h"
#include "tests/support/child_process.h"

namespace {

using hardware::LoopbackFeed;
using sources::HeadParams;
using sources::PixelFormat;
using sources::RecordingSink;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

const std::string kLoopback = "/dev/video20";

/// A rung of 28 mm before a wall, a shelf and a hole: what a head sees, in millimetres. The first
/// pixel carries the image's number.
std::vector<std::uint16_t> depth_image(int width_px, int height_px, int number) {
  std::vector<std::uint16_t> counts;
  for (int row = 0; row < height_px; ++row) {
    for (int column = 0; column < width_px; ++column) {
      const bool is_rung = row % 12 < 2;
      const bool is_hole = column < 3 && row > 5;
      counts.push_back(static_cast<std::uint16_t>(is_hole   ? 0
                                                  : is_rung ? 900 + column
                                                            : 1500 + 3 * row));
    }
  }
  counts[0] = static_cast<std::uint16_t>(1000 + number);
  return counts;
}

class V4l2OnKernel : public ::testing::Test {
 protected:
  void start(const std::vector<std::string>& devices, int width_px, int height_px) {
    params_.kind = sources::Kind::kV4l2;
    params_.camera.frames_per_s = 10;
    params_.v4l2.format = PixelFormat::kY16;
    params_.v4l2.width_px = width_px;
    params_.v4l2.height_px = height_px;
    for (std::size_t head = 0; head < devices.size(); ++head)
      params_.heads[head] = {.device = devices[head], .intrinsics = {60.0, 60.0, 31.5, 23.5}};
    source_ = std::make_unique<sources::V4l2Source>(params_, ready_, calls_);
  }

  /// Polls as the service does until the condition holds.
  bool wait_for(const std::function<bool()>& condition, std::chrono::milliseconds timeout = 30s) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      source_->poll(runtime::clock_now(), sink_);
      std::this_thread::sleep_for(5ms);
    }
    return true;
  }
  bool wait_for_frames(std::size_t num_more) {
    const std::size_t wanted = sink_.frames.size() + num_more;
    return wait_for([this, wanted] { return sink_.frames.size() >= wanted; });
  }

  sources::SourceParams params_;
  sources::ReadySet ready_;
  sources::KernelVideoCalls calls_;
  RecordingSink sink_;
  std::unique_ptr<sources::V4l2Source> source_;
};

/// The path of the camera on this bus that offers Y16.
std::string path_of(const std::string& bus) {
  for (const auto& entry : std::filesystem::directory_iterator("/dev")) {
    const std::string path = entry.path();
    if (!path.starts_with("/dev/video")) continue;
    const int fd = open(path.c_str(), O_RDWR | O_CLOEXEC);
    v4l2_capability capability{};
    const bool is_it = ioctl(fd, VIDIOC_QUERYCAP, &capability) == 0 &&
                       bus == reinterpret_cast<const char*>(capability.bus_info) &&
                       (capability.device_caps & V4L2_CAP_VIDEO_CAPTURE) != 0;
    close(fd);
    if (is_it) return path;
  }
  ADD_FAILURE() << "no camera on " << bus;
  return "";
}

constexpr int kVividWidth = 320, kVividHeight = 180;
const std::string kVivid = "platform:vivid-000";

/// A still picture, without the running text that vivid writes into it.
void show(const std::string& pattern_path, int pattern) {
  const int fd = open(pattern_path.c_str(), O_RDWR | O_CLOEXEC);
  hardware::set_control(fd, "Test Pattern", pattern);
  hardware::set_control(fd, "OSD Text Mode", 2);
  close(fd);
}

// Every pixel of vivid's 16-bit pictures (colour bars, white, black) arrives as read(2) gives it,
// times the unit; stamps are the kernel's, near now and rising; numbers rise.
TEST_F(V4l2OnKernel, VividValues) {
  const std::string path = path_of(kVivid);
  params_.v4l2.depth_unit_um = 250;
  for (const int pattern : {0, 6, 7}) {
    show(path, pattern);
    const std::vector<std::uint16_t> expected =
        hardware::read_image(path, kVividWidth, kVividHeight);
    sink_ = {};
    start({"bus:" + kVivid}, kVividWidth, kVividHeight);
    ASSERT_TRUE(wait_for_frames(3)) << sink_.last_report();
    const RecordingSink::Frame& newest = sink_.frames.back();
    ASSERT_EQ(newest.depth_mm.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
      ASSERT_EQ(newest.depth_mm[i], (expected[i] * 250 + 500) / 1000) << pattern << " " << i;
    if (pattern == 0) {
      EXPECT_NE(expected.front(), expected[kVividWidth - 1]);  // bars
    }
    for (std::size_t i = 1; i < sink_.frames.size(); ++i) {
      EXPECT_GT(sink_.frames[i].frame.utime_us, sink_.frames[i - 1].frame.utime_us);
      EXPECT_GT(sink_.frames[i].frame.seq, sink_.frames[i - 1].frame.seq);
    }
    EXPECT_LT(std::abs(runtime::clock_now().utime_us - newest.frame.utime_us), 5'000'000);
    source_.reset();
  }
}

// A size and a format that vivid does not have are refused with its list.
TEST_F(V4l2OnKernel, VividRefusals) {
  start({"bus:" + kVivid}, 224, 171);
  ASSERT_TRUE(wait_for([this] { return !sink_.reports.empty(); }));
  EXPECT_THAT(sink_.last_report(), HasSubstr("does not deliver Y16 224x171"));
  EXPECT_THAT(sink_.last_report(), HasSubstr("320x180"));
  sink_ = {};
  params_.v4l2.format = PixelFormat::kZ16;
  start({path_of(kVivid)}, kVividWidth, kVividHeight);
  params_.v4l2.format = PixelFormat::kZ16;
  source_ = std::make_unique<sources::V4l2Source>(params_, ready_, calls_);
  ASSERT_TRUE(wait_for([this] { return !sink_.reports.empty(); }));
  EXPECT_THAT(sink_.last_report(), HasSubstr("does not deliver Z16 320x180"));
  EXPECT_THAT(sink_.last_report(), HasSubstr("Y16"));
}

// Pulled out while it streams and put back, five times: each time said, each time it delivers
// again; nothing is delivered meanwhile.
TEST_F(V4l2OnKernel, VividRemovedAndReturned) {
  const std::string driver = "/sys/bus/platform/drivers/vivid/";
  start({"bus:" + kVivid}, kVividWidth, kVividHeight);
  ASSERT_TRUE(wait_for_frames(2)) << sink_.last_report();
  for (int round = 0; round < 5; ++round) {
    const std::size_t num_reports = sink_.reports.size();
    std::ofstream(driver + "unbind") << "vivid.0" << std::flush;
    const auto gone_at = std::chrono::steady_clock::now();
    ASSERT_TRUE(wait_for([&] { return sink_.reports.size() > num_reports; }));
    std::printf("removed: noticed after %lld ms: %s\n",
                static_cast<long long>((std::chrono::steady_clock::now() - gone_at) / 1ms),
                sink_.last_report().c_str());
    EXPECT_THAT(sink_.reports[num_reports], HasSubstr("- head 0"));
    const std::size_t num_frames = sink_.frames.size();
    wait_for([] { return false; }, 1s);
    EXPECT_EQ(sink_.frames.size(), num_frames);

    std::ofstream(driver + "bind") << "vivid.0" << std::flush;
    const auto back_at = std::chrono::steady_clock::now();
    ASSERT_TRUE(wait_for_frames(2)) << sink_.last_report();
    std::printf("returned: delivers after %lld ms\n",
                static_cast<long long>((std::chrono::steady_clock::now() - back_at) / 1ms));
    EXPECT_THAT(sink_.last_report(), HasSubstr("delivers"));
  }
  for (std::size_t i = 1; i < sink_.frames.size(); ++i)
    EXPECT_GT(sink_.frames[i].frame.seq, sink_.frames[i - 1].frame.seq);
}

// Four cameras, one per head, told apart by their bus.
TEST_F(V4l2OnKernel, FourCameras) {
  ASSERT_EQ(std::system("modprobe -r vivid && modprobe vivid n_devs=4 "
                        "node_types=0x1,0x1,0x1,0x1"),
            0);
  std::vector<std::string> devices;
  for (int head = 0; head < 4; ++head)
    devices.push_back("bus:platform:vivid-00" + std::to_string(head));
  for (int head = 0; head < 4; ++head)
    show(path_of(devices[head].substr(4)), head % 2 == 0 ? 6 : 7);
  start(devices, kVividWidth, kVividHeight);
  std::array<int, 4> num_frames{};
  EXPECT_TRUE(wait_for(
      [&] {
        num_frames = {};
        for (const auto& frame : sink_.frames) ++num_frames[frame.frame.head];
        return *std::min_element(num_frames.begin(), num_frames.end()) >= 3;
      },
      60s))
      << sink_.last_report();
  std::array<std::int16_t, 4> middle_mm{};
  for (const auto& frame : sink_.frames)
    middle_mm[frame.frame.head] = frame.depth_mm[kVividWidth * kVividHeight / 2];
  EXPECT_EQ(middle_mm[0], middle_mm[2]);
  EXPECT_EQ(middle_mm[1], middle_mm[3]);
  EXPECT_NE(middle_mm[0], middle_mm[1]);
  source_.reset();
}

// Depth images of our own come through a v4l2loopback pixel by pixel; when their sender goes and
// another comes, they come again.
TEST_F(V4l2OnKernel, LoopbackValues) {
  constexpr int kWidth = 64, kHeight = 48;
  auto feed = std::make_unique<LoopbackFeed>(kLoopback, kWidth, kHeight);
  feed->write(depth_image(kWidth, kHeight, 0));
  start({"name:ladder-depth"}, kWidth, kHeight);
  int number = 1, num_checked = 0;
  const auto send_and_check = [&](int num_images) {
    for (int i = 0; i < num_images; ++i, ++number) {
      feed->write(depth_image(kWidth, kHeight, number));
      wait_for([] { return false; }, 50ms);
    }
    wait_for([] { return false; }, 1s);
    for (const RecordingSink::Frame& frame : sink_.frames) {
      const std::vector<std::uint16_t> sent =
          depth_image(kWidth, kHeight, frame.depth_mm[0] - 1000);
      EXPECT_TRUE(
          std::equal(sent.begin(), sent.end(), frame.depth_mm.begin(), frame.depth_mm.end()));
      ++num_checked;
    }
    sink_.frames.clear();
  };
  send_and_check(20);
  EXPECT_GE(num_checked, 15) << sink_.last_report();
  feed.reset();
  wait_for([] { return false; }, 4s);
  feed = std::make_unique<LoopbackFeed>(kLoopback, kWidth, kHeight);
  num_checked = 0;
  for (int i = 0; i < 10 && num_checked < 3; ++i) send_and_check(20);
  EXPECT_GE(num_checked, 3) << sink_.last_report();
  for (const std::string& report : sink_.reports) std::printf("%s\n", report.c_str());
}

// The real sensor_service on such a camera: LADDER_TOF_0 as it was fed, and clouds of the wall.
TEST_F(V4l2OnKernel, ServiceMakesClouds) {
  constexpr int kWidth = 64, kHeight = 48;
  const std::string url = "udpm://239.255.76.67:7790?ttl=0&recv_buf_size=4194304";
  runtime::Bus bus(url);
  auto& frames = bus.queue(runtime::channels::kTof[0], 64);
  auto& clouds = bus.queue(runtime::channels::kCloud, 64);
  LoopbackFeed feed(kLoopback, kWidth, kHeight);
  feed.write(depth_image(kWidth, kHeight, 0));
  std::vector<std::string> arguments{"--source", "v4l2", "--url", url};
  for (const char* setting :
       {"sensor.v4l2.format=y16", "sensor.v4l2.width_px=64", "sensor.v4l2.height_px=48",
        "sensor.head_0.device=/dev/video20", "sensor.head_0.fx_px=60", "sensor.head_0.fy_px=60",
        "sensor.head_0.cx_px=31.5", "sensor.head_0.cy_px=23.5"}) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  support::ChildProcess service(std::string(LADDER_BIN_DIR) + "/sensor_service", arguments);
  int num_frames = 0, num_clouds = 0, num_points = 0;
  for (int number = 1; number < 400 && (num_frames < 3 || num_clouds < 3); ++number) {
    feed.write(depth_image(kWidth, kHeight, number));
    std::this_thread::sleep_for(100ms);
    bus.drain();
    while (const ladder_msgs::tof_frame_t* frame = frames.take(0)) {
      const std::vector<std::uint16_t> sent =
          depth_image(kWidth, kHeight, frame->depth_mm[0] - 1000);
      EXPECT_TRUE(
          std::equal(sent.begin(), sent.end(), frame->depth_mm.begin(), frame->depth_mm.end()));
      ++num_frames;
    }
    while (const ladder_msgs::point_cloud_t* cloud = clouds.take(0)) {
      num_points = cloud->num_points;
      ++num_clouds;
    }
  }
  EXPECT_GE(num_frames, 3) << service.output();
  EXPECT_GE(num_clouds, 3) << service.output();
  EXPECT_GT(num_points, 1500) << service.output();
  service.signal(SIGTERM);
  EXPECT_EQ(service.wait(20s), 0);
}

}  // namespace
