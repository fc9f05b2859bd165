// SPDX-License-Identifier: BSD-3-Clause
// Rungs as perception would tell them, made from the plant's truth: messages at 15 Hz, in the odom
// frame, with an error per rung that stays and one per message that does not. Heads see the ladder
// from the body, so an error of the body's estimated pose goes into the rungs too, as it does in
// life. They pass the controller's own inbox. Can be made to speak nonsense. No cameras, no cloud.
#pragma once

#include <cstdint>
#include <vector>

#include "base/rng.h"
#include "climb_controller/perception_inbox.h"
#include "robot_in_a_box/eyes.h"

namespace robot_in_a_box {

struct PerceptionParams {
  std::int64_t period_us = 66'667;
  double bias_m = 0.003;        ///< of a rung, uniform +- per axis, for its life
  double jitter_m = 0.001;      ///< of a rung in one message, uniform +- per axis
  double tilt_rad = 0.0;        ///< of a rung about its middle, uniform +- per axis, for its life
  double range_m = 1.0;         ///< rungs so far above and below the body are seen
  double stretch_end_m = 0.02;  ///< so far from either end a claw is kept
};

/// What is wrong with every message.
enum class Nonsense : std::uint8_t {
  kNone,
  kRepeated,   ///< the same number and time again
  kReordered,  ///< a number from before
  kOld,        ///< measured a second ago
  kAhead,      ///< measured in an hour, as after a step of the clock
  kNotFinite,
  kHuge,
  kBadCount,  ///< more rungs announced than told
};

class PerceivedLadder : public Eyes {
 public:
  PerceivedLadder(const PerceptionParams& params, std::uint64_t seed);

  /// Hands the next message over when one is due. `T_odom_body` is what the controller publishes.
  void update(std::int64_t now_us, const simulator::RobotPlant& plant,
              const Eigen::Isometry3d& T_odom_body);

  /// Virtual time 0 for the wall clock: some day.
  static constexpr std::int64_t kEpoch_us = 1'700'000'000'000'000;
  /// The last one, as it was handed over.
  const ladder_msgs::ladder_t& message() const { return message_; }
  void look(std::int64_t now_us, simulator::RobotPlant& plant,
            const climb_controller::CycleReport& told) override {
    update(now_us, plant, told.output.pose.T_odom_body());
  }
  climb::LadderView view() const override { return newest_.view(); }
  std::int64_t received_us() const override { return newest_.received_us; }
  std::int64_t num_refused() const { return inbox_.num_refused(); }

  bool silent = false;             ///< perception has stopped
  int withdrawn_rung = -1;         ///< flagged as damaged from now on
  std::vector<int> damaged_rungs;  ///< seen to be bent or broken off from the first
  double seen_from_m = -1e9;       ///< rungs nearer than this above the body are not seen
  Nonsense nonsense = Nonsense::kNone;
  std::int64_t wall_step_us = 0;  ///< of the machine's wall clock, since the start

  /// The last message once more, as from a flooded network.
  void repeat(std::int64_t now_us);

 private:
  void tell(std::int64_t now_us, const simulator::RobotPlant& plant,
            const Eigen::Isometry3d& T_odom_world);
  void add_rung(int index, const simulator::LadderRung& rung,
                const Eigen::Isometry3d& T_odom_world);
  void spoil();

  PerceptionParams params_;
  base::Rng rng_;
  base::Rng tilt_rng_;
  std::vector<Eigen::Vector3d> bias_m_;
  std::vector<Eigen::Vector3d> tilt_rad_;
  climb_controller::RungsInbox inbox_{climb_controller::PerceptionParams{}};
  climb_controller::RungsSnapshot newest_;
  ladder_msgs::ladder_t message_;
  std::int64_t seq_ = 1;
  std::int64_t good_seq_ = 0;  ///< of the last message that was as it should be
  std::int64_t good_utime_us_ = 0;
  std::int64_t next_us_ = 0;
};

}  // namespace robot_in_a_box
