// SPDX-License-Identifier: BSD-3-Clause
// Heads that sit elsewhere than they are said to sit, or err in range: noticed, corrected, bounded.
#include "ladder/head_alignment.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace ladder {
namespace {

using Eigen::Vector3d;

struct Mounts {
  HeadCorrections error;  ///< true minus believed, as a correction would say it
};

Vector3d head_m(int head) {
  return {0.0, head % 2 == 0 ? 0.03 : -0.03, head < 2 ? 0.02 : -0.02};
}

void add_point(const Vector3d& true_m, int plane, const Mounts& mounts, NodeCloud& cloud) {
  const int node = cloud.num_nodes();
  cloud.id.push_back(node);
  cloud.x_m.push_back(static_cast<float>(true_m.x()));
  cloud.y_m.push_back(static_cast<float>(true_m.y()));
  cloud.z_m.push_back(static_cast<float>(true_m.z()));
  cloud.node_class.push_back(NodeClass::kUnknown);
  cloud.plane.push_back(plane);
  for (int head = 0; head < kNumHeads; ++head) {
    const HeadCorrection& error = mounts.error[head];
    HeadMoment m;
    m.node = node;
    m.head = head;
    m.weight = 10.0F;
    const Vector3d arm_m = true_m - head_m(head);
    m.mean_m = (true_m - error.turn_rad.cross(arm_m) - error.shift_m).cast<float>();
    cloud.moments.push_back(m);
  }
}

/// A wall ahead, one at the left and a floor, seen by all heads.
NodeCloud room(const Mounts& mounts) {
  NodeCloud cloud;
  cloud.planes = {{Eigen::Vector3f(-1.0F, 0.0F, 0.0F), -1.5F, NodeClass::kWall},
                  {Eigen::Vector3f(0.0F, -1.0F, 0.0F), -1.0F, NodeClass::kWall},
                  {Eigen::Vector3f(0.0F, 0.0F, 1.0F), -0.5F, NodeClass::kSafeGround}};
  for (int head = 0; head < kNumHeads; ++head) {
    cloud.head_valid[head] = true;
    cloud.head_position_m[head] = head_m(head).cast<float>();
  }
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      add_point({1.5, -0.8 + 0.4 * i, -0.4 + 0.3 * j}, 0, mounts, cloud);
      add_point({0.5 + 0.2 * i, 1.0, -0.4 + 0.3 * j}, 1, mounts, cloud);
      add_point({0.5 + 0.2 * i, -0.8 + 0.4 * j, -0.5}, 2, mounts, cloud);
    }
  }
  return cloud;
}

/// Largest distance between two heads' ideas of one node.
double disagreement_m(const NodeCloud& cloud) {
  double worst_m = 0.0;
  for (std::size_t i = 0; i < cloud.moments.size(); i += kNumHeads) {
    for (int a = 0; a < kNumHeads; ++a) {
      for (int b = 0; b < a; ++b) {
        const Eigen::Vector3f off = cloud.moments[i + a].mean_m - cloud.moments[i + b].mean_m;
        worst_m = std::max(worst_m, static_cast<double>(off.norm()));
      }
    }
  }
  return worst_m;
}

NodeCloud after(int num_frames, const Mounts& mounts, HeadAlignment& alignment) {
  const NodeCloud cloud = room(mounts);
  const BarSet no_bars;
  const BarNodes no_nodes{LadderParams{}};
  for (int frame = 0; frame < num_frames; ++frame) {
    alignment.learn(cloud, no_nodes, no_bars);
  }
  return alignment.correct(cloud);
}

Mounts two_wrong(double shift_m, double turn_rad) {
  Mounts mounts;
  mounts.error[2] = {Vector3d(-turn_rad, turn_rad, turn_rad), Vector3d(-shift_m, shift_m, shift_m)};
  mounts.error[1] = {Vector3d(turn_rad, -turn_rad, turn_rad), Vector3d(shift_m, shift_m, -shift_m)};
  return mounts;
}

// Two heads 35 mm and 2.5 deg off agree with the others after ten seconds.
TEST(HeadAlignment, BringsHeadsBack) {
  const Mounts mounts = two_wrong(0.02, 0.025);
  HeadAlignment alignment{LadderParams{}};
  EXPECT_GT(disagreement_m(room(mounts)), 0.03);
  EXPECT_LT(disagreement_m(after(150, mounts, alignment)), 0.008);
  EXPECT_TRUE(alignment.is_misfit());
  EXPECT_GT(alignment.misfit_m(), 0.006) << "told without the corrections";
}

// Errors within the usual tolerance are mended, too, and not reported.
TEST(HeadAlignment, SmallErrorsAreMended) {
  const Mounts mounts = two_wrong(0.002, 0.0035);
  HeadAlignment alignment{LadderParams{}};
  const double before_m = disagreement_m(room(mounts));
  EXPECT_LT(disagreement_m(after(150, mounts, alignment)), 0.4 * before_m);
  EXPECT_FALSE(alignment.is_misfit());
}

// Heads that sit where they are said to sit are not moved.
TEST(HeadAlignment, GoodMountingsStay) {
  HeadAlignment alignment{LadderParams{}};
  const NodeCloud cloud = after(150, Mounts{}, alignment);
  const NodeCloud untouched = room(Mounts{});
  for (std::size_t i = 0; i < cloud.moments.size(); ++i) {
    EXPECT_LT((cloud.moments[i].mean_m - untouched.moments[i].mean_m).norm(), 1e-5F);
  }
  EXPECT_LT(alignment.side_sigma_m(1.5), 1e-4);
}

// A wave of the range that all heads share is told from planes, to less than half of it.
TEST(HeadAlignment, LearnsTheErrorOfRange) {
  const auto wave_m = [](double range_m) { return 0.003 * std::sin(10.0 * range_m); };
  NodeCloud cloud = room(Mounts{});
  const NodeCloud truth = cloud;
  for (HeadMoment& m : cloud.moments) {
    const Eigen::Vector3f arm_m = m.mean_m - cloud.head_position_m[m.head];
    const float range_m = arm_m.norm();
    m.mean_m += static_cast<float>(wave_m(static_cast<double>(range_m))) / range_m * arm_m;
  }
  HeadAlignment alignment{LadderParams{}};
  for (int i = 0; i < 100; ++i) alignment.learn(cloud, BarNodes{LadderParams{}}, BarSet{});
  const auto squared_m2 = [&](const NodeCloud& seen) {
    double sum_m2 = 0.0;
    for (std::size_t i = 0; i < seen.moments.size(); ++i) {
      sum_m2 += (seen.moments[i].mean_m - truth.moments[i].mean_m).cast<double>().squaredNorm();
    }
    return sum_m2;
  };
  EXPECT_LT(squared_m2(alignment.correct(cloud)), 0.25 * squared_m2(cloud));
}

// Heads found wrong may all be wrong in what none shows: the side margin grows with it.
TEST(HeadAlignment, WrongHeadsWidenTheMargin) {
  HeadAlignment good{LadderParams{}}, bad{LadderParams{}};
  after(100, two_wrong(0.002, 0.0035), good);
  after(100, two_wrong(0.01, 0.0175), bad);
  EXPECT_GT(bad.side_sigma_m(1.0), 3.0 * good.side_sigma_m(1.0));
  EXPECT_GT(bad.side_sigma_m(1.0), 0.005);
}

// Corrections are in sight after a second of frames; with one head, or without correcting, nothing
// is waited for longer; a new start waits again.
TEST(HeadAlignment, SettlesInASecond) {
  LadderParams params;
  HeadAlignment alignment{params};
  after(params.align.settle_frames - 1, two_wrong(0.01, 0.0175), alignment);
  EXPECT_FALSE(alignment.is_settled());
  const double almost_m = disagreement_m(alignment.correct(room(two_wrong(0.01, 0.0175))));
  EXPECT_LT(almost_m, 0.5 * disagreement_m(room(two_wrong(0.01, 0.0175))));
  after(1, two_wrong(0.01, 0.0175), alignment);
  EXPECT_TRUE(alignment.is_settled());
  alignment.reset();
  EXPECT_FALSE(alignment.is_settled());

  NodeCloud alone = room(Mounts{});
  alone.head_valid = {true, false, false, false};
  for (int i = 0; i < params.align.settle_frames; ++i)
    alignment.learn(alone, BarNodes{params}, BarSet{});
  EXPECT_TRUE(alignment.is_settled());

  params.align.enabled = false;
  EXPECT_TRUE(HeadAlignment{params}.is_settled());
}

// Corrections never exceed their bounds, whatever the heads say.
TEST(HeadAlignment, IsBounded) {
  const LadderParams params;
  HeadAlignment alignment{params};
  after(300, two_wrong(0.3, 0.3), alignment);
  for (const HeadCorrection& correction : alignment.corrections()) {
    EXPECT_LE(correction.shift_m.norm(), params.align.max_shift_m + 1e-12);
    EXPECT_LE(correction.turn_rad.norm(), params.align.max_turn_rad + 1e-12);
  }
}

// Switched off, it hands on the very cloud it was given.
TEST(HeadAlignment, OffIsOff) {
  LadderParams params;
  params.align.enabled = false;
  HeadAlignment alignment{params};
  const NodeCloud cloud = room(two_wrong(0.02, 0.02));
  EXPECT_EQ(&alignment.correct(cloud), &cloud);
}

// What is not a number, a head without position, an empty cloud and a single head teach nothing.
TEST(HeadAlignment, OddCloudsTeachNothing) {
  HeadAlignment alignment{LadderParams{}};
  const BarNodes no_nodes{LadderParams{}};
  const BarSet no_bars;
  NodeCloud cloud = room(two_wrong(0.02, 0.02));
  for (HeadMoment& m : cloud.moments) m.mean_m.x() = std::numeric_limits<float>::quiet_NaN();
  alignment.learn(cloud, no_nodes, no_bars);
  alignment.learn(NodeCloud{}, no_nodes, no_bars);
  cloud = room(two_wrong(0.02, 0.02));
  cloud.head_valid = {false, true, false, false};
  alignment.learn(cloud, no_nodes, no_bars);
  EXPECT_EQ(alignment.misfit_m(), 0.0);
  for (const HeadCorrection& correction : alignment.corrections()) {
    EXPECT_EQ(correction.shift_m.norm(), 0.0);
    EXPECT_EQ(correction.turn_rad.norm(), 0.0);
  }
}

// reset() forgets.
TEST(HeadAlignment, ResetForgets) {
  HeadAlignment alignment{LadderParams{}};
  after(50, two_wrong(0.02, 0.02), alignment);
  alignment.reset();
  EXPECT_FALSE(alignment.is_misfit());
  EXPECT_EQ(alignment.corrections()[1].shift_m.norm(), 0.0);
}

}  // namespace
}  // namespace ladder
