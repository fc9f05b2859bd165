// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/climb_log.h"

#include "climb_controller/convert.h"

namespace robot_in_a_box {
namespace {

constexpr std::int64_t kPoseEvery = 2;    ///< cycles
constexpr std::int64_t kStateEvery = 10;  ///< cycles

}  // namespace

ClimbLog::ClimbLog(const std::string& path) {
  if (path.empty()) return;
  file_ = std::make_unique<lcm::LogFile>(path, "w");
  is_good_ = file_->good();
}

template <class Msg>
void ClimbLog::append(const runtime::Channel<Msg>& channel, const Msg& message) {
  bytes_.resize(static_cast<std::size_t>(message.getEncodedSize()));
  const int size = static_cast<int>(bytes_.size());
  lcm::LogEvent event{};
  event.eventnum = num_events_++;
  event.timestamp = utime_us_;
  event.channel = channel.name;
  event.datalen = message.encode(bytes_.data(), 0, size);
  event.data = bytes_.data();
  is_good_ = is_good_ && event.datalen == size && file_->writeEvent(&event) == 0;
}

void ClimbLog::write(const ClimbBox& box) {
  if (file_ == nullptr || !is_good_) return;
  namespace channels = runtime::channels;
  utime_us_ = PerceivedLadder::kEpoch_us + box.now_us();
  const ladder_msgs::ladder_t& rungs = box.perception().message();
  if (rungs.seq != rungs_seq_) append(channels::kRungs, rungs);
  rungs_seq_ = rungs.seq;
  if (num_cycles_ % kPoseEvery == 0) {
    climb_controller::to_message(box.report().output.pose, pose_);
    pose_.utime = utime_us_;
    ++pose_.seq;
    append(channels::kPose, pose_);
  }
  if (num_cycles_ % kStateEvery == 0) {
    climb_controller::to_message(box.report(), state_);
    state_.utime = utime_us_;
    ++state_.seq;
    state_.cycles = num_cycles_;
    append(channels::kClimb, state_);
  }
  ++num_cycles_;
}

}  // namespace robot_in_a_box
