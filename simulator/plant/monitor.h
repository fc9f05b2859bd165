// SPDX-License-Identifier: BSD-3-Clause
// The nine invariants of the climbing controller, checked from outside: bus frames, lines and the
// plant's truth, and what operator and status line say about the session. Own decoding.
//
//  I1 off the dock no confirmed grasp is opened unless the three others are confirmed; at least
//  three
//     are when the dock is released. Grasps that the plant took away lately are excused.
//  I2 every enabled target lies in its limits, or between them and where the axis stands outside,
//     and changes by at most v_max T, or to where the axis stands.
//  I3 a jaw is commanded open on a held rung only if the others were confirmed within 50 ms.
//  I4 after a stop trigger and its reaction time targets only run out: never faster than before,
//     standing after 150 ms, unless they follow what is measured. Closing jaws are excused.
//  I5 no 0x0F before the operator armed this session.
//  I6 the first enabled target is the measured position, within 2 counts.
//  I7 the master sends nothing while a bus fault is latched.
//  I8 a stop has exactly one primary reason.
//  I9 no frame of the master leaves older than two cycles (known on the in-memory bus only).
// Does not see: unloading without opening, and anything inside the controller.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulator/plant/memory_bus.h"
#include "simulator/plant/plant_params.h"
#include "simulator/plant/robot_plant.h"

namespace simulator {

struct AxisRules {
  double min_rad = -2.6;
  double max_rad = 2.6;
  double max_velocity_rad_s = 2.5;
};

struct MonitorParams {
  std::int64_t cycle_us = 10'000;
  std::array<DriveParams, kNumAxes> drives;  ///< their counts, signs and offsets
  std::array<AxisRules, kNumAxes> rules;
  double jaw_opens_rad = 0.08;  ///< commanded so far beyond where it stood on it, it lets a rung go
  std::int64_t stop_reaction_us = 20'000;
  std::int64_t stop_run_out_us = 150'000;
  /// So much faster any joint may get while it runs out: it follows its path, and where that bends
  /// towards it, it gains for a while although the foot gets slower. With the path's rate falling
  /// from 1 to 0 in T and a joint acceleration of a at most, the gain is max (s - s^2 / 2)(1 - s) a
  /// T = 0.19 a T: 0.29 rad/s for 10 rad/s^2 and 150 ms.
  double stop_slack_rad_s = 0.3;
  std::int64_t confirmed_within_us = 50'000;
  std::int64_t opening_us = 300'000;  ///< from a pressed jaw to a lost rung, at most
  std::int64_t excused_us = 100'000;  ///< after the plant took a grasp away
  std::int64_t latch_reaction_us = 10'000;
  /// Of the master that is judged; frames of others only a master sends may come at any time and
  /// age. -1: whoever speaks as a master.
  int master_port = -1;

  /// Limits of the robot's page; drives as in `plant`.
  explicit MonitorParams(const PlantParams& plant);
};

struct Violation {
  std::int64_t time_us = 0;
  int invariant = 0;  ///< 1..9
  int place = -1;     ///< axis or leg, -1 = none
  std::string text;   ///< with the numbers
};
std::string describe(const Violation& violation);

enum class SessionEvent : std::uint8_t {
  kArmed,  ///< the operator armed this session; ends latched faults
  kDisarmed,
  kReset,  ///< the operator acknowledged: stop and bus fault are no longer latched
};

class Monitor {
 public:
  explicit Monitor(const MonitorParams& params);

  void on_frame(const CarriedFrame& carried);
  /// After each step of the plant; carries the lines as well.
  void on_truth(const PlantTruth& truth);
  void on_session(std::int64_t now_us, SessionEvent event);
  /// The controller says that it stopped, with its primary reason (0 = none told), or runs again.
  void on_stop(std::int64_t now_us, int reason);
  void on_run(std::int64_t now_us);
  /// The master's process does not run: what waits in its queue it cannot take back meanwhile.
  void on_pause(std::int64_t from_us, std::int64_t until_us);

  /// The first kMaxKept in order of time.
  const std::vector<Violation>& violations() const { return violations_; }
  std::int64_t num_violations() const { return num_violations_; }
  std::int64_t num_targets() const { return num_targets_; }  ///< checked: 0 means nothing was seen
  static constexpr std::size_t kMaxKept = 100;

 private:
  struct Axis {
    bool enabled = false;  ///< last control word was 0x0F
    bool has_target = false;
    std::int32_t target = 0;
    bool has_measured = false;
    std::int32_t measured = 0;
    std::int32_t stop_speed = 0;  ///< counts per cycle when the stop's reaction time ended
    bool operational = false;
  };
  struct Leg {
    bool confirmed = false;
    bool holds = false;
    std::int64_t confirmed_us = -1'000'000;
    std::int64_t taken_us = -1'000'000'000;  ///< by the plant
    bool open_commanded = false;
    std::int64_t told_open_us = -1'000'000'000;  ///< last target beyond where the jaw stands
    double held_jaw_rad = 0.0;                   ///< least angle on the rung that it holds, or held
  };

  void on_master_frame(const CarriedFrame& carried);
  void check_line(const CarriedFrame& carried);
  void on_target(const CarriedFrame& carried, int axis);
  void on_node_frame(const CarriedFrame& carried);
  void check_limits(std::int64_t now_us, int axis, std::int32_t target);
  void check_stop(std::int64_t now_us, int axis, std::int32_t target);
  void check_release(std::int64_t now_us, int axis, std::int32_t target);
  void check_loss(const PlantTruth& truth, int leg);
  void trigger_stop(std::int64_t now_us);
  int num_confirmed_others(int leg, std::int64_t since_us) const;
  bool plant_took_lately(std::int64_t now_us) const;
  double angle_rad(int axis, std::int32_t counts) const;
  static bool is_at_measured(const Axis& axis, std::int32_t target);
  void violate(std::int64_t now_us, int invariant, int place, std::string text);

  MonitorParams params_;
  std::array<Axis, kNumAxes> axes_;
  std::array<Leg, kNumLegs> legs_;
  bool armed_ = false;
  bool docked_ = true;
  bool fallen_ = false;
  bool has_truth_ = false;
  std::optional<std::int64_t> stop_since_us_;
  std::optional<std::int64_t> bus_fault_us_;
  std::optional<int> stop_reason_;
  std::int64_t paused_from_us_ = 0;
  std::int64_t paused_until_us_ = 0;
  std::vector<Violation> violations_;
  std::int64_t num_violations_ = 0;
  std::int64_t num_targets_ = 0;
};

}  // namespace simulator
