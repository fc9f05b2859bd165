// SPDX-License-Identifier: BSD-3-Clause
// The small parts of the ladder search against other ways to get the same.
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "base/rng.h"
#include "ladder/axis.h"
#include "ladder/bar_nodes.h"
#include "ladder/chord_depth.h"
#include "ladder/ladder_confirmation.h"
#include "ladder/measured_bar.h"
#include "ladder/moment_sum.h"
#include "ladder/principal_axis.h"
#include "ladder/weighted_median.h"

namespace {

// Axis and variances agree with a general eigenvalue solver on random covariances.
TEST(PrincipalAxis, AgreesWithAGeneralSolver) {
  base::Rng rng(1);
  for (int trial = 0; trial < 2000; ++trial) {
    Eigen::Matrix3d a;
    for (int i = 0; i < 9; ++i) a(i / 3, i % 3) = rng.gaussian();
    const double flatness = std::pow(10.0, -3.0 * rng.uniform());
    a.col(0) *= flatness;
    const Eigen::Matrix3d covariance = 1e-3 * a * a.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
    const ladder::PrincipalAxis axis = ladder::principal_axis(covariance);
    const double ratio = solver.eigenvalues()(2) / solver.eigenvalues()(1);
    if (ratio < 1.2) continue;
    EXPECT_NEAR(std::abs(axis.direction.dot(solver.eigenvectors().col(2))), 1.0, 1e-6);
    EXPECT_NEAR(axis.first_m2, solver.eigenvalues()(2), 1e-6 * solver.eigenvalues()(2));
    EXPECT_NEAR(axis.second_m2, solver.eigenvalues()(1), 1e-3 * solver.eigenvalues()(1));
  }
}

// A zero matrix, a point mass, gives a finite axis that is not linear.
TEST(PrincipalAxis, PointHasNoDirection) {
  const ladder::PrincipalAxis axis = ladder::principal_axis(Eigen::Matrix3d::Zero());
  EXPECT_TRUE(axis.direction.allFinite());
  EXPECT_FALSE(axis.is_linear(1.0));
}

// The mean depth of a circle's front is the area under it divided by its width.
TEST(ChordDepth, MatchesTheCircularSegment) {
  for (const double u : {0.1, 0.5, 0.9, 1.0}) {
    const double exact = 0.5 * (std::sqrt(1.0 - u * u) + std::asin(u) / u);
    EXPECT_NEAR(ladder::mean_chord_depth_m(0.014, 0.014 * u), 0.014 * exact, 0.004 * 0.014);
  }
}

// Sums of moments have the mean and covariance of all their points together.
TEST(MomentSum, AddsUpToTheWholeSet) {
  base::Rng rng(4);
  ladder::MomentSum parts, whole;
  for (int part = 0; part < 5; ++part) {
    ladder::MomentSum points;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d p(rng.gaussian(), 2.0 * rng.gaussian(), 5.0 + 0.1 * rng.gaussian());
      points.add(1.0, p, Eigen::Matrix3d::Zero());
      whole.add(1.0, p, Eigen::Matrix3d::Zero());
    }
    parts.add(points.weight, points.mean(), points.covariance());
  }
  EXPECT_NEAR((parts.mean() - whole.mean()).norm(), 0.0, 1e-12);
  EXPECT_NEAR((parts.covariance() - whole.covariance()).norm(), 0.0, 1e-11);
}

// The nearest places of two lines are joined by a perpendicular; parallel lines have their
// distance.
TEST(Axis, NearestPlacesArePerpendicular) {
  base::Rng rng(2);
  const auto direction = [&] {
    return Eigen::Vector3d(rng.gaussian(), rng.gaussian(), rng.gaussian()).normalized();
  };
  for (int i = 0; i < 100; ++i) {
    const ladder::Axis a{direction(), direction()}, b{2.0 * direction(), direction()};
    const ladder::Approach at = ladder::nearest(a, b);
    const Eigen::Vector3d joint = a.at(at.t) - b.at(at.u);
    EXPECT_NEAR(joint.dot(a.direction), 0.0, 1e-6);
    EXPECT_NEAR(joint.dot(b.direction), 0.0, 1e-6);
    EXPECT_NEAR(joint.norm(), at.distance_m, 1e-9);
  }
  const ladder::Axis x{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, above{{5.0, 0.0, 3.0}, {1.0, 0.0, 0.0}};
  EXPECT_NEAR(ladder::nearest(x, above).distance_m, 3.0, 1e-12);
}

// Stretches cover what is marked, inside the bar only.
TEST(Stretches, MarksOnlyInside) {
  ladder::Stretches stretches;
  ladder::mark(stretches, -1.0, -0.5, 0.4);
  ladder::mark(stretches, 0.5, 1.0, 0.4);
  ladder::mark(stretches, 0.0, 0.1, 0.0);
  EXPECT_TRUE(stretches.none());
  ladder::mark(stretches, -1.0, 0.099, 0.4);
  EXPECT_EQ(stretches.count(), 32U);
  ladder::mark(stretches, 0.0, 9.0, 0.4);
  EXPECT_TRUE(stretches.all());
}

// Rungs at 0.30 m with one missing and a few millimetres of error give 0.30 m.
TEST(Spacing, SurvivesAMissingRung) {
  std::vector<double> heights_m = {1.502, 0.0, 0.301, 0.9, 1.198};
  const ladder::Spacing spacing = ladder::fit_spacing(heights_m, {});
  EXPECT_EQ(spacing.num_rungs, 5);
  EXPECT_NEAR(spacing.spacing_m, 0.30, 0.001);
  EXPECT_LT(spacing.sigma_m, 0.002);
}

// Fewer than three rungs, or heights without a common step, have no spacing.
TEST(Spacing, NeedsThreeRegularRungs) {
  std::vector<double> none, two = {0.0, 0.3}, same = {1.0, 1.0, 1.0};
  EXPECT_EQ(ladder::fit_spacing(none, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing(two, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing(same, {}).num_rungs, 0);
  std::vector<double> irregular = {0.0, 0.3, 0.75};
  EXPECT_EQ(ladder::fit_spacing(irregular, {}).num_rungs, 0);
}

// Unequal steps that still pass as regular show in the standard error.
TEST(Spacing, ErrorGrowsWithIrregularity) {
  std::vector<double> regular = {0.0, 0.3, 0.6, 0.9};
  std::vector<double> uneven = {0.0, 0.32, 0.60, 0.92};
  EXPECT_LT(ladder::fit_spacing(regular, {}).sigma_m, 0.0015);
  EXPECT_GT(ladder::fit_spacing(uneven, {}).sigma_m, 0.005);
}

// A damaged rung makes a third of two sound ones where one of its ends, or its place above what it
// sags, is a rung's: next to them, or between two that are two steps apart. The distance is theirs.
TEST(Spacing, TakesADamagedRungForTheThird) {
  const std::vector<double> next = {0.0, 0.30}, apart = {0.6, 0.0};
  const ladder::Spacing above = ladder::fit_spacing_beside(next, {{0.59, 0.52, 0.0}}, {});
  EXPECT_EQ(above.num_rungs, 3);
  EXPECT_NEAR(above.spacing_m, 0.30, 1e-12);
  EXPECT_NEAR(above.sigma_m, 0.0028, 1e-4);
  const ladder::Spacing between = ladder::fit_spacing_beside(apart, {{0.20, 0.22, 0.03}}, {});
  EXPECT_EQ(between.num_rungs, 3);
  EXPECT_NEAR(between.spacing_m, 0.30, 1e-12);
}

// No two sound rungs, none damaged, or one that stands at no rung's place or at a sound one's own,
// give no spacing; neither do steps that no ladder has.
TEST(Spacing, TakesNoOtherBarForAThird) {
  const std::vector<double> none, one = {0.3}, two = {0.0, 0.30}, three = {0.0, 0.3, 0.6};
  const std::vector<ladder::DamagedHeight> fitting = {{0.6, 0.6, 0.0}};
  EXPECT_EQ(ladder::fit_spacing_beside(none, fitting, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing_beside(one, fitting, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing_beside(three, fitting, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing_beside(two, {}, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing_beside(two, {{0.45, 0.45, 0.01}}, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing_beside(two, {{0.30, 0.20, 0.0}}, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing_beside({0.3, 0.3}, fitting, {}).num_rungs, 0);
  EXPECT_EQ(ladder::fit_spacing_beside({0.0, 0.19}, {{0.38, 0.38, 0.0}}, {}).num_rungs, 0);
}

/// Two rails, and a rung proven between them.
ladder::Detections rails_of_a_ladder() {
  ladder::Detections found;
  found.is_ladder = true;
  for (const double y_m : {0.2, -0.2}) {
    found.rails.push_back({{{1.0, y_m, 0.0}, Eigen::Vector3d::UnitZ()}, -1.0, 1.0, 0.01});
  }
  return found;
}
ladder::BarTrack proven_rung(int id, double z_m, double radius_m, double weight) {
  ladder::BarTrack track;
  track.id = id;
  track.is_proven = true;
  track.bar.end0_m = {1.0, 0.2, z_m};
  track.bar.end1_m = {1.0, -0.2, z_m};
  track.bar.radius_m = radius_m;
  track.bar.weight = weight;
  return track;
}

// How regular a ladder has to be depends on how thick its rungs are: of a thick one less than half
// is seen.
TEST(LadderConfirmation, ThickRungsMayStandLessRegularly) {
  const ladder::Detections found = rails_of_a_ladder();
  for (const double radius_m : {0.014, 0.030, 0.048}) {
    std::vector<ladder::BarTrack> tracks;
    int id = 0;
    for (const double z_m : {-0.305, 0.009, 0.305}) {
      tracks.push_back(proven_rung(++id, z_m, radius_m, 1000.0));
    }
    ladder::LadderConfirmation confirmation{ladder::LadderParams{}};
    const bool confirmed = confirmation.update(found, tracks) == ladder::LadderState::kConfirmed;
    EXPECT_EQ(confirmed, radius_m == 0.048) << radius_m;
  }
}

// A rung of which the view's edge shows a part does not spoil the spacing of the whole ones.
TEST(LadderConfirmation, LeavesOutARungThatTheViewCuts) {
  const ladder::Detections found = rails_of_a_ladder();
  std::vector<ladder::BarTrack> tracks;
  int id = 0;
  for (const double z_m : {-0.3, 0.0, 0.3}) tracks.push_back(proven_rung(++id, z_m, 0.05, 4000.0));
  tracks.push_back(proven_rung(++id, 0.55, 0.02, 1000.0));
  ladder::LadderConfirmation confirmation{ladder::LadderParams{}};
  EXPECT_EQ(confirmation.update(found, tracks), ladder::LadderState::kConfirmed);
  EXPECT_NEAR(confirmation.spacing().spacing_m, 0.30, 1e-9);
  // A whole one that stands there does.
  tracks.back().bar.radius_m = 0.05;
  confirmation.reset();
  EXPECT_NE(confirmation.update(found, tracks), ladder::LadderState::kConfirmed);
}

// The rung that most is seen of may be the one that the view cuts: the others tell how thick rungs
// are, and a ladder of three is one.
TEST(LadderConfirmation, TheHeaviestRungDoesNotTellTheRadius) {
  std::vector<ladder::BarTrack> tracks;
  tracks.push_back(proven_rung(1, -0.29, 0.025, 1500.0));
  for (const int i : {0, 1}) tracks.push_back(proven_rung(2 + i, 0.3 * i, 0.046, 1000.0));
  ladder::LadderConfirmation confirmation{ladder::LadderParams{}};
  EXPECT_EQ(confirmation.update(rails_of_a_ladder(), tracks), ladder::LadderState::kConfirmed);
}

// Half of the weight decides, the lower one of two equals; nothing has the median 0.
TEST(WeightedMedian, IsWhereHalfOfTheWeightIsReached) {
  using Values = std::vector<std::pair<double, double>>;
  const auto median = [](Values values) { return ladder::weighted_median(values); };
  EXPECT_EQ(median({}), 0.0);
  EXPECT_EQ(median({{3.0, 0.0}}), 3.0);
  EXPECT_EQ(median({{2.0, 1.0}, {1.0, 1.0}}), 1.0);
  EXPECT_EQ(median({{9.0, 3.0}, {1.0, 1.0}, {2.0, 1.0}}), 9.0);
  EXPECT_EQ(median({{9.0, 1.5}, {1.0, 1.0}, {2.0, 1.0}}), 2.0);
}

// Only nodes off every plane with enough points are taken, in order of height, the heaviest first
// when there are too many.
TEST(BarNodes, TakesOffPlaneNodesByHeight) {
  ladder::NodeCloud cloud;
  for (int i = 0; i < 40; ++i) {
    cloud.id.push_back(i);
    cloud.x_m.push_back(1.0F);
    cloud.y_m.push_back(0.0F);
    cloud.z_m.push_back(static_cast<float>((i * 7) % 40));
    cloud.node_class.push_back(ladder::NodeClass::kUnknown);
    cloud.plane.push_back(i % 2 == 0 ? -1 : 0);
    ladder::HeadMoment moment;
    moment.node = i;
    moment.weight = i < 4 ? 0.1F : static_cast<float>(i);
    moment.mean_m = {1.0F, 0.0F, cloud.z_m.back()};
    cloud.moments.push_back(moment);
  }
  ladder::LadderParams params;
  ladder::BarNodes all(params);
  all.gather(cloud);
  EXPECT_EQ(all.size(), 18);
  for (int i = 1; i < all.size(); ++i) EXPECT_LT(all.position_m(i - 1).z(), all.position_m(i).z());
  const auto range = all.between(10.0, 20.0);
  for (int i = 0; i < all.size(); ++i) {
    const bool inside = all.position_m(i).z() >= 10.0 && all.position_m(i).z() <= 20.0;
    EXPECT_EQ(inside, i >= range.begin && i < range.end);
  }
  params.max_nodes = 16;
  ladder::BarNodes few(params);
  few.gather(cloud);
  EXPECT_EQ(few.size(), 16);
  for (int i = 0; i < few.size(); ++i) EXPECT_GE(few.weight(i), 8.0);
}

}  // namespace
