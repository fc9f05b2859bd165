// SPDX-License-Identifier: BSD-3-Clause
// The real sensor_service with devices of its own: a MaixSense A010 on a pseudo terminal and an
// inertial unit in a fake IIO tree. Frames, samples and clouds come out; devices go and come back.
#include <chrono>
#include <csignal>
#include <functional>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "fake_a010.h"
#include "fake_iio.h"
#include "runtime/bus.h"
#include "runtime/clock.h"
#include "tests/support/child_process.h"

namespace {

using ladder_msgs::health_t;
using sources::FakeA010;
using sources::FakeIio;
using support::ChildProcess;
using ::testing::Each;
using ::testing::HasSubstr;
using namespace std::chrono_literals;
namespace channels = runtime::channels;

const std::string kProgram = std::string(LADDER_BIN_DIR) + "/sensor_service";
constexpr std::uint8_t kCount = 102;  // 400 mm

class DeviceService : public ::testing::Test {
 protected:
  void SetUp() override {
    unit_ = std::make_unique<FakeA010>(link_);
    imu_ = std::make_unique<FakeIio>(root_);
    imu_->set("in_accel_scale", "0.000981");
    imu_->set("in_anglvel_scale", "0.001");
    start({});
  }

  void start(const std::vector<std::string>& more_settings) {
    std::vector<std::string> settings{
        "sensor.head_0.device=" + link_,  "sensor.a010.binning=4",
        "sensor.head_0.fx_px=18",         "sensor.head_0.fy_px=18",
        "sensor.head_0.cx_px=12",         "sensor.head_0.cy_px=12",
        "sensor.imu.device=name:mpu6050", "sensor.imu.sysfs=" + imu_->sysfs(),
        "sensor.imu.dev=" + imu_->dev()};
    settings.insert(settings.end(), more_settings.begin(), more_settings.end());
    std::vector<std::string> arguments{"--source", "a010", "--url", url_};
    for (const std::string& setting : settings)
      arguments.insert(arguments.end(), {"--set", setting});
    service_ = std::make_unique<ChildProcess>(kProgram, arguments);
  }

  ~DeviceService() override {
    imu_.reset();
    std::filesystem::remove_all(root_);
  }

  /// Plays both devices, 200 samples and 20 images per second, until the condition holds.
  bool run_until(const std::function<bool()>& condition, std::chrono::seconds timeout = 20s) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    for (int step = 0; !condition(); ++step) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      usleep(5'000);
      if (unit_) unit_->work();
      if (unit_ && unit_->is_sending() && step % 10 == 0) unit_->send_image(kCount);
      if (imu_ && imu_->get("buffer/enable") == "1")
        imu_->send({0, 0, 10'000, 0, 0, 0}, runtime::clock_now().monotonic_us * 1000);
      receive();
    }
    return true;
  }

  void receive() {
    bus_.drain();
    while (const auto* frame = frames_.take(0)) newest_frame_ = *frame, ++num_frames_;
    while (const auto* sample = samples_.take(0)) newest_sample_ = *sample, ++num_samples_;
    while (const auto* cloud = clouds_.take(0)) newest_cloud_ = *cloud, ++num_clouds_;
    while (const auto* health = healths_.take(0)) health_state_ = health->state;
  }

  const std::string id_ = std::to_string(getpid());
  const std::string link_ = "/tmp/ladder-device-a010-" + id_;
  const std::filesystem::path root_ = "/tmp/ladder-device-iio-" + id_;
  const std::string url_ = "udpm://239.255.76.67:" + std::to_string(20'000 + getpid() % 10'000) +
                           "?ttl=0&recv_buf_size=4194304";
  runtime::Bus bus_{url_};
  runtime::Queue<ladder_msgs::tof_frame_t>& frames_ = bus_.queue(channels::kTof[0], 64);
  runtime::Queue<ladder_msgs::imu_t>& samples_ = bus_.queue(channels::kImu, 512);
  runtime::Queue<ladder_msgs::point_cloud_t>& clouds_ = bus_.queue(channels::kCloud, 64);
  runtime::Queue<health_t>& healths_ = bus_.shared_queue(channels::kHealth, 64);
  ladder_msgs::tof_frame_t newest_frame_{};
  ladder_msgs::imu_t newest_sample_{};
  ladder_msgs::point_cloud_t newest_cloud_{};
  int num_frames_ = 0, num_samples_ = 0, num_clouds_ = 0;
  std::int8_t health_state_ = 0;
  std::unique_ptr<FakeA010> unit_;
  std::unique_ptr<FakeIio> imu_;
  std::unique_ptr<ChildProcess> service_;
};

// Device in, messages and clouds out: the published frame is the unit's image, the sample the
// unit's gravity, the cloud a wall at its distance with "up" known; SIGTERM ends it with 0.
TEST_F(DeviceService, MakesClouds) {
  ASSERT_TRUE(run_until([&] { return num_clouds_ >= 5 && num_samples_ >= 50; }))
      << service_->output();
  ASSERT_EQ(newest_frame_.depth_mm.size(), 625U);
  EXPECT_THAT(newest_frame_.depth_mm, Each(400));
  EXPECT_EQ(newest_frame_.width_px, 25);
  EXPECT_EQ(newest_frame_.fx_px, 18.0);
  EXPECT_EQ(newest_frame_.seq, num_frames_ - 1);
  EXPECT_LT(std::abs(runtime::clock_now().utime_us - newest_frame_.utime), 2'000'000);
  EXPECT_NEAR(newest_sample_.accelerometer_m_s2[2], 9.81, 1e-9);
  EXPECT_EQ(newest_sample_.seq, num_samples_ - 1);
  EXPECT_EQ(newest_cloud_.pose_source, ladder_msgs::point_cloud_t::POSE_GRAVITY);
  ASSERT_EQ(newest_cloud_.num_points, 625);
  for (int i = 0; i < newest_cloud_.num_points; ++i)
    ASSERT_NEAR(newest_cloud_.x_m[i], 0.4F, 1e-4F) << i;
  ASSERT_TRUE(run_until([&] { return health_state_ == health_t::STATE_WORKING; }));
  service_->signal(SIGTERM);
  EXPECT_EQ(service_->wait(2s), 0);
  EXPECT_THAT(service_->output(), HasSubstr("IMU (name:mpu6050) delivers"));
  EXPECT_THAT(service_->output(), HasSubstr("delivers, sensor at 41, driver at 43"));
}

// Both devices are pulled out: the service says so, waits and goes on living; plugged in again,
// clouds come again.
TEST_F(DeviceService, DevicesGoAndComeBack) {
  ASSERT_TRUE(run_until([&] { return num_clouds_ >= 3 && num_samples_ >= 10; }))
      << service_->output();
  unit_.reset();
  imu_.reset();
  receive();
  health_state_ = health_t::STATE_UNKNOWN;
  ASSERT_TRUE(run_until([&] { return health_state_ == health_t::STATE_WAITING; }))
      << service_->output();
  EXPECT_THAT(service_->output(), HasSubstr("head 0 (" + link_ + ") is gone"));
  EXPECT_THAT(service_->output(), HasSubstr("IMU (name:mpu6050) is gone"));
  EXPECT_TRUE(service_->running());
  const int num_clouds = num_clouds_, num_samples = num_samples_;
  unit_ = std::make_unique<FakeA010>(link_);
  imu_ = std::make_unique<FakeIio>(root_, "iio:device4");
  ASSERT_TRUE(run_until([&] {
    return num_clouds_ >= num_clouds + 3 && num_samples_ >= num_samples + 10;
  })) << service_->output();
}

// One of two heads is not there from the start: clouds come from the other, health says degraded.
TEST_F(DeviceService, MissingHeadIsDegraded) {
  service_.reset();
  start({"sensor.head_1.device=/no/such/line", "sensor.head_1.fx_px=18", "sensor.head_1.fy_px=18"});
  ASSERT_TRUE(run_until([&] {
    return num_clouds_ >= 3 && health_state_ == health_t::STATE_DEGRADED;
  })) << service_->output();
  EXPECT_THAT(service_->output(), HasSubstr("head 1 (/no/such/line) cannot be opened"));
}

// A device source without a device, or with a head nobody calibrated, ends with 2 and names the
// key.
TEST(DeviceServiceStart, WrongConfiguration) {
  ChildProcess none(kProgram, {"--source", "v4l2"});
  EXPECT_EQ(none.wait(10s), 2);
  EXPECT_THAT(none.output(), HasSubstr("head_0.device"));
  ChildProcess raw(kProgram, {"--source", "a010", "--set", "sensor.head_2.device=/dev/ttyUSB0"});
  EXPECT_EQ(raw.wait(10s), 2);
  EXPECT_THAT(raw.output(), HasSubstr("head_2.fx_px"));
  ChildProcess unknown(kProgram, {"--source", "magic"});
  EXPECT_EQ(unknown.wait(10s), 2);
  EXPECT_THAT(unknown.output(), HasSubstr("lcm, v4l2, a010"));
}

}  // namespace
