// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_service/service.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "ladder_msgs/health_t.hpp"
#include "sensor_service/config.h"
#include "sensor_service/convert.h"
#include "sensor_service/lcm_source.h"
#include "sources/make_sources.h"
#include "sources/ready_set.h"
#include "tof/fusion.h"

namespace sensor_service {
namespace {

using ladder_msgs::health_t;
namespace channels = runtime::channels;

constexpr std::int64_t kSilentAfterUs = 1'000'000;
constexpr std::size_t kMaxWaitingPoses = 256;
constexpr std::size_t kMaxWaitingJoints = 64;
enum Stage : std::size_t { kFuse, kPublish };

class SensorService final : public runtime::Service, private sources::FrameSink {
 public:
  explicit SensorService(runtime::ServiceContext context)
      : context_(context),
        devices_(read_source_params(context.config)),
        sources_(sources::make_device_sources(devices_, ready_)),
        owns_devices_(!sources_.empty()),
        poses_(context.bus.queue(channels::kPose, kMaxWaitingPoses)),
        joints_(context.bus.queue(channels::kClimb, kMaxWaitingJoints)),
        fusion_(read_params(context.config)) {
    if (!owns_devices_) sources_.push_back(std::make_unique<LcmSource>(context.bus));
  }

  void step(const base::Now& now) noexcept override {
    while (const ladder_msgs::pose_t* pose = poses_.take(now.utime_us)) {
      fusion_.add_pose(pose->utime, to_pose(*pose));
    }
    while (const ladder_msgs::climb_state_t* climb = joints_.take(now.utime_us)) {
      if (const auto angles_rad = to_joints(*climb)) fusion_.add_joints(climb->utime, *angles_rad);
    }
    now_us_ = now.monotonic_us;
    for (const auto& source : sources_) source->poll(now, *this);
    if (now_us_ - last_frame_us_ > kSilentAfterUs) {
      context_.health.set_state(health_t::STATE_WAITING);
    }
  }

  int wake_up() const override { return ready_.file_descriptor(); }

 private:
  /// What came from a device is published as well: recorders and replays see the same as we do.
  void on_imu(const tof::ImuSample& sample) override {
    if (owns_devices_) {
      to_message(sample, imu_message_);
      context_.bus.publish(channels::kImu, imu_message_);
      ++imu_message_.seq;
    }
    fusion_.add_imu(sample);
  }

  void on_device(bool is_working, const std::string& text) override {
    if (is_working) {
      context_.journal.info(text);
    } else {
      context_.journal.warning(text);
    }
  }

  void on_frame(const tof::DepthFrame& frame) override {
    last_frame_us_ = now_us_;
    if (owns_devices_) {
      to_message(frame, frame_message_);
      context_.bus.publish(channels::kTof[frame.head], frame_message_);
    }
    const std::int64_t recordings = fusion_.counters().recordings;
    tof::FrameResult result;
    {
      const runtime::StageTimer timer(context_.health, kFuse);
      result = fusion_.add_frame(frame);
    }
    if (fusion_.counters().recordings != recordings) {
      context_.journal.info("another recording begins: poses and gravity are forgotten");
    }
    if (result.fault != tof::FrameFault::kNone) {
      context_.journal.warning("head " + std::to_string(frame.head) + ": frame refused, wrong " +
                               tof::name_of(result.fault));
    }
    for (const tof::Cloud& cloud : result.clouds) publish(cloud);
    report_heads();
  }

  void publish(const tof::Cloud& cloud) {
    const runtime::StageTimer timer(context_.health, kPublish);
    to_message(cloud, message_);
    context_.bus.publish(channels::kCloud, message_);
    ++message_.seq;
    context_.health.set_flag(health_t::FLAG_NO_ODOMETRY,
                             cloud.pose_source != tof::PoseSource::kOdometry);
    context_.health.set_flag(health_t::FLAG_NO_GRAVITY,
                             cloud.pose_source == tof::PoseSource::kUnknown);
  }

  /// A head that dies or comes back is said once; health carries the state of all.
  void report_heads() {
    std::array<std::int8_t, tof::kNumHeads> states{};
    bool any_dead = false;
    for (int head = 0; head < tof::kNumHeads; ++head) {
      const tof::HeadState state = fusion_.head_state(head);
      states[head] = static_cast<std::int8_t>(state);
      // A head of our own that never delivered is as bad as one that fell silent.
      const bool is_awaited = owns_devices_ && !devices_.heads[head].device.empty();
      any_dead = any_dead || state == tof::HeadState::kDead ||
                 (is_awaited && state == tof::HeadState::kUnknown);
      if (state == told_[head]) continue;
      if (state == tof::HeadState::kDead) {
        context_.journal.warning("head " + std::to_string(head) +
                                 " is silent; clouds go on without it");
      } else if (told_[head] == tof::HeadState::kDead) {
        context_.journal.info("head " + std::to_string(head) + " is back");
      }
      told_[head] = state;
    }
    context_.health.set_head_state(states);
    context_.health.set_flag(health_t::FLAG_HEAD_DEAD, any_dead);
    context_.health.set_state(any_dead ? health_t::STATE_DEGRADED : health_t::STATE_WORKING);
  }

  runtime::ServiceContext context_;
  sources::SourceParams devices_;
  sources::ReadySet ready_;
  std::vector<std::unique_ptr<sources::FrameSource>> sources_;
  bool owns_devices_;  ///< and publishes what they deliver; else all comes over LCM
  runtime::Queue<ladder_msgs::pose_t>& poses_;
  runtime::Queue<ladder_msgs::climb_state_t>& joints_;  ///< of the own limbs
  tof::Fusion fusion_;
  ladder_msgs::point_cloud_t message_{};
  ladder_msgs::tof_frame_t frame_message_{};
  ladder_msgs::imu_t imu_message_{};
  std::array<tof::HeadState, tof::kNumHeads> told_{};
  std::int64_t now_us_ = 0;
  std::int64_t last_frame_us_ = 0;
};

}  // namespace

runtime::ServiceDescription description() {
  return {.name = "sensor",
          .number = health_t::SERVICE_SENSOR,
          .purpose = "sensor_service: depth frames, IMU and pose in, point clouds out",
          .make =
              [](const runtime::ServiceContext& context) {
                return std::make_unique<SensorService>(context);
              },
          .shorthands = {{"--source", "sensor.source",
                          "where depth frames come from: lcm, v4l2 or a010 (= --set "
                          "sensor.source=...)"}}};
}

}  // namespace sensor_service
