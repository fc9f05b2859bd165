// SPDX-License-Identifier: BSD-3-Clause
// The whole robot climbs, and one kind of mishap comes upon it again and again at random instants:
// a service is killed and started anew, the E-stop is pressed while a limb is in the air, heads
// die, a flood of messages, an old log played beside it. An operator brings it on each time. What
// must follow (docs/SAFETY.md) is asserted from the plant's truth and the monitor of the bus.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/rng.h"
#include "robot_in_a_box/full_climb.h"

namespace robot_in_a_box {

enum class Mishap : std::uint8_t {
  kKillSensor,
  kKillGng,
  kKillLadder,
  kKillController,
  kEstop,
  kOneHead,
  kTwoHeads,
  kFlood,
  kOldLog
};
inline constexpr int kNumMishaps = static_cast<int>(Mishap::kOldLog) + 1;
const char* name(Mishap mishap);

struct ClosedLoopParams {
  FullClimbParams climb;
  Mishap mishap = Mishap::kKillGng;
  int num_times = 20;
  std::uint64_t seed = 1;  ///< of the instants
  /// Simulated; between the robot climbing again and the next mishap.
  double least_pause_s = 1.0;
  double most_pause_s = 8.0;
};

/// One of them.
struct MishapRow {
  double at_s = 0.0;
  std::string limbs;  ///< what they were about
  /// Until the robot answered: perception too old (since the newest rungs), all drives stopping by
  /// themselves, or ESTOP. -1: there was nothing to answer.
  double reaction_ms = -1.0;
  double back_s = -1.0;  ///< until it climbed again; -1: it did not
  std::string end;       ///< the state then, and why
};

struct ClosedLoopResult {
  bool has_hung = false;
  int falls = 0;
  std::int64_t num_violations = 0;
  int rungs_climbed = 0;
  int min_support = 0;
  std::vector<MishapRow> rows;
  std::vector<std::string> missed;  ///< what should have been otherwise
};

class ClosedLoop {
 public:
  ClosedLoop(const ClosedLoopParams& params, const runtime::Config& config);

  /// Takes lines of what happens (empty: nobody listens).
  ClosedLoopResult run(std::function<void(const std::string&)> tell = {});

 private:
  struct OldMessage {
    std::string channel;
    std::vector<std::uint8_t> bytes;
  };

  void cycle();
  void cycles_s(double duration_s);
  bool climbs() const;
  /// Orders what leads on until it climbs; false within that time.
  bool go_on(double within_s);
  void give_order();
  void suffer(MishapRow& row);
  void lose_service(const std::string& service, MishapRow& row);
  void lose_controller(MishapRow& row);
  void press_estop(MishapRow& row);
  void lose_heads(int num_heads, MishapRow& row);
  void flood(MishapRow& row);
  void play_old_log(MishapRow& row);
  void wait_for_limb_in_the_air();
  /// Until the condition holds, in ms; -1: not within that time.
  double ms_until(const std::function<bool()>& condition, double within_s);
  int num_drives_in(simulator::PowerState state) const;
  void keep_log();
  void miss(const std::string& what);
  void tell_row(const MishapRow& row) const;
  std::string state_in_words() const;
  std::string limbs_in_words() const;

  ClosedLoopParams params_;
  FullClimb full_;
  PhysicalClimb& climb_;
  ClimbBox& box_;
  base::Rng rng_;
  std::vector<OldMessage> old_log_;
  climb::OperatorCommand old_order_;
  bool upwards_ = true;
  ClosedLoopResult result_;
  std::function<void(const std::string&)> tell_;
};

}  // namespace robot_in_a_box
