// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/scene_run.h"

#include <cmath>
#include <span>
#include <string_view>

#include "base/check.h"
#include "base/rng.h"
#include "ladder_msgs/pose_t.hpp"
#include "robot_in_a_box/chain.h"
#include "runtime/channels.h"
#include "runtime/wire_guard.h"

namespace robot_in_a_box {
namespace {

namespace channels = runtime::channels;

const char* channel_of(const ladder_msgs::tof_frame_t& frame) {
  return channels::kTof[static_cast<std::size_t>(frame.head)].name;
}
const char* channel_of(const ladder_msgs::imu_t&) {
  return channels::kImu.name;
}
const char* channel_of(const ladder_msgs::pose_t&) {
  return channels::kPose.name;
}
const char* channel_of(const ladder_msgs::truth_t&) {
  return channels::kTruth.name;
}

class SceneRun {
 public:
  SceneRun(const SceneRunParams& params, const runtime::Config& config)
      : params_(params),
        simulation_(params.simulation),
        chain_(config),
        rng_(params.simulation.scene.seed, kOdometryStream) {
    chain_.record({channels::kTopology.name, channels::kRungs.name},
                  [this](const char* channel, const void* bytes, std::size_t num_bytes) {
                    take(channel, {static_cast<const std::uint8_t*>(bytes), num_bytes});
                  });
  }

  simulator::Score run() {
    const std::int64_t start_us = params_.simulation.start_utime_us;
    const auto last_us = static_cast<std::int64_t>(
                             std::floor(1e6 * params_.num_frames / params_.simulation.rate_hz)) -
                         1;
    while (simulation_.next_utime_us() <= start_us + last_us) {
      const std::int64_t now_us = simulation_.next_utime_us();
      tell_poses(now_us);
      for (const simulator::Message& message : simulation_.advance_to(now_us)) {
        std::visit([this](const auto& value) { tell(value); }, message);
      }
    }
    return scorer_.result();
  }

 private:
  static constexpr std::uint64_t kOdometryStream = 0x6f646f6d;

  void tell(const ladder_msgs::truth_t& truth) {
    encode(truth);
    scorer_.add(truth);
  }

  template <class Message>
  void tell(const Message& message) {
    encode(message);
    chain_.feed(channel_of(message), bytes_.data(), bytes_.size(), message.utime);
  }

  template <class Message>
  void encode(const Message& message) {
    bytes_.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(bytes_.data(), 0, static_cast<int>(bytes_.size()));
    now_us_ = message.utime;
    if (params_.listener) params_.listener(channel_of(message), bytes_, now_us_);
  }

  /// Every pose up to this time.
  void tell_poses(std::int64_t now_us) {
    if (!params_.odometry || !params_.simulation.motion.any()) return;
    for (;; ++pose_.seq) {
      const double passed_us = 1e6 * static_cast<double>(pose_.seq) / params_.odometry_hz;
      pose_.utime = params_.simulation.start_utime_us + static_cast<std::int64_t>(passed_us);
      if (pose_.utime > now_us) return;
      const Eigen::Isometry3d T_odom_body =
          simulation_.T_odom_world() * simulation_.T_world_body(pose_.utime);
      const Eigen::Quaterniond q(T_odom_body.linear());
      for (int i = 0; i < 3; ++i) {
        pose_.p_odom_body_m[i] =
            T_odom_body.translation()[i] + params_.odometry_sigma_m * rng_.gaussian();
      }
      pose_.q_odom_body[0] = q.w();
      pose_.q_odom_body[1] = q.x();
      pose_.q_odom_body[2] = q.y();
      pose_.q_odom_body[3] = q.z();
      pose_.sigma_position_m = params_.odometry_sigma_m;
      tell(pose_);
    }
  }

  void take(const char* channel, std::span<const std::uint8_t> bytes) {
    if (params_.listener) params_.listener(channel, bytes, now_us_);
    if (channel == std::string_view(channels::kTopology.name))
      return add<ladder_msgs::topology_t>(bytes);
    add<ladder_msgs::ladder_t>(bytes);
    const double busy_ms = chain_.busy_ms("gng") + chain_.busy_ms("ladder");
    if (is_warm_) scorer_.computed(busy_ms - busy_ms_);
    is_warm_ = true;  // the first cloud reserves memory
    busy_ms_ = busy_ms;
  }

  template <class Message>
  void add(std::span<const std::uint8_t> bytes) {
    Message message;
    CHECK(runtime::decode_guarded(bytes, message) == runtime::Reject::kNone,
          "services publish what others may read");
    scorer_.add(message);
  }

  SceneRunParams params_;
  simulator::Simulation simulation_;
  simulator::Scorer scorer_;
  Chain chain_;
  base::Rng rng_;
  ladder_msgs::pose_t pose_{};
  std::vector<std::uint8_t> bytes_;
  std::int64_t now_us_ = 0;
  double busy_ms_ = 0.0;
  bool is_warm_ = false;
};

}  // namespace

simulator::Score run_scene(const SceneRunParams& params, const runtime::Config& config) {
  return SceneRun(params, config).run();
}

}  // namespace robot_in_a_box
