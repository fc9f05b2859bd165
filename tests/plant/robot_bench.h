// SPDX-License-Identifier: BSD-3-Clause
// The whole plant on an in-memory bus with a hand-made master of sixteen axes: frames written out
// by bytes, no controller code. Angles move by themselves towards their goals at a bounded speed.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "bench_master.h"
#include "simulator/plant/robot_plant.h"

namespace simulator {

struct RobotBench {
  explicit RobotBench(const PlantParams& params = {}, std::uint64_t seed = 1)
      : bus(seed), plant(params, bus), port(bus.attach()) {
    bus.record(true);
    advance(30'000);
  }

  void advance(std::int64_t by_us) {
    now_us += by_us;
    plant.advance(now_us);
    CarriedFrame received;
    while (bus.receive(port, now_us, received)) heard.push_back(received.frame);
    for (CarriedFrame& frame : bus.take_carried()) carried.push_back(frame);
  }
  void send(const BusFrame& frame) { bus.send(port, frame, now_us); }
  void write(int axis, int index, int subindex, std::uint32_t value, int num_bytes) {
    BusFrame frame =
        frame_of(0x601U + static_cast<std::uint32_t>(axis),
                 {0x23 | (4 - num_bytes) << 2, index & 0xFF, index >> 8, subindex, 0, 0, 0, 0});
    put_number(frame, 4, 4, value);
    send(frame);
  }

  void configure() {
    for (int axis = 0; axis < kNumAxes; ++axis) {
      const double scale = plant.drive(axis).params().counts_per_rad;
      write(axis, 0x6060, 0, 8, 1);
      write(axis, 0x60C2, 1, 10, 1);
      write(axis, 0x60C2, 2, 0xFD, 1);
      write(axis, 0x605A, 0, 6, 2);
      write(axis, 0x6007, 0, 3, 2);
      write(axis, 0x6085, 0, static_cast<std::uint32_t>(20.0 * scale), 4);
      write(axis, 0x1016, 1, (0x7FU << 16) | 150U, 4);
      write(axis, 0x1017, 0, 100, 2);
      write(axis, 0x1029, 1, 1, 1);
    }
    send(frame_of(0x000, {0x01, 0x00}));
    for (int axis = 0; axis < kNumAxes; ++axis) {
      goal_rad[static_cast<std::size_t>(axis)] = plant.drive(axis).measured_rad();
    }
    target_rad = goal_rad;
  }

  /// 10 ms: heartbeat when due, all targets, SYNC.
  void cycle(int control_word = 0x0F) {
    if (master_alive) {
      if (num_cycles % 5 == 0) send(frame_of(0x77F, {0x05}));
      for (int axis = 0; axis < kNumAxes; ++axis) send_target(axis, control_word);
      send(frame_of(0x080, {}));
    }
    ++num_cycles;
    advance(10'000);
  }
  void cycles(int num) {
    for (int i = 0; i < num; ++i) cycle();
  }
  void send_target(int axis, int control_word) {
    const auto index = static_cast<std::size_t>(axis);
    const double max_step = is_jaw(axis) ? 0.06 : 0.02;
    target_rad[index] += std::clamp(goal_rad[index] - target_rad[index], -max_step, max_step);
    BusFrame frame = frame_of(0x201U + static_cast<std::uint32_t>(axis), {0, 0, 0, 0, 0, 0, 0, 0});
    put_number(frame, 0, 2, static_cast<std::uint32_t>(control_word));
    put_number(frame, 2, 4,
               static_cast<std::uint32_t>(plant.drive(axis).counts(target_rad[index])));
    put_number(frame, 6, 2, is_jaw(axis) ? 1000 : 1500);
    send(frame);
  }
  void enable() {
    configure();
    for (const int word : {0x06, 0x07, 0x0F, 0x0F}) cycle(word);
  }

  void move_jaw(int leg, double angle_rad) {
    goal_rad[static_cast<std::size_t>(axis_of(leg, 3))] = angle_rad;
  }
  /// Commands the foot to a place in the world, given where the body is now.
  bool move_foot(int leg, const Eigen::Vector3d& p_world_m) {
    const auto angles =
        angles_for_foot(RobotGeometry{}, leg, plant.T_world_body().inverse() * p_world_m);
    if (!angles) return false;
    for (int joint = 0; joint < 3; ++joint) {
      goal_rad[static_cast<std::size_t>(axis_of(leg, joint))] = (*angles)[joint];
    }
    return true;
  }
  /// Foot onto the middle of its side of a rung, jaw closed.
  void grasp(int leg, int rung_index) {
    const double z = plant.world().rung(rung_index).end0_m.z();
    move_jaw(leg, 1.2);
    move_foot(leg, {0.0, 0.15 * left_sign(leg), z});
    cycles(60);
    move_jaw(leg, -0.6);
    cycles(60);
  }
  int num_frames(std::uint32_t id) const {
    return static_cast<int>(std::count_if(heard.begin(), heard.end(),
                                          [id](const BusFrame& frame) { return frame.id == id; }));
  }

  MemoryBus bus;
  RobotPlant plant;
  int port;
  std::int64_t now_us = 0;
  std::vector<BusFrame> heard;
  std::vector<CarriedFrame> carried;
  std::array<double, kNumAxes> goal_rad{};
  std::array<double, kNumAxes> target_rad{};
  int num_cycles = 0;
  bool master_alive = true;
};

/// Four claws closed on four rungs, enabled, no dock.
inline PlantParams gripping_params() {
  PlantParams params;
  params.start = PlantStart::kGripping;
  params.start_rung = {2, 2, 0, 0};
  return params;
}
inline void close_all(RobotBench& bench) {
  bench.enable();
  for (int leg = 0; leg < kNumLegs; ++leg) bench.move_jaw(leg, -0.6);
  bench.cycles(30);
}

}  // namespace simulator
