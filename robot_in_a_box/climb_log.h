// SPDX-License-Identifier: BSD-3-Clause
// A climb in virtual time as an LCM log: rungs, pose and climb state as the live services publish
// them, for lcm-logplayer and the viewer. No heads, no clouds.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "ladder_msgs/climb_state_t.hpp"
#include "ladder_msgs/pose_t.hpp"
#include "robot_in_a_box/climb_box.h"
#include "runtime/channels.h"

namespace robot_in_a_box {

class ClimbLog {
 public:
  /// "" = nothing is written.
  explicit ClimbLog(const std::string& path);

  /// After each cycle.
  void write(const ClimbBox& box);
  bool good() const { return is_good_; }

 private:
  template <class Msg>
  void append(const runtime::Channel<Msg>& channel, const Msg& message);

  std::unique_ptr<lcm::LogFile> file_;
  bool is_good_ = true;
  std::int64_t num_events_ = 0;
  std::int64_t num_cycles_ = 0;
  std::int64_t utime_us_ = 0;
  std::int64_t rungs_seq_ = 0;
  ladder_msgs::pose_t pose_{};
  ladder_msgs::climb_state_t state_{};
  std::vector<std::uint8_t> bytes_;
};

}  // namespace robot_in_a_box
