// SPDX-License-Identifier: BSD-3-Clause
// Stopping on a path and running on.
#include "climb/path_clock.h"

#include <gtest/gtest.h>

#include "climb/foot_line.h"
#include "tests/climb/robot_poses.h"

namespace climb {
namespace {

constexpr double kCycle_s = 0.01;
const LegKinematics kKinematics{RobotParams()};
const LegLimits kLimits = leg_limits(kKinematics, kFrontLeft);

/// Speed up to 1 rad/s at constant speed for ever: a path whose stop is known in closed form.
struct ConstantSpeed {
  JointSample at(double t_s) const {
    return {LegAngles(0.0, t_s, 0.0), LegAngles(0.0, 1.0, 0.0), LegAngles::Zero()};
  }
};

// Without a stop path time is time.
TEST(PathClock, RunsAsTimeRuns) {
  PathClock clock;
  for (int i = 0; i < 100; ++i) clock.advance(kCycle_s, false, ConstantSpeed(), kLimits);
  EXPECT_NEAR(clock.path_time_s(), 1.0, 1e-12);
  clock.advance(climb_tests::kNan, true, ConstantSpeed(), kLimits);
  clock.advance(-1.0, true, ConstantSpeed(), kLimits);
  EXPECT_NEAR(clock.path_time_s(), 1.0, 1e-12);
}

// From constant speed v the stop takes v/a and v^2/2a: no stop within the limit is shorter.
TEST(PathClock, StopsInTheShortestTime) {
  PathClock clock;
  int num_cycles = 0;
  while (!clock.stands()) {
    clock.advance(kCycle_s, true, ConstantSpeed(), kLimits);
    ASSERT_LT(++num_cycles, 100);
  }
  EXPECT_LE(num_cycles, 11);                     // 1 rad/s at 10 rad/s^2, one cycle rounding
  EXPECT_NEAR(clock.path_time_s(), 0.05, 1e-6);  // 1 / 20 rad
  for (int i = 0; i < 20; ++i) clock.advance(kCycle_s, true, ConstantSpeed(), kLimits);
  EXPECT_NEAR(clock.path_time_s(), 0.05, 1e-6);
}

/// Cycles from the stop at `stop_s` until the path stands.
template <typename Path>
int num_cycles_to_stand(const Path& path, double stop_s) {
  PathClock clock;
  while (clock.path_time_s() < stop_s) clock.advance(kCycle_s, false, path, kLimits);
  int num_cycles = 0;
  for (; !clock.stands() && num_cycles < 100; ++num_cycles) {
    clock.advance(kCycle_s, true, path, kLimits);
  }
  return num_cycles;
}

// However fast a path was asked for, it stands 150 ms after a stop (one cycle rounding), wherever
// it is stopped: what joints cannot stop from in that time is not planned.
TEST(PathClock, StandsWithinTheContractsTime) {
  base::Rng rng(41);
  int num_lines = 0;
  for (int i = 0; i < 2000; ++i) {
    const LegAngles from = climb_tests::random_angles(rng, kKinematics, kFrontLeft);
    const LegAngles to = climb_tests::random_angles(rng, kKinematics, kFrontLeft);
    const JointSegment segment(from, to, kLimits);
    ASSERT_LE(num_cycles_to_stand(segment, segment.duration_s() * rng.uniform()), 16) << i;
    const FootLine line(kKinematics, kFrontLeft, kKinematics.foot_m(kFrontLeft, from),
                        kKinematics.foot_m(kFrontLeft, to), {2.0, 50.0});
    if (line.reach() != Reach::kReachable) continue;
    ++num_lines;
    ASSERT_LE(num_cycles_to_stand(line, line.duration_s() * rng.uniform()), 16) << i;
  }
  EXPECT_GT(num_lines, 50);
}

// Stopped anywhere on random segments, the joints stand within v/a, never pass the segment's end,
// never turn back, and no commanded step asks more than the acceleration limit.
TEST(PathClock, NeverOvershoots) {
  base::Rng rng(40);
  double most = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const LegAngles from = climb_tests::random_angles(rng, kKinematics, kFrontLeft);
    const LegAngles to = climb_tests::random_angles(rng, kKinematics, kFrontLeft);
    const JointSegment segment(from, to, kLimits);
    PathClock clock;
    const double stop_s = segment.duration_s() * rng.uniform();
    LegAngles before = from;
    LegAngles last = from;
    int num_stopping = 0;
    for (int cycle = 0; cycle < 1000 && !clock.stands(); ++cycle) {
      const bool stop = cycle * kCycle_s >= stop_s;
      clock.advance(kCycle_s, stop, segment, kLimits);
      num_stopping += stop ? 1 : 0;
      const LegAngles here = segment.at(clock.path_time_s()).angles_rad;
      for (int joint = 0; joint < kNumLegJoints; ++joint) {
        const auto [low, high] = std::minmax(from[joint], to[joint]);
        ASSERT_GE(here[joint], low - 1e-12);
        ASSERT_LE(here[joint], high + 1e-12);
        const double step = here[joint] - last[joint];
        ASSERT_GE(step * (to[joint] - from[joint]), -1e-15);
        const double bend = (step - (last[joint] - before[joint])) / (kCycle_s * kCycle_s);
        most = std::max(most, std::abs(bend) / kLimits[joint].max_acceleration_rad_s2);
      }
      before = last;
      last = here;
    }
    ASSERT_LE(num_stopping, 27);  // 2.5 rad/s at 10 rad/s^2 = 250 ms, and rounding
  }
  EXPECT_LE(most, 1.03);  // bends within a millisecond are not seen
}

// Stopped and let go again at random, a segment still ends exactly at its end.
TEST(PathClock, RunsOnToTheEnd) {
  base::Rng rng(41);
  for (int i = 0; i < 500; ++i) {
    const LegAngles to = climb_tests::random_angles(rng, kKinematics, kFrontLeft);
    const JointSegment segment(LegAngles(0.0, 0.0, 1.0), to, kLimits);
    PathClock clock;
    bool stop = false;
    int num_cycles = 0;
    while (clock.path_time_s() < segment.duration_s()) {
      if (rng.below(20) == 0) stop = !stop;
      if (num_cycles > 500) stop = false;
      clock.advance(kCycle_s, stop, segment, kLimits);
      ASSERT_GE(clock.rate(), 0.0);
      ASSERT_LE(clock.rate(), 1.0);
      ASSERT_LT(++num_cycles, 2000);
    }
    ASSERT_EQ(segment.at(clock.path_time_s()).angles_rad, to);
  }
}

// A foot stopped in its approach stays on its line.
TEST(PathClock, StopsAFootOnItsLine) {
  const Eigen::Vector3d from(0.3, 0.15, -0.23);
  const Eigen::Vector3d to(0.3, 0.15, -0.28);
  const FootLine line(kKinematics, kFrontLeft, from, to, {0.05, 1.0});
  PathClock clock;
  for (int cycle = 0; cycle < 400 && !clock.stands(); ++cycle) {
    clock.advance(kCycle_s, cycle >= 60, line, kLimits);
  }
  EXPECT_TRUE(clock.stands());
  const Eigen::Vector3d foot =
      kKinematics.foot_m(kFrontLeft, line.at(clock.path_time_s()).angles_rad);
  EXPECT_LE((foot - from).cross(Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_GT(foot.z(), to.z());
}

}  // namespace
}  // namespace climb
