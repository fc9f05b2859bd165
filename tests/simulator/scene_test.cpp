// SPDX-License-Identifier: BSD-3-Clause
// Scenes and the MuJoCo models made from them.
#include "simulator/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulator/mjcf.h"
#include "simulator/world.h"

namespace simulator {
namespace {

using ::testing::HasSubstr;

Scene scene_of(SceneKind kind, std::uint64_t seed = 1) {
  SceneParams params;
  params.kind = kind;
  params.seed = seed;
  return make_scene(params);
}

int num_of_kind(const Scene& scene, RungKind kind) {
  return static_cast<int>(std::count_if(scene.rungs.begin(), scene.rungs.end(),
                                        [kind](const Rung& rung) { return rung.kind == kind; }));
}

// A wrong name is answered with the names that exist.
TEST(SceneKind, UnknownNameListsTheKnownOnes) {
  for (const char* name : {"", "Plain", "ladder", "plain "}) {
    try {
      scene_kind_from_string(name);
      ADD_FAILURE() << "accepted \"" << name << "\"";
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("plain"));
      EXPECT_THAT(error.what(), HasSubstr("scaffold"));
    }
  }
}

// Names and kinds are one to one, and "normal" means "plain".
TEST(SceneKind, NamesRoundTrip) {
  for (const SceneName& entry : kSceneNames) {
    EXPECT_EQ(scene_kind_from_string(to_string(entry.kind)), entry.kind);
  }
  EXPECT_EQ(scene_kind_from_string("normal"), SceneKind::kPlain);
}

// Parameters out of range, also NaN, are refused with the name of the field.
TEST(SceneParams, CheckNamesTheField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  SceneParams params;
  EXPECT_EQ(check(params), "");
  params.distance_m = nan;
  EXPECT_THAT(check(params), HasSubstr("distance_m"));
  EXPECT_THROW(make_scene(params), std::invalid_argument);
  params = {};
  params.yaw_deg = 90.0;
  EXPECT_THAT(check(params), HasSubstr("yaw_deg"));
  params = {};
  params.rung_diameter_m = 0.0;
  EXPECT_THAT(check(params), HasSubstr("rung_diameter_m"));
  params = {};
  params.rail_diameter_m = 0.5;
  EXPECT_THAT(check(params), HasSubstr("rail_diameter_m"));
  params = {};
  params.rail_width_m = 0.0;
  EXPECT_THAT(check(params), HasSubstr("rail_width_m"));
  params = {};
  params.wall_reflectance = 0.0;
  EXPECT_THAT(check(params), HasSubstr("wall_reflectance"));
  EXPECT_THROW(rung_section_from_string("triangular"), std::invalid_argument);
  params = {};
  params.num_rungs = 0;
  EXPECT_THAT(check(params), HasSubstr("num_rungs"));
}

// Every kind compiles to a MuJoCo model whose geoms are the scene's solids, at every corner of the
// options.
TEST(World, EveryKindCompiles) {
  for (const SceneName& entry : kSceneNames) {
    for (const std::uint64_t seed : {0ULL, 1ULL, ~0ULL}) {
      SceneParams params;
      params.kind = entry.kind;
      params.seed = seed;
      params.distance_m = seed == 0 ? 0.6 : 1.5;
      params.yaw_deg = seed == 0 ? -30.0 : 15.0;
      const World world(make_scene(params));
      EXPECT_EQ(world.model().ngeom, static_cast<int>(world.scene().solids.size())) << entry.name;
    }
  }
}

// One rung still makes a scene of each ladder kind, although there is no second to damage.
TEST(World, OneRungIsEnough) {
  for (const SceneName& entry : kSceneNames) {
    SceneParams params;
    params.kind = entry.kind;
    params.num_rungs = 1;
    EXPECT_NO_THROW(World world(make_scene(params))) << entry.name;
  }
}

// The same parameters give the same model text; another seed gives another one.
TEST(World, SeedDecides) {
  for (const SceneName& entry : kSceneNames) {
    EXPECT_EQ(to_mjcf(scene_of(entry.kind, 7)), to_mjcf(scene_of(entry.kind, 7)));
    EXPECT_NE(to_mjcf(scene_of(entry.kind, 7)), to_mjcf(scene_of(entry.kind, 8))) << entry.name;
  }
}

// The body of every true rung stands in the model where the truth says: its geoms' centre is on the
// axis (bent rungs: within their sag).
TEST(World, TruthLiesInItsGeoms) {
  for (const SceneName& entry : kSceneNames) {
    const World world(scene_of(entry.kind));
    for (std::size_t i = 0; i < world.scene().rungs.size(); ++i) {
      const Rung& rung = world.scene().rungs[i];
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      int num_geoms = 0;
      for (int geom = 0; geom < world.model().ngeom; ++geom) {
        if (world.rung_of_geom()[geom] != static_cast<int>(i)) continue;
        sum += Eigen::Map<const Eigen::Vector3d>(world.state().geom_xpos + 3 * geom);
        ++num_geoms;
      }
      ASSERT_GT(num_geoms, 0) << entry.name;
      const double slack_m = rung.kind == RungKind::kBent ? 0.05 : 0.01;
      EXPECT_LT((sum / num_geoms - 0.5 * (rung.end0_m + rung.end1_m)).norm(), slack_m)
          << entry.name;
    }
  }
}

// Each damage does what its name says, and only that.
TEST(Scene, DamageIsInTheTruth) {
  EXPECT_EQ(scene_of(SceneKind::kPlain).rungs.size(), 8U);
  EXPECT_EQ(num_of_kind(scene_of(SceneKind::kPlain), RungKind::kSound), 8);
  EXPECT_EQ(num_of_kind(scene_of(SceneKind::kBent), RungKind::kBent), 1);
  EXPECT_EQ(num_of_kind(scene_of(SceneKind::kBroken), RungKind::kStub), 1);
  const Scene missing = scene_of(SceneKind::kMissing);
  EXPECT_EQ(missing.rungs.size(), 7U);
  EXPECT_EQ(missing.rungs.back().id, 7) << "the gap stays in the ids";
}

// Rungs have the spacing and the width asked for, whatever lean and yaw.
TEST(Scene, SpacingAndWidthAreKept) {
  for (const SceneKind kind : {SceneKind::kPlain, SceneKind::kTilt10, SceneKind::kIncline60}) {
    SceneParams params;
    params.kind = kind;
    params.yaw_deg = -30.0;
    params.spacing_m = 0.28;
    params.clear_width_m = 0.5;
    const Scene scene = make_scene(params);
    for (std::size_t i = 0; i + 1 < scene.rungs.size(); ++i) {
      EXPECT_NEAR((scene.rungs[i + 1].end0_m - scene.rungs[i].end0_m).norm(), 0.28, 1e-9);
      EXPECT_NEAR((scene.rungs[i].end1_m - scene.rungs[i].end0_m).norm(), 0.5, 1e-9);
    }
  }
}

// Treads are level boards whose noses lie spacing apart along the leaning rails, between them.
TEST(Scene, TreadsAreLevel) {
  SceneParams params;
  params.kind = SceneKind::kIncline60;
  params.rung_section = RungSection::kTread;
  params.yaw_deg = 15.0;
  const Scene scene = make_scene(params);
  ASSERT_EQ(scene.rungs.size(), 8U);
  const Eigen::Vector3d along = scene.rails[0].end1_m - scene.rails[0].end0_m;
  const Eigen::Vector3d step = scene.rungs[1].end0_m - scene.rungs[0].end0_m;
  EXPECT_NEAR(step.norm(), params.spacing_m, 1e-9);
  EXPECT_NEAR(step.normalized().dot(along.normalized()), 1.0, 1e-9);
  int num_boards = 0;
  for (const Solid& solid : scene.solids) {
    if (solid.part != Part::kRung) continue;
    ++num_boards;
    EXPECT_EQ(solid.shape, Shape::kBox);
    EXPECT_NEAR(solid.R_world_solid(2, 2), 1.0, 1e-12);
    const Rung& rung = scene.rungs[static_cast<std::size_t>(solid.part_index)];
    const Eigen::Vector3d nose = 0.5 * (rung.end0_m + rung.end1_m);
    EXPECT_NEAR((solid.center_m - nose).norm(), solid.half_size_m.x() - rung.radius_m, 1e-9);
    EXPECT_LT(nose.norm(), solid.center_m.norm());
  }
  EXPECT_EQ(num_boards, 8);
}

/// How far the solids of a rung reach from its axis: to the robot and up.
std::pair<double, double> reach_m(RungSection section) {
  SceneParams params;
  params.rung_diameter_m = 0.03;
  params.rung_section = section;
  const Scene scene = make_scene(params);
  double ahead_m = 0.0, up_m = 0.0;
  for (const Solid& solid : scene.solids) {
    if (solid.part != Part::kRung || solid.part_index != 0) continue;
    const Eigen::Vector3d off =
        solid.center_m - 0.5 * (scene.rungs[0].end0_m + scene.rungs[0].end1_m);
    ahead_m = std::max(ahead_m, std::abs(off.x()) + solid.half_size_m.x());
    const bool is_box = solid.shape == Shape::kBox;
    up_m = std::max(up_m, off.z() + (is_box ? solid.half_size_m.z() : solid.half_size_m.x()));
  }
  return {ahead_m, up_m};
}

// Sections are as high as the diameter says; only the oval is wider.
TEST(Scene, SectionsHaveTheirSize) {
  for (const auto& [section, ahead_m] :
       {std::pair{RungSection::kRound, 0.015}, std::pair{RungSection::kOval, 0.0225},
        std::pair{RungSection::kFlatTop, 0.015}}) {
    EXPECT_NEAR(reach_m(section).first, ahead_m, 1e-9);
    EXPECT_NEAR(reach_m(section).second, 0.015, 1e-9);
  }
}

// Round rails leave the clear width free, and the truth's rungs end at their inner faces.
TEST(Scene, RoundRailsKeepTheClearWidth) {
  SceneParams params;
  params.rail_diameter_m = 0.048;
  const Scene scene = make_scene(params);
  ASSERT_EQ(scene.rails.size(), 2U);
  EXPECT_NEAR((scene.rails[0].end0_m - scene.rails[1].end0_m).norm(), 0.448, 1e-9);
  EXPECT_NEAR((scene.rungs[0].end1_m - scene.rungs[0].end0_m).norm(), 0.4, 1e-9);
  for (const Solid& solid : scene.solids) {
    if (solid.part != Part::kRail) continue;
    EXPECT_EQ(solid.shape, Shape::kCylinder);
  }
}

// The lean is the angle its name gives (60 deg from level = 30 deg from upright), away from the
// robot, and the distance holds at the robot's height.
TEST(Scene, LeanIsAwayFromTheRobot) {
  for (const auto& [kind, lean_deg] :
       {std::pair{SceneKind::kTilt10, 10.0}, std::pair{SceneKind::kIncline75, 15.0},
        std::pair{SceneKind::kIncline60, 30.0}}) {
    const Rail rail = scene_of(kind).rails[0];
    const Eigen::Vector3d up = (rail.end1_m - rail.end0_m).normalized();
    EXPECT_NEAR(up.x(), std::sin(lean_deg * M_PI / 180.0), 1e-9);
    const double along = (kDistanceHeight_m - rail.end0_m.z()) / up.z();
    EXPECT_NEAR((rail.end0_m + along * up).x(), 0.9, 1e-9);
  }
}

// A negative scene knows bars only.
TEST(Scene, NegativesHaveNoRungs) {
  for (const SceneName& entry : kSceneNames) {
    if (is_ladder(entry.kind)) continue;
    const Scene scene = scene_of(entry.kind);
    EXPECT_EQ(num_of_kind(scene, RungKind::kBar), static_cast<int>(scene.rungs.size()));
    EXPECT_TRUE(scene.rails.empty());
  }
  EXPECT_EQ(scene_of(SceneKind::kFreeBar).rungs.size(), 1U);
}

}  // namespace
}  // namespace simulator
