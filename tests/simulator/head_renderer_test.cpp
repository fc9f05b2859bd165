// SPDX-License-Identifier: BSD-3-Clause
// Depth images of one head: reproducible, right in the mean, wrong at edges in the way real ones
// are.
#include "simulator/head_renderer.h"

#include <cmath>

#include <gtest/gtest.h>

#include "simulator/world.h"

namespace simulator {
namespace {

Eigen::Isometry3d body_pose() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation().z() = 0.55;
  return pose;
}

World plain_world() {
  return World(make_scene(SceneParams{}));
}

HeadImage render(const World& world, const SensorParams& params, std::uint64_t seed,
                 std::uint64_t frame, int head = 0) {
  HeadRenderer renderer(params, heads_still()[static_cast<std::size_t>(head)], head, seed);
  HeadImage image;
  renderer.render(world.model(), world.state(), body_pose(), frame, image);
  return image;
}

SensorParams ideal() {
  SensorParams params;
  params.noise_share = params.noise_floor_m = params.wiggle_m = 0.0;
  params.edge_dropout = params.random_dropout = 0.0;
  params.extrinsic_sigma_m = params.extrinsic_sigma_deg = 0.0;
  return params;
}

// Same seed and frame, same bytes, also after other frames; another seed, frame or head differs.
TEST(HeadRenderer, SeedAndFrameDecideEveryByte) {
  const World world = plain_world();
  const HeadImage image = render(world, {}, 5, 3);
  HeadRenderer renderer({}, heads_still()[0], 0, 5);
  HeadImage again;
  for (const std::uint64_t frame : {9ULL, 0ULL, 3ULL}) {
    renderer.render(world.model(), world.state(), body_pose(), frame, again);
  }
  EXPECT_EQ(image.depth_mm, again.depth_mm);
  EXPECT_EQ(image.confidence, again.confidence);
  EXPECT_NE(image.depth_mm, render(world, {}, 6, 3).depth_mm);
  EXPECT_NE(image.depth_mm, render(world, {}, 5, 4).depth_mm);
  EXPECT_NE(image.depth_mm, render(world, {}, 5, 3, 1).depth_mm);
}

// Without noise every clean pixel is the true range, to the half millimetre of rounding and what
// the extra rays of an edge pixel average.
TEST(HeadRenderer, IdealSensorMeasuresTheTruth) {
  const HeadImage image = render(plain_world(), ideal(), 1, 0);
  int num_exact = 0, num_clean = 0;
  for (std::size_t i = 0; i < image.depth_mm.size(); ++i) {
    if (image.clean_geom[i] < 0 || !std::isfinite(image.true_range_m[i])) continue;
    ++num_clean;
    const float error_mm = std::abs(image.depth_mm[i] - 1000.0F * image.true_range_m[i]);
    ASSERT_LT(error_mm, 15.0F) << i;
    num_exact += error_mm <= 0.51F ? 1 : 0;
  }
  EXPECT_GT(num_clean, 20000);
  EXPECT_GT(num_exact, 0.98 * num_clean);
}

// Z and radial depth of an ideal sensor differ by the ray's z component.
TEST(HeadRenderer, DepthKinds) {
  const World world = plain_world();
  SensorParams along_axis = ideal();
  along_axis.radial = false;
  const HeadImage radial = render(world, ideal(), 1, 0);
  const HeadImage z = render(world, along_axis, 1, 0);
  const HeadRenderer renderer(ideal(), heads_still()[0], 0, 1);
  for (std::size_t i = 0; i < z.depth_mm.size(); ++i) {
    ASSERT_NEAR(z.depth_mm[i], radial.depth_mm[i] * renderer.ray(i).z(), 1.01F);
  }
}

// Flying pixels lie between the surfaces whose light they mix, and there are some but few.
TEST(HeadRenderer, FlyingPixelsAreBetweenSurfaces) {
  const HeadImage image = render(plain_world(), ideal(), 1, 0);
  int num_flying = 0;
  for (int y = 1; y < 170; ++y) {
    for (int x = 1; x < 223; ++x) {
      const auto i = static_cast<std::size_t>(y * 224 + x);
      if (image.depth_mm[i] == 0 || image.clean_geom[i] >= 0) continue;
      ++num_flying;
      float least = kMiss, most = 0.0F;
      for (const int step : {-225, -224, -223, -1, 0, 1, 223, 224, 225}) {
        const float range = image.true_range_m[static_cast<std::size_t>(y * 224 + x + step)];
        least = std::min(least, range);
        most = std::max(most, range);
      }
      ASSERT_GE(image.depth_mm[i], 1000.0F * least - 15.0F);
      ASSERT_LE(image.depth_mm[i], 1000.0F * most + 15.0F);
    }
  }
  EXPECT_GT(num_flying, 100);
  EXPECT_LT(num_flying, 3000);
}

// With all edge pixels dropped, no flying pixel is left.
TEST(HeadRenderer, EdgeDropout) {
  SensorParams params = ideal();
  params.edge_dropout = 1.0;
  const HeadImage image = render(plain_world(), params, 1, 0);
  for (std::size_t i = 0; i < image.depth_mm.size(); ++i) {
    ASSERT_TRUE(image.depth_mm[i] == 0 || image.clean_geom[i] >= 0);
  }
}

// The mounting error has the size asked for, differs from head to head, and not from frame to
// frame.
TEST(HeadRenderer, MountingError) {
  double square_m2 = 0.0, square_deg2 = 0.0;
  constexpr int kNumSeeds = 300;
  for (int seed = 0; seed < kNumSeeds; ++seed) {
    const HeadRenderer head({}, heads_still()[1], 1, static_cast<std::uint64_t>(seed));
    const Eigen::Isometry3d error = head.T_body_head_nominal().inverse() * head.T_body_head_true();
    square_m2 += error.translation().squaredNorm() / 3.0;
    const double angle_deg = Eigen::AngleAxisd(error.linear()).angle() * 180.0 / M_PI;
    square_deg2 += angle_deg * angle_deg / 3.0;
  }
  EXPECT_NEAR(std::sqrt(square_m2 / kNumSeeds), 0.002, 0.0002);
  EXPECT_NEAR(std::sqrt(square_deg2 / kNumSeeds), 0.2, 0.02);
  const HeadRenderer ideal_head(ideal(), heads_still()[1], 1, 1);
  EXPECT_TRUE(ideal_head.T_body_head_true().isApprox(ideal_head.T_body_head_nominal(), 1e-12));
}

// An error that stays: the same in every frame, of the size asked for, nearly the same in
// neighbouring pixels, and another one in another head.
TEST(HeadRenderer, PixelBiasStays) {
  SensorParams biased = ideal();
  biased.pixel_bias_m = 0.01;
  const World world = plain_world();
  const auto error_mm = [&](std::uint64_t frame, int head) {
    const HeadImage right = render(world, ideal(), 1, frame, head);
    HeadImage image = render(world, biased, 1, frame, head);
    for (std::size_t i = 0; i < right.depth_mm.size(); ++i) image.depth_mm[i] -= right.depth_mm[i];
    return image.depth_mm;
  };
  const std::vector<std::int16_t> errors = error_mm(0, 0);
  EXPECT_EQ(errors, error_mm(7, 0));
  EXPECT_NE(errors, error_mm(0, 1));
  double sum2 = 0.0;
  int step_max = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    sum2 += errors[i] * errors[i];
    if (i % 224 != 0) step_max = std::max(step_max, std::abs(errors[i] - errors[i - 1]));
  }
  // Straight lines between knots have less variance than the knots: 4/9 of it on average.
  EXPECT_NEAR(std::sqrt(sum2 / static_cast<double>(errors.size())), 10.0 * 2.0 / 3.0, 1.0);
  EXPECT_LE(step_max, 4);
}

// A head in the middle of a wall gives an image of numbers in range, and does not crash.
TEST(HeadRenderer, HeadInsideAWall) {
  SceneParams params;
  params.kind = SceneKind::kEmptyRoom;
  params.distance_m = 0.3;
  const World world(make_scene(params));
  HeadRenderer renderer({}, heads_still()[0], 0, 1);
  HeadImage image;
  for (double x = 0.0; x < 2.0; x += 0.05) {
    Eigen::Isometry3d pose = body_pose();
    pose.translation().x() = x;
    renderer.render(world.model(), world.state(), pose, 0, image);
    for (const std::int16_t depth_mm : image.depth_mm)
      ASSERT_TRUE(depth_mm >= 0 && depth_mm <= 4000);
  }
}

// The layouts' heads look where they should: right-handed frames, upper heads up, left heads left.
TEST(HeadLayout, Directions) {
  for (const HeadLayout& layout : {heads_still(), heads_climb()}) {
    for (const HeadMount& mount : layout) {
      EXPECT_NEAR(T_body_head(mount).linear().determinant(), 1.0, 1e-12);
      EXPECT_TRUE(T_body_head(mount).linear().isUnitary(1e-12));
    }
  }
  const auto forward = [](int head) {
    return T_body_head(heads_still()[static_cast<std::size_t>(head)]).linear().col(2).eval();
  };
  EXPECT_GT(forward(0).y(), 0.3);
  EXPECT_GT(forward(0).z(), 0.3);
  EXPECT_LT(forward(3).y(), -0.3);
  EXPECT_LT(forward(3).z(), -0.3);
  EXPECT_LT(T_body_head(heads_still()[0]).linear().col(1).z(), -0.9) << "y is down";
  EXPECT_THROW(head_layout_from_string("heads"), std::invalid_argument);
}

}  // namespace
}  // namespace simulator
