// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/plane_patches.h"

#include <algorithm>
#include <numeric>

#include <gtest/gtest.h>

#include "ddgng/attention.h"
#include "tests/ddgng/structure_scene.h"

namespace ddgng {
namespace {

constexpr std::uint64_t kSearchFrame = 3;  // a multiple of patch_interval_frames

/// The ladder alone, and beside it a cupboard's front of 0.3 x 0.5 m.
structure_scene::Cloud ladder_and_front(std::uint64_t seed, int num_front_points) {
  const structure_scene::LadderScene scene = structure_scene::make_ladder_scene(seed);
  structure_scene::Cloud cloud;
  for (std::size_t i = 0; i < scene.point_part.size(); ++i) {
    if (scene.point_part[i] != structure_scene::Part::kLadder) continue;
    cloud.add({scene.cloud.x_m[i], scene.cloud.y_m[i], scene.cloud.z_m[i]});
  }
  base::Rng rng(seed);
  for (int i = 0; i < num_front_points; ++i) {
    const auto u = static_cast<float>(rng.uniform());
    const auto v = static_cast<float>(rng.uniform());
    const auto noise_m = static_cast<float>(0.008 * rng.gaussian());
    cloud.add({0.8F + noise_m, 0.35F + 0.3F * u, 0.4F + 0.5F * v});
  }
  cloud.sequence = kSearchFrame;
  return cloud;
}

std::vector<std::uint32_t> all_points(const structure_scene::Cloud& cloud) {
  std::vector<std::uint32_t> points(cloud.x_m.size());
  std::iota(points.begin(), points.end(), 0U);
  return points;
}

// No points, a handful, or all in one place: no patch and no harm.
TEST(PlanePatches, OddClouds) {
  PlanePatches patches{StructureParams()};
  structure_scene::Cloud cloud;
  patches.find(cloud.view(), {});
  EXPECT_EQ(patches.size(), 0);
  for (int i = 0; i < 2000; ++i) cloud.add({1, 0, 1});
  patches.find(cloud.view(), std::vector<std::uint32_t>{0, 1, 2});
  EXPECT_EQ(patches.size(), 0);
  patches.find(cloud.view(), all_points(cloud));
  EXPECT_EQ(patches.size(), 0);
  EXPECT_FALSE(patches.contains({1, 0, 1}, 0.1F));
}

class PlanePatchesTest : public testing::TestWithParam<std::uint64_t> {};

// A ladder has no interior: no patch, whatever plane is laid through it.
TEST_P(PlanePatchesTest, LadderIsNoPatch) {
  const structure_scene::Cloud cloud = ladder_and_front(GetParam(), 0);
  PlanePatches patches{StructureParams()};
  patches.find(cloud.view(), all_points(cloud));
  EXPECT_EQ(patches.size(), 0);
}

// Nor are free boards one, though they lie in one plane and have some interior.
TEST_P(PlanePatchesTest, BoardsAreNoPatch) {
  structure_scene::Cloud cloud;
  base::Rng rng(GetParam());
  for (int i = 0; i < 8000; ++i) {
    const auto u = static_cast<float>(rng.uniform());
    const auto v = static_cast<float>(rng.uniform());
    cloud.add({1.0F, 0.3F * static_cast<float>(i % 4) + 0.07F * u, 0.8F * v});
  }
  PlanePatches patches{StructureParams()};
  patches.find(cloud.view(), all_points(cloud));
  EXPECT_EQ(patches.size(), 0);
}

// The front is found within its borders, not beyond them.
TEST_P(PlanePatchesTest, FrontIsAPatch) {
  const structure_scene::Cloud cloud = ladder_and_front(GetParam(), 3000);
  PlanePatches patches{StructureParams()};
  patches.find(cloud.view(), all_points(cloud));
  ASSERT_EQ(patches.size(), 1);
  EXPECT_TRUE(patches.contains({0.8F, 0.5F, 0.65F}, 0.03F));
  EXPECT_TRUE(patches.contains({0.82F, 0.4F, 0.5F}, 0.03F));
  EXPECT_FALSE(patches.contains({0.9F, 0.5F, 0.65F}, 0.03F));
  EXPECT_FALSE(patches.contains({0.8F, 0.5F, 1.5F}, 0.03F));
  EXPECT_FALSE(patches.contains({0.8F, -0.5F, 0.65F}, 0.03F));
}

// With the option on, attention leaves the front and keeps the ladder; patches last until the next
// search.
TEST_P(PlanePatchesTest, AttentionLeavesTheFront) {
  StructureParams params;
  params.residual_patches = true;
  structure_scene::Cloud cloud = ladder_and_front(GetParam(), 3000);
  Attention attention(params, cloud.x_m.size());
  for (const std::uint64_t sequence : {kSearchFrame, kSearchFrame + 1}) {
    cloud.sequence = sequence;
    attention.set_regions(Topology(), cloud.view());
    const auto selected = attention.select(cloud.view());
    const auto num_ladder =
        std::count_if(selected.begin(), selected.end(), [](std::uint32_t i) { return i < 3000; });
    EXPECT_GE(num_ladder, 2700);
    EXPECT_LE(static_cast<std::ptrdiff_t>(selected.size()) - num_ladder, 150);
    EXPECT_FALSE(attention.contains({0.8F, 0.5F, 0.65F}));
    EXPECT_TRUE(attention.contains({1.0F, 0.0F, 0.6F}));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlanePatchesTest, testing::Range<std::uint64_t>(1, 9));

}  // namespace
}  // namespace ddgng
