// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/full_perception.h"

#include <span>
#include <string_view>

#include "base/check.h"
#include "climb_controller/convert.h"
#include "runtime/channels.h"
#include "runtime/wire_guard.h"

namespace robot_in_a_box {
namespace {

namespace channels = runtime::channels;

constexpr std::int64_t kImuPeriod_us = 10'000;
constexpr std::int64_t kPosePeriod_us = 20'000;
constexpr std::int64_t kClimbPeriod_us = 50'000;

}  // namespace

FullPerception::FullPerception(const FullPerceptionParams& params, const runtime::Config& config,
                               const simulator::Scene& scene, const simulator::PhysicsModel& model,
                               const Eigen::Isometry3d& T_odom_world)
    : params_(params),
      model_(model),
      heads_(params.heads, scene, model, T_odom_world),
      chain_(config),
      memory_(params.memory) {
  newest_.reserve();
  climb_.session_id = 1;
  chain_.record({channels::kCloud.name, channels::kTopology.name, channels::kRungs.name},
                [this](const char* channel, const void* bytes, std::size_t num_bytes) {
                  take(channel, bytes, num_bytes);
                });
}

void FullPerception::look(std::int64_t now_us, simulator::RobotPlant& plant,
                          const climb_controller::CycleReport& told) {
  now_us_ = now_us;
  hear(now_us, told.output.pose.T_odom_body());
  tell_of_robot(now_us, plant, told);
  if (now_us >= heads_.due_us()) flash(now_us, plant);
}

void FullPerception::forget_controller() {
  waiting_.clear();
  inbox_ = climb_controller::RungsInbox{climb_controller::PerceptionParams{}};
  memory_ = climb_controller::RungMemory(params_.memory);
  newest_ = {};
  newest_.reserve();
  ++climb_.session_id;
  climb_.seq = pose_.seq = 0;
}

void FullPerception::hear(std::int64_t now_us, const Eigen::Isometry3d& T_odom_body) {
  while (!waiting_.empty() && waiting_.front().due_us <= now_us) {
    const auto verdict =
        inbox_.accept(waiting_.front().message, {now_us, kEpoch_us + now_us}, newest_);
    if (verdict == runtime::Reject::kNone) memory_.complete(now_us, T_odom_body, newest_);
    waiting_.pop_front();
  }
}

void FullPerception::tell_of_robot(std::int64_t now_us, simulator::RobotPlant& plant,
                                   const climb_controller::CycleReport& told) {
  if (now_us % kImuPeriod_us == 0) {
    const simulator::ImuReading reading = plant.imu();
    ladder_msgs::imu_t imu{};
    imu.utime = kEpoch_us + now_us;
    imu.seq = imu_seq_++;
    for (int i = 0; i < 3; ++i) {
      imu.accelerometer_m_s2[i] = reading.specific_force_m_s2[i];
      imu.gyroscope_rad_s[i] = reading.angular_rate_rad_s[i];
    }
    send(channels::kImu.name, imu);
  }
  if (told.now_us == 0) return;  // the controller has not run yet
  if (now_us % kPosePeriod_us == 0) {
    climb_controller::to_message(told.output.pose, pose_);
    pose_.utime = kEpoch_us + told.now_us;
    send(channels::kPose.name, pose_);
    ++pose_.seq;
  }
  if (now_us % kClimbPeriod_us == 0) {
    climb_controller::to_message(told, climb_);
    climb_.utime = kEpoch_us + told.now_us;
    send(channels::kClimb.name, climb_);
    ++climb_.seq;
  }
}

void FullPerception::flash(std::int64_t now_us, const simulator::RobotPlant& plant) {
  heads_.look(model_, plant.T_world_body());
  if (const auto* frame = heads_.flash(kEpoch_us + now_us)) {
    send(channels::kTof[static_cast<std::size_t>(frame->head)].name, *frame);
  }
  if (const auto* truth = heads_.truth()) {
    truth_ = *truth;
    send(channels::kTruth.name, truth_, false);
  }
}

template <class Message>
void FullPerception::send(const char* channel, const Message& message, bool to_services) {
  buffer_.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(buffer_.data(), 0, static_cast<int>(buffer_.size()));
  if (log_) log_(channel, buffer_.data(), buffer_.size(), kEpoch_us + now_us_);
  if (to_services) chain_.feed(channel, buffer_.data(), buffer_.size(), kEpoch_us + now_us_);
}

void FullPerception::take(const char* channel, const void* bytes, std::size_t num_bytes) {
  if (log_) log_(channel, bytes, num_bytes, kEpoch_us + now_us_);
  if (std::string_view(channel) != channels::kRungs.name) return;
  const std::span received(static_cast<const std::uint8_t*>(bytes), num_bytes);
  CHECK(runtime::decode_guarded(received, rungs_) == runtime::Reject::kNone,
        "ladder_service publishes what the controller may read");
  waiting_.push_back({now_us_ + params_.latency_us, rungs_});
}

}  // namespace robot_in_a_box
