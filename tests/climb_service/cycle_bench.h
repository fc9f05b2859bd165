// SPDX-License-Identifier: BSD-3-Clause
// ControlCycle on the plant in virtual time: bus, lines, IMU and rungs as the live service has
// them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "can/cia402_bus.h"
#include "climb_controller/control_cycle.h"
#include "climb_controller/drive_layout.h"
#include "gpio/lines.h"
#include "robot_in_a_box/memory_transport.h"
#include "simulator/plant/monitor.h"
#include "simulator/plant/robot_plant.h"

namespace climb_controller {

constexpr std::uint64_t kSession = 0x5E5510;

/// The line to the simulated robot; what it costs is not the controller's.
class WatchedTransport final : public robot_in_a_box::MemoryTransport {
 public:
  using MemoryTransport::MemoryTransport;
  can::TransferStatus send(const can::CanFrame& frame) override {
    if (on_enter) on_enter();
    const can::TransferStatus status = MemoryTransport::send(frame);
    if (on_leave) on_leave();
    return status;
  }
  can::TransferStatus receive(can::ReceivedFrame& received) override {
    if (on_enter) on_enter();
    const can::TransferStatus status = MemoryTransport::receive(received);
    if (on_leave) on_leave();
    return status;
  }
  std::function<void()> on_enter;
  std::function<void()> on_leave;
};

inline CycleParams with_brakes() {
  CycleParams params;
  params.power_off_hold = PowerOffHold::kBrake;
  return params;
}

struct CycleBench {
  explicit CycleBench(const simulator::PlantParams& plant_params = {},
                      CycleParams params = with_brakes())
      : plant(plant_params, bus),
        transport(bus),
        monitor(simulator::MonitorParams(plant_params)),
        master(servo_bus_params({}, params.controller.climb), transport, &recorder),
        cycle(with_session(params), master),
        origin_m(plant.T_world_body().translation()) {
    bus.record(true);
  }

  static CycleParams with_session(CycleParams params) {
    params.controller.session_id = kSession;
    return params;
  }

  /// One period of 10 ms, the plant and the bus on a grid of 1 ms.
  void step() {
    for (int i = 0; i < 10; ++i) {
      now_us += 1000;
      plant.advance(now_us);
      transport.set_time(now_us);
      if (on_millisecond) on_millisecond();
      if (i < 9) cycle.poll(now_us);
    }
    see();
    if (before_step) before_step();
    cycle.step(now_us, inbox, report);
    if (after_step) after_step();
    inbox.command = {};
    carried = bus.take_carried();
    for (const simulator::CarriedFrame& frame : carried) monitor.on_frame(frame);
    monitor.on_truth(plant.truth());
    watch_session();
  }
  void run_s(double duration_s) {
    for (int i = 0; i < static_cast<int>(duration_s * 100.0 + 0.5); ++i) step();
  }
  bool reach(climb::ControllerState wanted, double within_s = 20.0) {
    for (int i = 0; i < static_cast<int>(within_s * 100.0); ++i) {
      if (state() == wanted) return true;
      step();
    }
    return state() == wanted;
  }
  climb::CommandVerdict order(climb::Order order) {
    inbox.command = {order, kSession, ++seq};
    step();
    for (int i = 0; i < 700 && report.is_resetting; ++i) step();
    return report.verdict;
  }

  climb::ControllerState state() const { return report.output.state; }
  climb::Fault reason() const { return report.output.reason; }
  std::string problems() const {
    std::string text = std::string(climb::name(state())) + ", reason " + climb::name(reason()) +
                       ", bus " + can::name(report.bus_phase) + ", refusal " +
                       climb::name(report.output.refusal) + "\n";
    for (const can::Fault& fault : report.bus_faults) {
      text += std::string(can::name(fault.cause)) + " axis " + std::to_string(fault.axis) + "\n";
    }
    for (const can::ObjectIssue& issue : report.issues) text += can::describe(issue) + "\n";
    return text + violations();
  }
  std::string violations() const {
    std::string text;
    for (const auto& violation : monitor.violations())
      text += simulator::describe(violation) + "\n";
    return text;
  }

  simulator::MemoryBus bus;
  simulator::RobotPlant plant;
  WatchedTransport transport;
  simulator::Monitor monitor;
  can::FlightRecorder recorder;
  can::Cia402Bus master;
  ControlCycle cycle;
  CycleInbox inbox;
  CycleReport report;
  Eigen::Vector3d origin_m;
  std::int64_t now_us = 0;
  std::int64_t seq = 0;
  bool sees = true;
  std::function<void()> before_step;  ///< round ControlCycle::step() alone, for measurements
  std::function<void()> after_step;
  gpio::Lines* lines = nullptr;  ///< null: the plant's levels, as they are
  std::function<void()> on_millisecond;
  std::vector<simulator::CarriedFrame> carried;  ///< in the last period

 private:
  void see() {
    see_lines();
    const simulator::ImuReading imu = plant.imu();
    inbox.imu = {imu.q_world_body, imu.specific_force_m_s2.norm(), true};
    if (!sees) return;
    rungs_.clear();
    stretches_.clear();
    for (int index = 0; index < plant.world().num_rungs(); ++index) {
      const simulator::LadderRung& rung = plant.world().rung(index);
      if (!rung.broken) add(index, rung);
    }
    inbox.ladder = {rungs_, stretches_, 0.0, true};
    inbox.ladder_received_us = now_us;
  }
  void see_lines() {
    if (lines != nullptr) {
      const gpio::LineStates& states = lines->poll(now_us);
      for (const climb::Leg leg : climb::kLegs) inbox.lines.touch[leg] = states.touch[leg];
      inbox.lines.estop_clear = !states.estop_active;
      inbox.lines.lost = states.lost;
      return;
    }
    const simulator::LineLevels levels = plant.lines();
    for (const climb::Leg leg : climb::kLegs) inbox.lines.touch[leg] = levels[leg];
    inbox.lines.estop_clear = levels[simulator::kEstopN];
  }
  void add(int index, const simulator::LadderRung& rung) {
    climb::RungView view;
    view.id = index + 1;
    view.trusted = true;
    view.confidence = 1.0;
    view.end0_m = rung.end0_m - origin_m;
    view.end1_m = rung.end1_m - origin_m;
    view.radius_m = rung.radius_m;
    view.covariance_m2 = 1e-6 * Eigen::Matrix3d::Identity();
    const double length_m = (view.end1_m - view.end0_m).norm();
    stretches_.push_back({static_cast<int>(rungs_.size()), 0.02, length_m - 0.02});
    rungs_.push_back(view);
  }
  void watch_session() {
    using climb::Order;
    if (report.order_seq != told_seq_ && report.verdict == climb::CommandVerdict::kAccepted) {
      told_seq_ = report.order_seq;
      if (report.order == Order::kArm) monitor.on_session(now_us, simulator::SessionEvent::kArmed);
      if (report.order == Order::kReset)
        monitor.on_session(now_us, simulator::SessionEvent::kReset);
    }
  }

  std::vector<climb::RungView> rungs_;
  std::vector<climb::StretchView> stretches_;
  std::int64_t told_seq_ = -1;
};

}  // namespace climb_controller
