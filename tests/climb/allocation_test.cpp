// SPDX-License-Identifier: BSD-3-Clause
// Once constructed, nothing in the motion library allocates.
#include <vector>

#include <gtest/gtest.h>

#include "climb/foot_line.h"
#include "climb/grasp_choice.h"
#include "climb/odometry.h"
#include "climb/path_clock.h"
#include "tests/climb/robot_poses.h"
#include "tests/support/allocation_counter.h"

namespace climb {
namespace {

using test_support::num_allocations;

// The counter works, or the test below would prove nothing.
TEST(Allocation, IsCounted) {
  static std::vector<int> kept;  // static: a compiler may leave out an allocation nobody sees
  std::size_t before = num_allocations();
  kept.resize(10);
  EXPECT_GT(num_allocations(), before);
  before = num_allocations();
  static Eigen::VectorXd numbers;
  numbers = Eigen::VectorXd::Zero(100);
  EXPECT_EQ(num_allocations() > before, test_support::counts_malloc());
}

// Statics (also bounded), lines, segments, stops, odometry and choice of a grasp: all on the stack
// or in what the constructors took.
TEST(Allocation, NoneAfterConstruction) {
  ClimbParams params;
  params.support.min_margin = 9.0;  // the bounded search runs
  const LegKinematics kinematics(params.robot);
  const Support support(params.robot, params.support);
  const Stance stance = climb_tests::hanging_stance(params);
  const LegLimits limits = leg_limits(kinematics, kFrontLeft);
  Odometry odometry(params.robot, params.odometry);
  GraspChoice choice(params);
  std::vector<RungView> rungs(5);
  std::vector<StretchView> stretches(5);
  for (int k = 0; k < 5; ++k) {
    rungs[k].id = k;
    rungs[k].trusted = true;
    rungs[k].confidence = 1.0;
    rungs[k].end0_m = Eigen::Vector3d(0.3 * k, 0.2, -0.28);
    rungs[k].end1_m = Eigen::Vector3d(0.3 * k, -0.2, -0.28);
    rungs[k].radius_m = 0.014;
    stretches[k] = {k, 0.02, 0.38};
  }
  GraspQuery query;
  query.from_m = Eigen::Vector3d(0.0, 0.15, -0.28);
  OdometryInput input;
  input.angles_rad = stance.angles_rad;
  input.weight = {1.0, 1.0, 1.0, 0.5};

  const std::size_t before = num_allocations();
  const RungLoss loss = support.check_rung_loss(stance);
  const FootLine line(kinematics, kFrontLeft, Eigen::Vector3d(0.3, 0.15, -0.23),
                      Eigen::Vector3d(0.3, 0.15, -0.28), {});
  const JointSegment segment(stance.angles_rad[kFrontLeft], LegAngles(0.0, 0.0, 1.0), limits);
  PathClock clock;
  for (int cycle = 0; cycle < 50; ++cycle) {
    clock.advance(0.01, cycle > 10, segment, limits);
    clock.advance(0.01, cycle > 10, line, limits);
    odometry.update(input);
  }
  const GraspDecision decision = choice.choose({rungs, stretches, 0.0, true}, query);
  const std::size_t after = num_allocations();
  EXPECT_EQ(after, before);
  EXPECT_EQ(decision.refusal, Refusal::kNone) << name(decision.refusal);
  EXPECT_GT(loss.num_remaining, 0);
}

}  // namespace
}  // namespace climb
