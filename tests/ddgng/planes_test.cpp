// SPDX-License-Identifier: BSD-3-Clause
// Planes where gravity decides: walls with a foot, boards that lean, floors and rubble.
#include "ddgng/planes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "ddgng/structure.h"
#include "tests/ddgng/structure_scene.h"

namespace ddgng {
namespace {

/// A rectangle: a corner and two sides.
struct Sheet {
  Eigen::Vector3f corner_m, side_u_m, side_v_m;

  Eigen::Vector3f at(float u, float v) const { return corner_m + u * side_u_m + v * side_v_m; }
};

void add_points(const Sheet& sheet, int num, base::Rng& rng, structure_scene::Cloud& cloud) {
  for (int i = 0; i < num; ++i) {
    const auto u = static_cast<float>(rng.uniform());
    const auto v = static_cast<float>(rng.uniform());
    const Eigen::Vector3f normal = sheet.side_u_m.cross(sheet.side_v_m).normalized();
    cloud.add(sheet.at(u, v) + 0.005F * static_cast<float>(rng.gaussian()) * normal);
  }
}

/// One large label of 12 x 12 nodes, as a coarse graph lays it over what it sees.
Topology label_over(const Sheet& sheet) {
  constexpr int kSide = 12;
  std::vector<Eigen::Vector3f> nodes_m;
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int column = i % kSide;
    const int row = i / kSide;
    nodes_m.push_back(
        sheet.at(static_cast<float>(column) / (kSide - 1), static_cast<float>(row) / (kSide - 1)));
    if (column > 0) edges.emplace_back(i - 1, i);
    if (row > 0) edges.emplace_back(i - kSide, i);
    if (column > 0 && row > 0) edges.emplace_back(i - kSide - 1, i);
  }
  return structure_scene::make_topology(nodes_m, edges);
}

std::vector<Plane> planes_of(const Sheet& label, const structure_scene::Cloud& cloud,
                             const StructureParams& params = StructureParams()) {
  Topology topology = label_over(label);
  StructureBuilder builder(params, 1000, 12000);
  builder.build(cloud.view(), topology);
  EXPECT_EQ(topology.labels.size(), 1U);
  return topology.planes;
}

class PlanesTest : public testing::TestWithParam<std::uint64_t> {};

// A foot that stands 0.2 m before the upper part of a front tilts the label; the upper part is
// found all the same, exactly upright.
TEST_P(PlanesTest, AFootDoesNotTiltTheWall) {
  base::Rng rng(GetParam());
  structure_scene::Cloud cloud;
  add_points({{1.0F, -0.7F, 0.0F}, {0, 1.4F, 0}, {0, 0, 0.25F}}, 3000, rng, cloud);
  add_points({{1.0F, -0.7F, 0.25F}, {0, 1.4F, 0}, {0.2F, 0, 0.25F}}, 3000, rng, cloud);
  add_points({{1.2F, -0.7F, 0.5F}, {0, 1.4F, 0}, {0, 0, 0.6F}}, 7000, rng, cloud);
  const Sheet label = {{1.0F, -0.7F, 0.0F}, {0, 1.4F, 0}, {0.25F, 0, 1.1F}};
  const auto planes = planes_of(label, cloud);
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].plane_class, Class::kWall);
  EXPECT_EQ(planes[0].normal.z(), 0.0F);
  EXPECT_NEAR(std::abs(planes[0].offset_m), 1.2F, 0.02F);

  StructureParams as_fitted;
  as_fitted.upright_within_deg = 0.0F;
  for (const Plane& plane : planes_of(label, cloud, as_fitted)) {
    EXPECT_NE(plane.plane_class, Class::kWall);
  }
}

// A high board that leans by 15 degrees is neither turned upright nor called a wall.
TEST_P(PlanesTest, ALeaningBoardStaysLeaning) {
  base::Rng rng(GetParam());
  structure_scene::Cloud cloud;
  const Sheet board = {{1.0F, -0.7F, 0.0F}, {0, 1.4F, 0}, {0.402F, 0, 1.5F}};
  add_points(board, 10000, rng, cloud);
  const auto planes = planes_of(board, cloud);
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].plane_class, Class::kObstacle);
  EXPECT_NEAR(planes[0].normal.z(), 0.259F, 0.02F);
}

// A floor is safe ground; the tops of tilted blocks, with as much below their mean plane as on it,
// are none.
TEST_P(PlanesTest, TopsOfRubbleAreNoGround) {
  base::Rng rng(GetParam());
  structure_scene::Cloud floor;
  structure_scene::Cloud rubble;
  const Sheet ground = {{0.4F, -0.9F, 0.0F}, {1.8F, 0, 0}, {0, 1.8F, 0}};
  add_points(ground, 10000, rng, floor);
  for (int block = 0; block < 36; ++block) {
    const Eigen::Vector3f corner_m =
        ground.at(static_cast<float>(block % 6) / 6.0F, static_cast<float>(block / 6) / 6.0F);
    const auto lean_x_m = static_cast<float>(0.2 * rng.uniform() - 0.1);
    const auto lean_y_m = static_cast<float>(0.2 * rng.uniform() - 0.1);
    add_points({corner_m, {0.3F, 0, lean_x_m}, {0, 0.3F, lean_y_m}}, 300, rng, rubble);
  }
  const auto planes = planes_of(ground, floor);
  ASSERT_EQ(planes.size(), 1U);
  EXPECT_EQ(planes[0].plane_class, Class::kSafeGround);
  for (const Plane& plane : planes_of(ground, rubble)) {
    EXPECT_NE(plane.plane_class, Class::kSafeGround);
  }

  StructureParams careless;
  careless.ground_max_below = 1.0F;
  EXPECT_FALSE(planes_of(ground, rubble, careless).empty());
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlanesTest, testing::Range<std::uint64_t>(1, 9));

}  // namespace
}  // namespace ddgng
