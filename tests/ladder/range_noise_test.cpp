// SPDX-License-Identifier: BSD-3-Clause
// What noise along the view does to bars, and what is left when it is taken out.
#include "ladder/range_noise.h"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "base/rng.h"
#include "ladder/bar_nodes.h"
#include "ladder/chain_growth.h"
#include "ladder/ladder.h"
#include "ladder/principal_axis.h"
#include "tests/support/ladder_scene.h"

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kShare = 0.02;

// Nothing, a point, a sheet without volume, no view and no number are left as they are.
TEST(RangeNoise, LeavesWhatHasNoVolume) {
  const Vector3d view_m(1.5, 0.0, 0.0);
  EXPECT_EQ(ladder::without_range_noise(Matrix3d::Zero(), view_m, kShare), Matrix3d::Zero());
  const Matrix3d sheet = Vector3d(1e-3, 1e-3, 0.0).asDiagonal();
  EXPECT_EQ(ladder::without_range_noise(sheet, view_m, kShare), sheet);
  const Matrix3d round = 1e-4 * Matrix3d::Identity();
  EXPECT_EQ(ladder::without_range_noise(round, Vector3d::Zero(), kShare), round);
  Matrix3d broken = round;
  broken(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(ladder::without_range_noise(broken, view_m, kShare)(1, 1)));
}

// What is taken out lies along the view, is no more than the share allows, and never more than
// there is: no variance falls below zero.
TEST(RangeNoise, TakesNoMoreThanThereIs) {
  base::Rng rng(5);
  for (int trial = 0; trial < 500; ++trial) {
    Matrix3d a;
    for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = 0.05 * rng.gaussian();
    const Matrix3d before = a * a.transpose();
    const Vector3d view_m(1.0 + rng.uniform(), rng.gaussian(), rng.gaussian());
    const Matrix3d after = ladder::without_range_noise(before, view_m, kShare);
    const Matrix3d taken = before - after;
    const Vector3d view = view_m.normalized();
    const double noise_m2 = taken.trace();
    EXPECT_GE(noise_m2, 0.0);
    EXPECT_LE(noise_m2, kShare * kShare * view_m.squaredNorm() * (1.0 + 1e-9));
    EXPECT_NEAR((taken - noise_m2 * view * view.transpose()).norm(), 0.0, 1e-15);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(after);
    EXPECT_GE(solver.eigenvalues()(0), -1e-9 * before.trace());
  }
}

// A short stretch of a rung in noise as deep as it is long still shows its direction.
TEST(RangeNoise, LeavesTheDirectionOfAShortBar) {
  const Vector3d along = Vector3d(0.3, 1.0, 0.05).normalized();
  base::Rng rng(9);
  ladder::MomentSum points;
  for (int i = 0; i < 4000; ++i) {
    const Vector3d on_bar = Vector3d(1.4, 0.0, 0.5) + (0.12 * rng.uniform() - 0.06) * along +
                            (0.028 * rng.uniform() - 0.014) * Vector3d::UnitZ();
    const Vector3d seen = on_bar * (1.0 + kShare * rng.gaussian());
    points.add(1.0, seen, Matrix3d::Zero());
  }
  const auto blurred = ladder::principal_axis(points.covariance());
  EXPECT_FALSE(blurred.is_linear(3.0));
  const auto sharp =
      ladder::principal_axis(ladder::sharp_covariance(points, Vector3d::Zero(), 2.0 * kShare));
  EXPECT_TRUE(sharp.is_linear(3.0));
  EXPECT_GT(std::abs(sharp.direction.dot(along)), 0.99);
}

// As deep as high it is the distance from the axis; deeper, the view counts for less.
TEST(CrossSection, MeasuresTheViewByItsReach) {
  ladder::CrossSection section{Vector3d::UnitX(), 0.025, 0.025};
  EXPECT_NEAR(section.distance_m({0.03, 0.0, 0.04}), 0.05, 1e-12);
  section.half_depth_m = 0.075;
  EXPECT_NEAR(section.distance_m({0.03, 0.0, 0.0}), 0.01, 1e-12);
  EXPECT_NEAR(section.distance_m({0.0, 0.0, 0.04}), 0.04, 1e-12);
}

ladder::NodeCloud upright_nodes(double sigma_m, std::uint64_t seed) {
  base::Rng rng(seed);
  ladder::NodeCloud cloud;
  const auto add = [&cloud](double x_m, double y_m, double z_m) {
    ladder::HeadMoment moment;
    moment.node = static_cast<int>(cloud.id.size());
    moment.weight = 10.0F;
    moment.mean_m = Vector3d(x_m, y_m, z_m).cast<float>();
    cloud.moments.push_back(moment);
    cloud.id.push_back(moment.node);
    cloud.x_m.push_back(moment.mean_m.x());
    cloud.y_m.push_back(moment.mean_m.y());
    cloud.z_m.push_back(moment.mean_m.z());
    cloud.node_class.push_back(ladder::NodeClass::kUnknown);
    cloud.plane.push_back(-1);
  };
  constexpr int kNumNodes = 150;
  for (int i = 0; i < kNumNodes; ++i) {
    const double z_m = -0.6 + 1.2 * i / kNumNodes;
    add(1.5 * (1.0 + sigma_m / 1.5 * rng.gaussian()), 0.0, z_m);
    if (i % 3 == 0) add(1.5, 0.045, z_m);       // a pipe beside it
    if (i % 3 == 1) add(1.5 + 0.05, 0.0, z_m);  // and one behind it
  }
  return cloud;
}

ladder::Bar grown(const ladder::NodeCloud& cloud, ladder::BarSet& set) {
  const ladder::LadderParams params;
  ladder::BarNodes nodes(params);
  nodes.gather(cloud);
  ladder::ChainGrowth growth(params);
  set.members.reserve(1000);
  ladder::Seed seed;
  seed.axis = {{1.5, 0.0, 0.0}, Vector3d::UnitZ()};
  seed.node = nodes.size() / 2;
  seed.upright = true;
  ladder::Bar bar;
  EXPECT_TRUE(growth.grow(nodes, seed, params.bar.narrow_half_height_m, set, bar));
  return bar;
}

// In 30 mm of noise a rail is taken whole, upright, and nothing that stands beside it.
TEST(ChainGrowth, FollowsNoiseAlongTheViewOnly) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    ladder::BarSet set;
    const ladder::Bar bar = grown(upright_nodes(0.030, seed), set);
    EXPECT_GT(bar.section.half_depth_m, 0.04);
    EXPECT_GT(bar.num_members, 110);  // the narrow ellipse holds 0.6 of 150
    EXPECT_GT(bar.length_m(), 1.1);
    EXPECT_GT(bar.axis.direction.z(), 0.995);
    EXPECT_LT(std::abs(bar.axis.origin_m.y()), 1e-3);
  }
}

// Without noise, what stands 50 mm behind a rail is none of it.
TEST(ChainGrowth, StaysNarrowWithoutNoise) {
  ladder::BarSet set;
  const ladder::Bar bar = grown(upright_nodes(0.005, 1), set);
  EXPECT_EQ(bar.num_members, 150);
  EXPECT_EQ(bar.section.half_depth_m, bar.section.half_height_m);
}

// With 2 % of noise at 1.5 m, seen straight and from the side, every rung is trusted.
TEST(LadderInNoise, IsFoundWhole) {
  for (const double yaw_rad : {0.0, -0.52}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE(testing::Message() << "yaw " << yaw_rad << ", seed " << seed);
      test_support::LadderShape shape;
      shape.distance_m = 1.5;
      shape.yaw_rad = yaw_rad;
      shape.num_rungs = 6;
      test_support::LadderScene scene(seed);
      scene.noise_sigma_m = 0.030;
      scene.add_ladder(shape);
      ladder::LadderTracker tracker{ladder::LadderParams{}};
      ladder::LadderEstimate estimate;
      for (int frame = 0; frame < 8; ++frame) estimate = tracker.update(scene.cloud(frame));
      ASSERT_EQ(estimate.state, ladder::LadderState::kConfirmed);
      int num_trusted = 0;
      for (const auto& rung : estimate.rungs) {
        num_trusted += rung.state == ladder::RungState::kTrusted ? 1 : 0;
      }
      EXPECT_EQ(num_trusted, shape.num_rungs);
    }
  }
}

}  // namespace
