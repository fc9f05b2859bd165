// SPDX-License-Identifier: BSD-3-Clause
// A robot before a scene, standing still or swaying, as a stream of messages in order of time: four
// depth heads one after the other, the inertial unit, and the truth after each round of heads. No
// clock, no LCM: the live process and the log writer ask for what is due and get the same values.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "ladder_msgs/imu_t.hpp"
#include "ladder_msgs/tof_frame_t.hpp"
#include "ladder_msgs/truth_t.hpp"
#include "simulator/head_renderer.h"
#include "simulator/imu.h"
#include "simulator/motion.h"
#include "simulator/scene.h"
#include "simulator/visibility.h"
#include "simulator/world.h"

namespace simulator {

/// A rung that somebody takes away while the robot looks.
struct Removal {
  int rung = 2;          ///< index into Scene::rungs
  double after_s = 1.5;  ///< since the start; gone from the next round of heads on
};

struct SimulationParams {
  SceneParams scene;
  SensorParams sensor;
  ImuParams imu;
  HeadLayout layout = heads_still();
  std::array<bool, kNumHeads> head_dead{};  ///< true: this head sends nothing
  double body_height_m = 0.55;              ///< of the body's origin above the floor
  double rate_hz = 15.0;                    ///< (0, 60] frames of each head
  double stagger_hz = 60.0;                 ///< (0, 1000] heads of one round follow each other, at
                                            ///< least as fast as rate_hz needs
  double imu_rate_hz = 200.0;               ///< (0, 1000]
  MotionParams motion;
  std::optional<Removal> removal;
  std::int64_t start_utime_us = 0;  ///< time of head 0's first frame
};

/// "" or the violated relation.
std::string check(const SimulationParams& params);

using Message = std::variant<ladder_msgs::tof_frame_t, ladder_msgs::imu_t, ladder_msgs::truth_t>;

/// Time of measurement of a message.
std::int64_t utime_us(const Message& message);

class Simulation {
 public:
  /// Throws std::invalid_argument when check(params) objects.
  explicit Simulation(const SimulationParams& params);

  /// Time of the next message.
  std::int64_t next_utime_us() const;
  /// Every message due up to and including this time that was not returned before, in order of
  /// time; valid until the next call.
  const std::vector<Message>& advance_to(std::int64_t utime_us);

  const World& world() const { return world_; }
  const HeadRenderer& head(int index) const { return heads_[static_cast<std::size_t>(index)]; }
  /// The newest image of a head, with what a real head does not know.
  const HeadImage& image(int index) const { return images_[static_cast<std::size_t>(index)]; }
  Eigen::Isometry3d T_world_body(std::int64_t utime_us) const;
  /// Odom: z up, x = horizontal viewing direction of head 0, origin = body's origin at the start.
  const Eigen::Isometry3d& T_odom_world() const { return T_odom_world_; }

 private:
  std::int64_t head_utime_us() const;
  std::int64_t imu_utime_us() const;
  void advance_head();
  void begin_round(std::int64_t utime);
  ladder_msgs::tof_frame_t tof_frame(int head, std::int64_t utime) const;
  ladder_msgs::imu_t imu_message() const;
  ladder_msgs::truth_t truth_message(std::int64_t utime) const;

  SimulationParams params_;
  World world_;
  std::vector<HeadRenderer> heads_;
  std::array<HeadImage, kNumHeads> images_;
  RungVisibility visibility_;
  Eigen::Isometry3d T_world_start_ = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_odom_world_ = Eigen::Isometry3d::Identity();
  std::int64_t round_ = 0;  ///< rounds of the four heads
  int next_head_ = 0;
  std::int64_t imu_index_ = 0;
  std::int64_t newest_frame_utime_us_ = 0;  ///< of this round's live heads
  bool is_removed_ = false;
  std::vector<Message> due_;
};

}  // namespace simulator
