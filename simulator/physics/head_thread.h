// SPDX-License-Identifier: BSD-3-Clause
// Renders and publishes the heads' images beside the physics, which must not wait for them. A head
// whose turn comes while the last one is still being rendered flashes late, or not at all.
#pragma once

#include <array>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "simulator/physics/body_heads.h"

namespace simulator {

class HeadThread {
 public:
  /// Publishes on this LCM provider. Throws runtime::BusError.
  HeadThread(BodyHeads heads, const std::string& url);
  ~HeadThread();
  HeadThread(const HeadThread&) = delete;
  HeadThread& operator=(const HeadThread&) = delete;

  /// From the physics' thread, often: takes the picture when one is due. Never waits.
  void offer(std::int64_t now_us, const PhysicsModel& model, const Eigen::Isometry3d& T_world_body);
  /// From the physics' thread: that head sends nothing from its next flash on, or sends again.
  void set_dead(int head, bool dead) { dead_[static_cast<std::size_t>(head)] = dead; }

 private:
  void run(const std::string& url);

  BodyHeads heads_;  ///< of whoever is_busy_ says
  std::array<bool, kNumHeads> dead_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool is_busy_ = false;
  bool is_ending_ = false;
  std::int64_t utime_us_ = 0;
  std::thread thread_;
};

}  // namespace simulator
