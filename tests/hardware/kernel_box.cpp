// SPDX-License-Identifier: BSD-3-Clause
#include "tests/hardware/kernel_box.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <poll.h>

namespace hardware {
namespace {

using climb::ControllerState;
using simulator::SessionEvent;

constexpr std::uint64_t kSession = 0x5E5510;
/// What an emulated machine may be late; added to the monitor's times.
constexpr std::int64_t kAllowed_us = 50'000;

std::int64_t monotonic_us() {
  using std::chrono::steady_clock;
  return std::chrono::duration_cast<std::chrono::microseconds>(
             steady_clock::now().time_since_epoch())
      .count();
}

climb_controller::CycleParams cycle_params() {
  climb_controller::CycleParams params;
  params.power_off_hold = climb_controller::PowerOffHold::kBrake;
  params.controller.session_id = kSession;
  return params;
}

simulator::MonitorParams monitor_params(const KernelBoxParams& params) {
  simulator::MonitorParams monitor(params.plant);
  monitor.cycle_us = params.cycle_us;
  monitor.stop_reaction_us += kAllowed_us;
  monitor.stop_run_out_us += kAllowed_us;
  monitor.confirmed_within_us += kAllowed_us;
  monitor.latch_reaction_us += kAllowed_us;
  return monitor;
}

/// What only a master sends: SYNC, and RPDO 1 of the sixteen axes.
bool is_master_cycle(const simulator::BusFrame& frame) {
  return frame.id == 0x080 || (frame.id > 0x200 && frame.id <= 0x210);
}

}  // namespace

KernelBox::KernelBox(const KernelBoxParams& params)
    : params_(params),
      start_us_(monotonic_us()),
      plant_(params.plant, bus_),
      hub_(bus_, simulator::open_gateway(params.plant_interface)),
      wires_(params.chip_folder, {0, 1, 2, 3, 4}),
      monitor_(monitor_params(params)),
      perception_({}, 1),
      socket_(can::CanSocketParams{params.controller_interface}),
      master_(climb_controller::servo_bus_params({}, cycle_params().controller.climb), socket_,
              &recorder_),
      chip_(gpio::make_line_chip(gpio::LinesParams{})),
      lines_(gpio::LinesParams{}, *chip_),
      cycle_(cycle_params(), master_) {
  bus_.record(true);
  monitor_.on_truth(plant_.truth());
  // gpio-sim lets a requested bias move the wire, a real switch does not: each is driven once more.
  lines_.open();
  for (int line = 0; line < simulator::kNumLines; ++line) wires_.publish(plant_.lines());
}

std::int64_t KernelBox::now_us() const {
  return monotonic_us() - start_us_;
}

void KernelBox::cycle() {
  due_us_ += params_.cycle_us;
  while (now_us() < due_us_) {
    wait();
    step_plant();
    if (now_us() < due_us_) cycle_.poll(now_us());
  }
  const std::int64_t late_us = now_us() - due_us_;
  worst_late_us = std::max(worst_late_us, late_us);
  if (late_us > params_.cycle_us) {
    ++num_overruns;
    due_us_ += late_us / params_.cycle_us * params_.cycle_us;
  }
  ++num_cycles;
  step_controller();
}

/// Until a frame or an edge comes, at most one step of the plant.
void KernelBox::wait() {
  std::vector<pollfd> waiting = {{socket_.fd(), POLLIN, 0}, {lines_.wake_fd(), POLLIN, 0}};
  hub_.gateway().add_to_poll(waiting);
  ::poll(waiting.data(), waiting.size(), 1);
}

void KernelBox::step_plant() {
  if (happen_ && now_us() >= happens_us_) std::exchange(happen_, nullptr)();
  const std::int64_t at_us = now_us();
  hub_.take_in(at_us);
  plant_.advance(at_us);
  hub_.give_out(at_us);
  wires_.publish(plant_.lines());
  perception_.update(at_us, plant_, report_.output.pose.T_odom_body());
  for (const simulator::CarriedFrame& carried : bus_.take_carried()) {
    if (is_master_cycle(carried.frame)) master_heard_us_ = carried.time_us;
    monitor_.on_frame(carried);
  }
  monitor_.on_truth(plant_.truth());
}

void KernelBox::step_controller() {
  const gpio::LineStates& lines = lines_.poll(now_us());
  for (const climb::Leg leg : climb::kLegs) inbox_.lines.touch[leg] = lines.touch[leg];
  inbox_.lines.estop_clear = !lines.estop_active;
  inbox_.lines.lost = lines.lost;
  const simulator::ImuReading imu = plant_.imu();
  inbox_.imu = {imu.q_world_body, imu.specific_force_m_s2.norm(), true};
  inbox_.ladder = perception_.view();
  inbox_.ladder_received_us = perception_.received_us();
  inbox_.command = command_;
  command_ = {};
  cycle_.step(now_us(), inbox_, report_);
  tell_monitor();
}

void KernelBox::tell_monitor() {
  if (report_.order_seq != told_seq_ && report_.verdict == climb::CommandVerdict::kAccepted) {
    if (report_.order == climb::Order::kArm) monitor_.on_session(now_us(), SessionEvent::kArmed);
  }
  told_seq_ = report_.order_seq;
  if (state() == ControllerState::kDisarmed && told_state_ != state()) {
    monitor_.on_session(now_us(), SessionEvent::kDisarmed);
  }
  if (state() != told_state_) monitor_.on_run(now_us());
  if (is_latched(state()) || state() == ControllerState::kProtectiveHold) {
    monitor_.on_stop(now_us(), static_cast<int>(reason()) + 1);
  }
  told_state_ = state();
}

void KernelBox::at(std::int64_t time_us, std::function<void()> happen) {
  happens_us_ = time_us;
  happen_ = std::move(happen);
}

void KernelBox::run_s(double duration_s) {
  const std::int64_t end_us = now_us() + static_cast<std::int64_t>(1e6 * duration_s);
  while (now_us() < end_us) cycle();
}

bool KernelBox::reach(ControllerState wanted, double within_s) {
  const std::int64_t end_us = now_us() + static_cast<std::int64_t>(1e6 * within_s);
  while (state() != wanted && now_us() < end_us) cycle();
  return state() == wanted;
}

climb::CommandVerdict KernelBox::order(climb::Order what) {
  command_ = {what, kSession, ++seq_};
  // The bus speaks again while the reset is under way, before it is answered.
  if (what == climb::Order::kReset) monitor_.on_session(now_us(), SessionEvent::kReset);
  cycle();
  while (report_.is_resetting) cycle();
  return report_.verdict;
}

std::string KernelBox::problems() const {
  std::string text = std::string(climb::name(state())) + ", reason " + climb::name(reason()) +
                     ", bus " + can::name(report_.bus_phase) + ", refusal " +
                     climb::name(report_.output.refusal) + "\n";
  for (const can::Fault& fault : report_.bus_faults) {
    text += std::string(can::name(fault.cause)) + " axis " + std::to_string(fault.axis) +
            " detail " + std::to_string(fault.detail) + "\n";
  }
  for (const can::ObjectIssue& issue : report_.issues) text += can::describe(issue) + "\n";
  for (const simulator::Violation& violation : monitor_.violations()) {
    text += simulator::describe(violation) + "\n";
  }
  return text;
}

}  // namespace hardware
