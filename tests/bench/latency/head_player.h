// SPDX-License-Identifier: BSD-3-Clause
// Four simulated heads and an inertial unit on LCM at any rate: the frames are rendered before, so
// that sending them costs next to nothing beside what is measured.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

#include "ladder_msgs/imu_t.hpp"
#include "ladder_msgs/tof_frame_t.hpp"
#include "runtime/bus.h"
#include "runtime/channels.h"

namespace bench {

class HeadPlayer {
 public:
  static constexpr std::size_t kNumHeads = runtime::channels::kTof.size();
  using Round = std::array<ladder_msgs::tof_frame_t, kNumHeads>;

  /// Renders the rounds that are sent over and over. Throws runtime::BusError.
  HeadPlayer(const std::string& url, double rate_hz);
  ~HeadPlayer() { stop(); }
  HeadPlayer(const HeadPlayer&) = delete;
  HeadPlayer& operator=(const HeadPlayer&) = delete;

  /// Sends from a thread of its own, the heads one after the other, until stop().
  void start();
  void stop();

  /// Frames of all heads so far.
  std::int64_t num_sent() const { return num_sent_; }
  /// Frames that went out more than half a period late: the machine was too busy to send.
  std::int64_t num_late() const { return num_late_; }

 private:
  void play();
  void send(std::int64_t index);

  runtime::Bus bus_;
  std::int64_t head_interval_us_;  ///< between the frames of one head and the next
  std::vector<Round> rounds_;
  ladder_msgs::imu_t imu_{};
  std::atomic<std::int64_t> num_sent_ = 0;
  std::atomic<std::int64_t> num_late_ = 0;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace bench
