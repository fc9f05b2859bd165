// SPDX-License-Identifier: BSD-3-Clause
#include "robot_in_a_box/climb_box.h"

#include <array>
#include <bit>

#include "climb_controller/convert.h"
#include "ladder_msgs/command_t.hpp"

namespace robot_in_a_box {
namespace {

using climb::ControllerState;
using simulator::SessionEvent;

constexpr std::int64_t kImuLost_us = 100'000;

climb_controller::CycleParams cycle_params(const ClimbBoxParams& params, std::uint64_t num_starts) {
  climb_controller::CycleParams cycle = params.cycle;
  const std::uint64_t stream = num_starts == 0 ? 1 : 1000 + num_starts;
  cycle.controller.session_id = base::Rng(params.seed, stream).next() | 1U;
  return cycle;
}

simulator::MonitorParams monitor_params(const ClimbBoxParams& params, int master_port) {
  simulator::MonitorParams monitor(params.plant);
  monitor.master_port = master_port;
  return monitor;
}

}  // namespace

ClimbBox::ClimbBox(const ClimbBoxParams& params)
    : params_(params),
      bus_(params.seed, params.bus_latency_us),
      plant_(params.plant, bus_, params.mechanics),
      foreign_port_(bus_.attach(127)),
      transport_(bus_),
      chip_(plant_),
      perception_(params.perception, params.seed),
      monitor_(monitor_params(params, transport_.port())) {
  make_controller();
  bus_.record(true);
  monitor_.on_truth(plant_.truth());
}

void ClimbBox::make_controller() {
  cycle_.reset();
  master_.emplace(servo_bus_params(params_.drives, params_.cycle.controller.climb), transport_);
  cycle_.emplace(cycle_params(params_, num_starts_), *master_);
  lines_.emplace(gpio::LinesParams{}, chip_);
  ++num_starts_;
}

void ClimbBox::start_anew() {
  for (can::ReceivedFrame unread; transport_.receive(unread) == can::TransferStatus::kDone;) {
  }
  transport_.purge_transmit_queue();
  make_controller();
  clock_ = climb_controller::CycleClock(climb_controller::CycleClockParams{});
  attitude_ = climb::Attitude(climb::AttitudeParams{});
  imu_heard_us_ = -1'000'000'000;
  inbox_ = {};
  report_ = {};
  for (climb::OperatorCommand unread; orders_.pop(unread);) continue;
  terminating_ = false;
  num_ending_cycles_ = 0;
  last_seq_ = 0;
  flags_ = 0;
  told_state_ = ControllerState::kBoot;
  told_seq_ = -1;
  was_resetting_ = false;
  pause_until(now_us_);
  monitor_.on_session(now_us_, SessionEvent::kDisarmed);
  monitor_.on_run(now_us_);
}

Eigen::Isometry3d ClimbBox::T_odom_body() const {
  return report_.output.pose.T_odom_body();
}

void ClimbBox::send_foreign(const simulator::BusFrame& frame) {
  bus_.send(foreign_port_, frame, now_us_);
}

void ClimbBox::cycle() {
  const std::int64_t end_us = now_us_ + kCycle_us;
  while (now_us_ < end_us) millisecond();
  if (now_us_ >= hung_until_us_) step();
}

void ClimbBox::pause_until(std::int64_t until_us) {
  hung_until_us_ = until_us;
  monitor_.on_pause(now_us_, until_us);
}

void ClimbBox::millisecond() {
  now_us_ += kStep_us;
  if (watcher_ != nullptr) watcher_->before(now_us_);
  plant_.advance(now_us_);
  eyes_->look(now_us_, plant_, report_);
  transport_.set_time(now_us_);
  observe();
  if (now_us_ < hung_until_us_ || now_us_ % kCycle_us == 0) return;
  lines_->poll(now_us_);
  cycle_->poll(now_us_);
}

void ClimbBox::observe() {
  for (const simulator::CarriedFrame& carried : bus_.take_carried()) {
    hash(carried);
    monitor_.on_frame(carried);
    if (watcher_ != nullptr) watcher_->on_frame(carried);
  }
  for (simulator::CarriedFrame unread; bus_.receive(foreign_port_, now_us_, unread);) continue;
  const simulator::PlantTruth truth = plant_.truth();
  monitor_.on_truth(truth);
  if (watcher_ != nullptr) watcher_->on_truth(truth);
}

void ClimbBox::step() {
  const gpio::LineStates& lines = lines_->poll(now_us_);
  for (const climb::Leg leg : climb::kLegs) inbox_.lines.touch[leg] = lines.touch[leg];
  inbox_.lines.estop_clear = !lines.estop_active;
  inbox_.lines.lost = lines.lost;

  read_imu();
  inbox_.ladder = eyes_->view();
  inbox_.ladder_received_us = eyes_->received_us();
  inbox_.command = {};
  orders_.pop(inbox_.command);
  inbox_.faults = flags_ | clock_.begin(now_us_, now_us_ + slept_us_);
  cycle_->step(now_us_, inbox_, report_);
  tell_monitor();
  if (terminating_) end_when_possible();
  if (watcher_ != nullptr) watcher_->on_report(report_);
}

void ClimbBox::read_imu() {
  const simulator::ImuReading told = plant_.imu();
  attitude_.add({now_us_, told.specific_force_m_s2, told.angular_rate_rad_s});
  if (!imu_silent) {
    inbox_.imu.q_odom_body =
        (params_.attitude_from_samples ? attitude_.q_odom_body() : told.q_world_body) * imu_turn;
    inbox_.imu.acceleration_m_s2 = imu_falls ? 0.0 : told.specific_force_m_s2.norm();
    imu_heard_us_ = now_us_;
  }
  inbox_.imu.valid = now_us_ - imu_heard_us_ <= kImuLost_us;
}

void ClimbBox::tell_monitor() {
  if (report_.order_seq != told_seq_ && report_.verdict == climb::CommandVerdict::kAccepted) {
    if (report_.order == climb::Order::kArm) monitor_.on_session(now_us_, SessionEvent::kArmed);
    if (report_.order == climb::Order::kReset) monitor_.on_session(now_us_, SessionEvent::kReset);
  }
  told_seq_ = report_.order_seq;
  // A reset is taken at once; its answer waits for the bus.
  if (report_.is_resetting && !was_resetting_) monitor_.on_session(now_us_, SessionEvent::kReset);
  was_resetting_ = report_.is_resetting;
  const ControllerState now = state();
  const bool came_down =
      now == ControllerState::kDisarmed &&
      (told_state_ == ControllerState::kDisarming || told_state_ == ControllerState::kArming);
  if (came_down) monitor_.on_session(now_us_, SessionEvent::kDisarmed);
  if (now != told_state_) monitor_.on_run(now_us_);
  const bool stopped = is_latched(now) || now == ControllerState::kProtectiveHold;
  if (stopped) {
    const bool told = report_.output.reason != climb::Fault::kNone;
    monitor_.on_stop(now_us_, told ? static_cast<int>(report_.output.reason) + 1 : 0);
  }
  told_state_ = now;
}

void ClimbBox::order(const climb::OperatorCommand& command) {
  ladder_msgs::command_t told;
  told.utime = now_us_;
  told.seq = command.seq;
  told.session_id = static_cast<std::int64_t>(command.session_id);
  told.order = static_cast<std::int8_t>(command.order);
  std::array<std::uint8_t, 64> bytes;
  const int size = told.encode(bytes.data(), 0, bytes.size());
  ladder_msgs::command_t heard;
  const bool is_whole = heard.decode(bytes.data(), 0, size) == size;
  if (is_whole) orders_.push(climb_controller::to_command(heard));
}

void ClimbBox::terminate() {
  terminating_ = true;
  flag_fault(climb::Fault::kTerminate);
}

void ClimbBox::end_when_possible() {
  if (num_ending_cycles_ == 0 && climb_controller::finishes_first(state())) return;
  if (num_ending_cycles_ == 0) cycle_->hand_over();
  if (++num_ending_cycles_ == climb_controller::kHandOverCycles) kill();
}

void ClimbBox::hash(const simulator::CarriedFrame& carried) {
  const auto mix = [this](std::uint64_t value) {
    frame_hash_ = (frame_hash_ ^ value) * 0x100000001B3ULL;
  };
  mix(static_cast<std::uint64_t>(carried.time_us));
  mix(carried.frame.id);
  mix(carried.frame.length);
  mix(std::bit_cast<std::uint64_t>(carried.frame.bytes));
}

}  // namespace robot_in_a_box
