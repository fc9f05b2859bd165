// SPDX-License-Identifier: BSD-3-Clause
// The climbing robot's own eyes: four heads on the moving body, rendered from physics, through the
// perception services to rungs. They get the pose and joint angles that the controller publishes.
// A result counts so much later as the services need for it in life.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "climb_controller/perception_inbox.h"
#include "climb_controller/rung_memory.h"
#include "ladder_msgs/climb_state_t.hpp"
#include "ladder_msgs/pose_t.hpp"
#include "robot_in_a_box/chain.h"
#include "robot_in_a_box/eyes.h"
#include "simulator/physics/body_heads.h"

namespace robot_in_a_box {

struct FullPerceptionParams {
  simulator::BodyHeadsParams heads;
  climb_controller::RungMemoryParams memory;
  std::int64_t latency_us = 50'000;  ///< from the last head's flash to the controller
};

class FullPerception : public Eyes {
 public:
  static constexpr std::int64_t kEpoch_us = 1'767'225'600'000'000;  ///< 2026-01-01: the wall clock
  /// Every message with its time: what goes into the services and what comes out, truth too.
  using Log = std::function<void(const char* channel, const void* bytes, std::size_t num_bytes,
                                 std::int64_t utime_us)>;

  /// Throws runtime::ConfigError. `model` outlives it.
  FullPerception(const FullPerceptionParams& params, const runtime::Config& config,
                 const simulator::Scene& scene, const simulator::PhysicsModel& model,
                 const Eigen::Isometry3d& T_odom_world);

  void look(std::int64_t now_us, simulator::RobotPlant& plant,
            const climb_controller::CycleReport& told) override;
  climb::LadderView view() const override { return newest_.view(); }
  std::int64_t received_us() const override { return newest_.received_us; }

  simulator::BodyHeads& heads() { return heads_; }
  Chain& chain() { return chain_; }
  /// From somebody else: what arrives besides.
  void feed(const char* channel, const void* bytes, std::size_t num_bytes) {
    chain_.feed(channel, bytes, num_bytes, kEpoch_us + now_us_);
  }
  /// The controller is another one: what the last one had heard is gone.
  void forget_controller();
  void log_to(Log log) { log_ = std::move(log); }
  /// The newest that the services said, seen at once.
  const ladder_msgs::ladder_t& rungs() const { return rungs_; }
  const ladder_msgs::truth_t& truth() const { return truth_; }
  std::int64_t num_refused() const { return inbox_.num_refused(); }

 private:
  struct Waiting {
    std::int64_t due_us = 0;
    ladder_msgs::ladder_t message;
  };
  void hear(std::int64_t now_us, const Eigen::Isometry3d& T_odom_body);
  void tell_of_robot(std::int64_t now_us, simulator::RobotPlant& plant,
                     const climb_controller::CycleReport& told);
  void flash(std::int64_t now_us, const simulator::RobotPlant& plant);
  void take(const char* channel, const void* bytes, std::size_t num_bytes);
  template <class Message>
  void send(const char* channel, const Message& message, bool to_services = true);

  FullPerceptionParams params_;
  const simulator::PhysicsModel& model_;
  simulator::BodyHeads heads_;
  Chain chain_;
  Log log_;
  std::vector<std::uint8_t> buffer_;
  std::deque<Waiting> waiting_;
  climb_controller::RungsInbox inbox_{climb_controller::PerceptionParams{}};
  climb_controller::RungMemory memory_;
  climb_controller::RungsSnapshot newest_;
  ladder_msgs::ladder_t rungs_{};
  ladder_msgs::truth_t truth_{};
  ladder_msgs::pose_t pose_{};
  ladder_msgs::climb_state_t climb_{};
  std::int64_t imu_seq_ = 0;
  std::int64_t now_us_ = 0;
};

}  // namespace robot_in_a_box
