// SPDX-License-Identifier: BSD-3-Clause
// A ladder before a wall: what a frame must recognise, and where the next one must look.
#include "tests/ddgng/structure_scene.h"

#include <array>

#include <gtest/gtest.h>

#include "ddgng/attention.h"
#include "ddgng/structure.h"

namespace ddgng {
namespace {

using structure_scene::LadderScene;
using structure_scene::Part;

/// Share of the nodes of a part that got this class.
double share_of_class(const LadderScene& scene, Part part, Class node_class) {
  int num_part = 0;
  int num_class = 0;
  for (std::size_t i = 0; i < scene.node_part.size(); ++i) {
    if (scene.node_part[i] != part) continue;
    ++num_part;
    if (scene.topology.node_class[i] == node_class) ++num_class;
  }
  return static_cast<double>(num_class) / num_part;
}

LadderScene recognised(std::uint64_t seed, const StructureParams& params) {
  LadderScene scene = structure_scene::make_ladder_scene(seed);
  StructureBuilder builder(params, 1000, 12000);
  builder.build(scene.cloud.view(), scene.topology);
  return scene;
}

bool is_ladder_suspected(const LadderScene& scene) {
  for (std::size_t i = 0; i < scene.node_part.size(); ++i) {
    if (scene.node_part[i] != Part::kLadder) continue;
    const int object = scene.topology.node_object[i];
    if (object < 0 || !scene.topology.objects[object].suspected) return false;
  }
  return true;
}

/// Shares of the points of each part (floor, wall, ladder) that draw attention.
std::array<double, 3> attention_shares(const LadderScene& scene, const StructureParams& params) {
  Attention attention(params, scene.cloud.x_m.size());
  attention.set_regions(scene.topology, scene.cloud.view());
  std::array<double, 3> selected{};
  std::array<double, 3> all{};
  for (const Part part : scene.point_part) all[static_cast<int>(part)] += 1.0;
  for (const std::uint32_t i : attention.select(scene.cloud.view())) {
    selected[static_cast<int>(scene.point_part[i])] += 1.0;
  }
  for (int part = 0; part < 3; ++part) selected[part] /= all[part];
  return selected;
}

class LadderSceneTest : public testing::TestWithParam<std::uint64_t> {};

// Floor is safe ground, wall is wall, every node of the ladder is an obstacle, and the ladder as a
// whole is suspected.
TEST_P(LadderSceneTest, PartsAreRecognised) {
  const LadderScene scene = recognised(GetParam(), StructureParams());
  EXPECT_EQ(scene.topology.planes.size(), 2U);
  EXPECT_GE(share_of_class(scene, Part::kFloor, Class::kSafeGround), 0.98);
  EXPECT_GE(share_of_class(scene, Part::kWall, Class::kWall), 0.98);
  EXPECT_EQ(share_of_class(scene, Part::kLadder, Class::kObstacle), 1.0);
  EXPECT_TRUE(is_ladder_suspected(scene));
}

// The same by labels alone, as the paper has it.
TEST_P(LadderSceneTest, PaperFormRecognisesTheParts) {
  const LadderScene scene = recognised(GetParam(), paper_structure_params());
  EXPECT_TRUE(scene.topology.planes.empty());
  EXPECT_GE(share_of_class(scene, Part::kFloor, Class::kSafeGround), 0.9);
  EXPECT_GE(share_of_class(scene, Part::kWall, Class::kWall), 0.9);
  EXPECT_EQ(share_of_class(scene, Part::kLadder, Class::kObstacle), 1.0);
  EXPECT_TRUE(is_ladder_suspected(scene));
}

// Attention off the planes takes the ladder and leaves floor and wall.
TEST_P(LadderSceneTest, AttentionTakesTheLadderAlone) {
  const StructureParams params;
  const auto [floor, wall, ladder] = attention_shares(recognised(GetParam(), params), params);
  EXPECT_LE(floor, 0.05);
  EXPECT_LE(wall, 0.05);
  EXPECT_GE(ladder, 0.9);
}

// The box of the paper holds the ladder, too, though not it alone.
TEST_P(LadderSceneTest, BoxAttentionTakesTheLadder) {
  const StructureParams params = paper_structure_params();
  const auto [floor, wall, ladder] = attention_shares(recognised(GetParam(), params), params);
  EXPECT_LE(floor, 0.05);
  EXPECT_GE(ladder, 0.9);
}

// Nodes of the ladder are strong, nodes of floor and wall are not.
TEST_P(LadderSceneTest, StrengthFollowsTheParts) {
  const StructureParams params;
  const LadderScene scene = recognised(GetParam(), params);
  Attention attention(params, scene.cloud.x_m.size());
  attention.set_regions(scene.topology, scene.cloud.view());
  for (std::size_t i = 0; i < scene.node_part.size(); ++i) {
    const Eigen::Vector3f p = scene.topology.node_m(static_cast<int>(i));
    if (scene.node_part[i] == Part::kLadder && p.x() > 0.15F) {
      EXPECT_TRUE(attention.contains(p)) << p.transpose();
    } else if (scene.node_part[i] != Part::kLadder) {
      EXPECT_FALSE(attention.contains(p)) << p.transpose();
    }
  }
}

// A ladder that stands as a dense label before a wall is no plane: the heads see through it. (The
// floor below, which has no label here, is found by its height.)
TEST_P(LadderSceneTest, TheFrontOfALadderIsNoPlane) {
  LadderScene scene = structure_scene::make_ladder_scene(GetParam());
  // A sheet of nodes, as an early and coarse graph lays it over a ladder.
  std::vector<Eigen::Vector3f> nodes_m;
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < 40; ++i) {
    nodes_m.emplace_back(1.0F, 0.1F * static_cast<float>(i % 5) - 0.2F,
                         0.2F * static_cast<float>(1 + i / 5));
    if (i % 5 > 0) edges.emplace_back(i - 1, i);
    if (i >= 5) edges.emplace_back(i - 5, i);
  }
  scene.topology = structure_scene::make_topology(nodes_m, edges);
  StructureBuilder builder(StructureParams(), 1000, 12000);
  builder.build(scene.cloud.view(), scene.topology);
  ASSERT_EQ(scene.topology.labels.size(), 1U);
  for (const Plane& plane : scene.topology.planes) {
    EXPECT_EQ(plane.plane_class, Class::kSafeGround);
    EXPECT_NEAR(plane.offset_m, 0.0F, 0.02F);
  }
  EXPECT_EQ(scene.topology.node_class[20], Class::kObstacle);
  EXPECT_EQ(scene.topology.node_plane[20], -1);
}

// A known floor replaces a label that is tilted and slightly off.
TEST_P(LadderSceneTest, KnownFloorComesFirst) {
  StructureParams params;
  params.floor_height_known = true;
  const LadderScene scene = recognised(GetParam(), params);
  ASSERT_EQ(scene.topology.planes.size(), 2U);
  EXPECT_EQ(scene.topology.planes[0].plane_class, Class::kSafeGround);
  EXPECT_EQ(scene.topology.planes[0].normal, Eigen::Vector3f::UnitZ());
  EXPECT_EQ(scene.topology.planes[0].offset_m, 0.0F);
}

// The same input gives the same structure, whatever the builder saw before.
TEST_P(LadderSceneTest, PlanesDependOnTheFrameAlone) {
  const LadderScene first = recognised(GetParam(), StructureParams());
  LadderScene again = structure_scene::make_ladder_scene(GetParam());
  LadderScene other = structure_scene::make_ladder_scene(GetParam() + 100);
  StructureBuilder builder(StructureParams(), 1000, 12000);
  builder.build(other.cloud.view(), other.topology);
  builder.build(again.cloud.view(), again.topology);
  ASSERT_EQ(first.topology.planes.size(), again.topology.planes.size());
  for (std::size_t i = 0; i < first.topology.planes.size(); ++i) {
    EXPECT_EQ(first.topology.planes[i].normal, again.topology.planes[i].normal);
    EXPECT_EQ(first.topology.planes[i].offset_m, again.topology.planes[i].offset_m);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, LadderSceneTest, testing::Range<std::uint64_t>(1, 9));

}  // namespace
}  // namespace ddgng
