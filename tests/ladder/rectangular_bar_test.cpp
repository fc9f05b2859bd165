// SPDX-License-Identifier: BSD-3-Clause
// Bars of rectangular section, against points counted on their faces; and which ladders have square
// rungs.
#include "ladder/rectangular_bar.h"

#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "base/rng.h"
#include "ladder/rung_profile.h"

namespace ladder {
namespace {

/// Seen from far away: x along the front, z into the depth; the view goes towards +z and, with
/// sine > 0, towards +x.
struct Seen {
  double half_m = 0.0;        ///< of what is seen, across the view
  double mean_x_m = 0.0;      ///< from the front's middle
  double mean_along_m = 0.0;  ///< along the view, from the section's middle
};

Seen look_at(double width_m, double depth_m, double sine) {
  const double cosine = std::sqrt(1.0 - sine * sine);
  Seen seen;
  double weight = 0.0;
  const auto add = [&](double x_m, double z_m, double projected_m) {
    weight += projected_m;
    seen.mean_x_m += projected_m * x_m;
    seen.mean_along_m += projected_m * (x_m * sine + z_m * cosine);
  };
  constexpr int kNum = 1000;
  for (int i = 0; i < kNum; ++i) {
    const double u = (i + 0.5) / kNum - 0.5;
    add(u * width_m, -0.5 * depth_m, width_m * cosine / kNum);
    add(std::copysign(0.5 * width_m, -sine), u * depth_m, depth_m * std::abs(sine) / kNum);
  }
  seen.half_m = 0.5 * weight;
  seen.mean_x_m /= weight;
  seen.mean_along_m /= weight;
  return seen;
}

// The middle of a flat rail's front is found beside the mean of the points on front and side.
TEST(RectangularBar, FrontIsFoundBesideWhatIsSeen) {
  for (const double depth_m : {0.01, 0.025, 0.05}) {
    for (const double sine : {-0.7, -0.3, -0.05, 0.0, 0.1, 0.5}) {
      const Seen seen = look_at(0.010, depth_m, sine);
      EXPECT_NEAR(beside_seen_m(0.005, seen.half_m, sine), -seen.mean_x_m, 1e-9);
    }
  }
}

// Less is seen than the front, or more than any rail shows, or nothing: bounded by half the front.
TEST(RectangularBar, IsBounded) {
  for (const double seen_m : {0.0, 0.004, 1.0}) {
    for (const double sine : {-2.0, 0.0, 0.3, 2.0}) {
      EXPECT_LE(std::abs(beside_seen_m(0.005, seen_m, sine)), 0.005);
    }
  }
  EXPECT_EQ(beside_seen_m(0.005, 0.004, 0.3), 0.0);
}

// Half the height of a square bar, and how far its axis lies behind what is seen.
TEST(RectangularBar, SquareFromAbove) {
  for (const double sine : {-0.6, 0.0, 0.2, 0.7}) {
    const Seen seen = look_at(0.028, 0.028, sine);
    EXPECT_NEAR(seen.half_m, 0.014 * square_height(sine), 1e-9);
    EXPECT_NEAR(-seen.mean_along_m, 0.014 / square_height(sine), 1e-9);
  }
}

/// Rungs at different heights before a head, 0.3 m apart and 1 m away.
std::vector<MeasuredBar> rungs(bool square, double error, base::Rng& rng) {
  std::vector<MeasuredBar> bars;
  for (int i = -2; i < 3; ++i) {
    MeasuredBar bar;
    bar.depth = Eigen::Vector3d(1.0, 0.0, 0.3 * i + 0.1).normalized();
    bar.range_m = 1.0;
    bar.weight = 50.0;
    bar.seen.set();
    bar.radius_m = 0.014 * (square ? square_height(bar.depth.z()) : 1.0);
    bar.radius_m *= 1.0 + error * rng.gaussian();
    bars.push_back(bar);
  }
  return bars;
}

bool is_square(bool truth, double error, std::uint64_t seed) {
  base::Rng rng(seed);
  RungProfile profile(64);
  for (int frame = 0; frame < 10; ++frame) {
    profile.learn(rungs(truth, error, rng), Eigen::Vector3d::UnitZ());
  }
  return profile.is_square();
}

// Square rungs are told from round ones where heights are known to 3 %; round ones are never taken
// for square, however badly their heights are known.
TEST(RungProfile, TellsSquareFromRound) {
  for (std::uint64_t seed = 1; seed < 50; ++seed) {
    EXPECT_TRUE(is_square(true, 0.03, seed));
    EXPECT_FALSE(is_square(false, 0.05, seed));
    EXPECT_FALSE(is_square(false, 0.5, seed));
  }
}

// Two rungs, rungs on one level, thick or near ones and what is no number say nothing; a reset
// forgets.
TEST(RungProfile, RoundUntilShown) {
  base::Rng rng(1);
  const std::vector<MeasuredBar> square = rungs(true, 0.0, rng);
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  RungProfile profile(64);
  EXPECT_FALSE(profile.is_square());
  for (int i = 0; i < 10; ++i) profile.learn({square[0], square[3]}, up);
  for (int i = 0; i < 10; ++i) profile.learn({square[2], square[2], square[2], square[2]}, up);
  MeasuredBar none = square[0];
  none.radius_m = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 10; ++i) profile.learn({none, none, none, none}, up);
  std::vector<MeasuredBar> thick = square, near = square;
  for (MeasuredBar& bar : thick) bar.is_wide = true;
  near[1].range_m = 0.4;
  for (int i = 0; i < 10; ++i) profile.learn(thick, up);
  for (int i = 0; i < 10; ++i) profile.learn(near, up);
  EXPECT_FALSE(profile.is_square());
  for (int i = 0; i < 10; ++i) profile.learn(square, up);
  EXPECT_TRUE(profile.is_square());
  profile.reset();
  EXPECT_FALSE(profile.is_square());
}

// Rungs that something hides in part say nothing of their section: what hides them takes of their
// height, too.
TEST(RungProfile, HiddenRungsSayNothing) {
  base::Rng rng(1);
  std::vector<MeasuredBar> square = rungs(true, 0.0, rng);
  for (MeasuredBar& bar : square) {
    for (std::size_t i = 0; i < bar.seen.size() / 5; ++i) bar.seen.reset(i);
    EXPECT_FALSE(bar.is_whole());
  }
  RungProfile profile(64);
  for (int i = 0; i < 10; ++i) profile.learn(square, Eigen::Vector3d::UnitZ());
  EXPECT_FALSE(profile.is_square());
}

/// Covariance of depth and place across / variance of the place, of points spread evenly across.
template <class Depth>
double bend_of(double half_m, const Depth& depth_m) {
  constexpr int kNumPoints = 2000;
  double place2 = 0.0, product = 0.0, depth = 0.0;
  for (int i = 0; i < kNumPoints; ++i) {
    const double a = half_m * (2.0 * (i + 0.5) / kNumPoints - 1.0);
    depth += depth_m(a) / kNumPoints;
    place2 += a * a / kNumPoints;
    product += a * depth_m(a) / kNumPoints;
  }
  return product / place2;
}

// Straight on, or where the angle is no number, all that is seen is the front.
TEST(FrontShare, OddAnglesShowTheFront) {
  EXPECT_EQ(front_share(0.0, 0.0), 1.0);
  EXPECT_EQ(front_share(0.3, -1.0), 1.0);
  EXPECT_EQ(front_share(0.0, std::numeric_limits<double>::quiet_NaN()), 1.0);
}

// A flat bar's front is told from its side, whatever of it is seen.
TEST(FrontShare, TellsFrontFromSide) {
  for (const double tangent : {0.1, 0.4, 0.8}) {
    for (const double share : {0.1, 0.4, 0.7, 1.0}) {
      const double half_m = 0.02;
      const double edge_m = half_m * (2.0 * share - 1.0);
      const auto depth_m = [&](double a) {
        return a < edge_m ? -tangent * (a - edge_m) : (a - edge_m) / tangent;
      };
      EXPECT_NEAR(front_share(bend_of(half_m, depth_m), tangent), share, 0.02) << tangent;
    }
  }
}

// A tube, the same from everywhere, is not taken for a thin bar seen from the side.
TEST(FrontShare, TubesAreWide) {
  for (const double tangent : {0.1, 0.4, 0.7}) {
    const double half_m = 0.02;
    const auto depth_m = [&](double a) { return -std::sqrt(half_m * half_m - a * a); };
    EXPECT_GT(front_share(bend_of(half_m, depth_m), tangent), 0.55) << tangent;
  }
}

}  // namespace
}  // namespace ladder
