// SPDX-License-Identifier: BSD-3-Clause
// What one solve, one line of a foot and one distribution of forces cost (docs/BENCHMARKS.md).
#include <array>
#include <vector>

#include <benchmark/benchmark.h>

#include "climb/foot_line.h"
#include "climb/support.h"
#include "tests/climb/robot_poses.h"

namespace {

constexpr int kNumFeet = 1024;

std::vector<Eigen::Vector3d> random_feet(const climb::LegKinematics& kinematics) {
  base::Rng rng(1);
  std::vector<Eigen::Vector3d> feet;
  for (int i = 0; i < kNumFeet; ++i) {
    const climb::LegAngles q =
        climb_tests::random_pose(rng, climb::RobotParams(), kinematics, climb::kFrontLeft);
    feet.push_back(kinematics.foot_m(climb::kFrontLeft, q));
  }
  return feet;
}

void BM_climb_inverse(benchmark::State& state) {
  const climb::LegKinematics kinematics{climb::RobotParams()};
  const std::vector<Eigen::Vector3d> feet = random_feet(kinematics);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(kinematics.inverse(climb::kFrontLeft, feet[i++ % kNumFeet]));
  }
}
BENCHMARK(BM_climb_inverse);

void BM_climb_forward_and_jacobian(benchmark::State& state) {
  const climb::LegKinematics kinematics{climb::RobotParams()};
  climb::LegAngles q(0.1, -0.6, 1.2);
  for (auto _ : state) {
    benchmark::DoNotOptimize(q);
    benchmark::DoNotOptimize(kinematics.foot_m(climb::kFrontLeft, q));
    benchmark::DoNotOptimize(kinematics.jacobian(climb::kFrontLeft, q));
  }
}
BENCHMARK(BM_climb_forward_and_jacobian);

/// Contact forces and feed-forward torques of one control cycle.
void BM_climb_gravity_feed_forward(benchmark::State& state) {
  const climb::ClimbParams params;
  const climb::Support support(params.robot, params.support);
  const climb::Stance stance = climb_tests::hanging_stance(params);
  for (auto _ : state) {
    const climb::ContactForces forces = support.distribute(stance);
    benchmark::DoNotOptimize(support.torques_Nm(stance, forces));
  }
}
BENCHMARK(BM_climb_gravity_feed_forward);

/// Made once per approach, at a change of state: 65 points checked and their speeds.
void BM_climb_foot_line(benchmark::State& state) {
  const climb::LegKinematics kinematics{climb::RobotParams()};
  const Eigen::Vector3d from(0.3, 0.15, -0.23);
  const Eigen::Vector3d to(0.3, 0.15, -0.28);
  for (auto _ : state) {
    const climb::FootLine line(kinematics, climb::kFrontLeft, from, to, {0.05, 1.0});
    benchmark::DoNotOptimize(line.duration_s());
  }
}
BENCHMARK(BM_climb_foot_line);

/// The dear case: least forces beyond the limits, every iteration used.
void BM_climb_bounded_support(benchmark::State& state) {
  climb::ClimbParams params;
  params.robot.hip.max_torque_Nm = 0.5;
  const climb::Support support(params.robot, params.support);
  const climb::Stance stance = climb_tests::hanging_stance(climb::ClimbParams());
  for (auto _ : state) benchmark::DoNotOptimize(support.check(stance));
}
BENCHMARK(BM_climb_bounded_support);

}  // namespace
