// SPDX-License-Identifier: BSD-3-Clause
// The climbing robot in one process and in virtual time: the live service's control cycle, the real
// CiA 402 master, and the plant with its bus, lines and IMU. One millisecond after another, the
// same for the same seed and the same calls. Rungs come from truth, with an error.
#pragma once

#include <cstdint>
#include <optional>

#include "can/cia402_bus.h"
#include "climb/attitude.h"
#include "climb_controller/control_cycle.h"
#include "climb_controller/cycle_clock.h"
#include "climb_controller/drive_layout.h"
#include "climb_controller/slots.h"
#include "gpio/lines.h"
#include "robot_in_a_box/memory_chip.h"
#include "robot_in_a_box/memory_transport.h"
#include "robot_in_a_box/perceived_ladder.h"
#include "simulator/plant/monitor.h"
#include "simulator/plant/quasi_static.h"

namespace robot_in_a_box {

/// As constructed, but for the drives of the plant: they have brakes.
inline climb_controller::CycleParams cycle_with_brakes() {
  climb_controller::CycleParams params;
  params.power_off_hold = climb_controller::PowerOffHold::kBrake;
  return params;
}

struct ClimbBoxParams {
  std::uint64_t seed = 1;
  simulator::PlantParams plant;
  simulator::MakeMechanics mechanics = simulator::make_quasi_static;
  PerceptionParams perception;
  climb_controller::CycleParams cycle = cycle_with_brakes();  ///< session id: from the seed
  climb_controller::DriveLayout drives;
  std::int64_t bus_latency_us = 300;  ///< of a frame
  /// The attitude from accelerometer and gyroscope, as the live service has it; else the true one.
  bool attitude_from_samples = false;
};

/// Sees what an observer outside the controller sees, in order of time.
class BoxWatcher {
 public:
  virtual ~BoxWatcher() = default;
  /// Before the plant moves on to this millisecond: the place for things to happen.
  virtual void before(std::int64_t now_us) = 0;
  virtual void on_frame(const simulator::CarriedFrame& carried) = 0;
  virtual void on_truth(const simulator::PlantTruth& truth) = 0;
  /// After each cycle of the controller.
  virtual void on_report(const climb_controller::CycleReport& report) = 0;
};

class ClimbBox {
 public:
  static constexpr std::int64_t kCycle_us = 10'000;
  static constexpr std::int64_t kStep_us = 1'000;

  explicit ClimbBox(const ClimbBoxParams& params);
  ClimbBox(const ClimbBox&) = delete;
  ClimbBox& operator=(const ClimbBox&) = delete;

  /// Up to and including the next cycle of the controller.
  void cycle();

  /// In the next cycle, with this run's session and the next number.
  void order(climb::Order what) { order({what, session_id(), ++last_seq_}); }
  /// As the message that the operator's tool sends; refused where too many wait already.
  void order(const climb::OperatorCommand& command);
  std::uint64_t session_id() const { return cycle_->session_id(); }
  std::int64_t last_seq() const { return last_seq_; }

  std::int64_t now_us() const { return now_us_; }
  const climb_controller::CycleReport& report() const { return report_; }
  climb::ControllerState state() const { return report_.output.state; }
  const climb::Controller& controller() const { return cycle_->controller(); }

  simulator::RobotPlant& plant() { return plant_; }
  const simulator::RobotPlant& plant() const { return plant_; }
  simulator::MemoryBus& bus() { return bus_; }
  simulator::Monitor& monitor() { return monitor_; }
  const simulator::Monitor& monitor() const { return monitor_; }
  PerceivedLadder& perception() { return perception_; }
  const PerceivedLadder& perception() const { return perception_; }
  MemoryChip& chip() { return chip_; }
  /// As the controller estimates it.
  Eigen::Isometry3d T_odom_body() const;
  int master_port() const { return transport_.port(); }

  /// From somebody else on the bus.
  void send_foreign(const simulator::BusFrame& frame);

  // --- what may happen to the controller's process and its sensors -------------------------------
  void kill() { pause_until(INT64_MAX); }  ///< gone, without a word
  void start_anew();                       ///< after kill(): another session, which knows nothing
  void hang(std::int64_t duration_us) { pause_until(now_us_ + duration_us); }
  void flag_fault(climb::Fault fault) { flags_ |= climb::flag(fault); }  ///< found by the service
  void clear_flag(climb::Fault fault) { flags_ &= ~climb::flag(fault); }
  /// SIGTERM: what the live service does then, until the process is gone.
  void terminate();
  bool has_ended() const { return num_ending_cycles_ >= climb_controller::kHandOverCycles; }
  void sleep(std::int64_t duration_us) { slept_us_ += duration_us; }  ///< of the machine
  bool imu_silent = false;
  bool imu_falls = false;
  Eigen::Quaterniond imu_turn = Eigen::Quaterniond::Identity();  ///< added to what it tells

  void watch(BoxWatcher* watcher) { watcher_ = watcher; }
  /// Rungs come from there and no longer from truth; outlives the box.
  void see_with(Eyes& eyes) { eyes_ = &eyes; }
  /// FNV-1a over all that crossed the bus: equal runs, equal numbers.
  std::uint64_t frame_hash() const { return frame_hash_; }

 private:
  void make_controller();
  void pause_until(std::int64_t until_us);
  void millisecond();
  void observe();
  void step();
  void read_imu();
  void tell_monitor();
  void end_when_possible();
  void hash(const simulator::CarriedFrame& carried);

  ClimbBoxParams params_;
  simulator::MemoryBus bus_;
  simulator::RobotPlant plant_;
  int foreign_port_;
  MemoryTransport transport_;
  MemoryChip chip_;
  PerceivedLadder perception_;
  Eyes* eyes_ = &perception_;
  simulator::Monitor monitor_;

  std::int64_t now_us_ = 0;
  std::int64_t slept_us_ = 0;
  std::int64_t hung_until_us_ = 0;
  BoxWatcher* watcher_ = nullptr;
  std::uint64_t frame_hash_ = 0xCBF29CE484222325ULL;

  // --- what is the controller's process, and goes with it
  // -----------------------------------------
  std::optional<gpio::Lines> lines_;
  std::optional<can::Cia402Bus> master_;
  std::optional<climb_controller::ControlCycle> cycle_;
  std::uint64_t num_starts_ = 0;
  climb_controller::CycleClock clock_{climb_controller::CycleClockParams{}};
  std::int64_t imu_heard_us_ = -1'000'000'000;
  climb::Attitude attitude_{climb::AttitudeParams{}};
  climb_controller::CycleInbox inbox_;
  climb_controller::CycleReport report_;
  climb_controller::BoundedQueue<climb::OperatorCommand, 16> orders_;
  bool terminating_ = false;
  int num_ending_cycles_ = 0;
  std::int64_t last_seq_ = 0;
  climb::FaultFlags flags_ = 0;
  climb::ControllerState told_state_ = climb::ControllerState::kBoot;
  std::int64_t told_seq_ = -1;
  bool was_resetting_ = false;
};

}  // namespace robot_in_a_box
