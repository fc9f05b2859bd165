// SPDX-License-Identifier: BSD-3-Clause
// What stands before the robot: a ladder (sound, damaged, hard to see) or something that must not
// be taken for one. A scene is a list of solids and of true rungs and rails in the world frame
// (z up, floor at z = 0, the robot at x = y = 0 looks along +x). No physics, no sensors here.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace simulator {

enum class SceneKind {
  kPlain,
  kMissing,
  kBent,
  kClutter,
  kSquare,
  kBroken,
  kNoWall,
  kTilt10,
  kIncline60,
  kIncline75,
  kThick,
  kDark,
  kEmptyRoom,
  kStairs,
  kShelf,
  kBoxes,
  kPosts,
  kFreeBar,
  kCupboard,
  kWindowBars,
  kHandrail,
  kScaffold,
  kLoose,
  kDoorway,
  kFence,
  kTwoLadders,
  kSteps,
  kNarrowShelf,
  kChair,
  kPipes,
  kTowelRail,
  kGate,
};

struct SceneName {
  SceneKind kind;
  std::string_view name;
};

/// Every kind with the name users type; "normal" is accepted for "plain".
inline constexpr std::array<SceneName, 32> kSceneNames{{
    {SceneKind::kPlain, "plain"},
    {SceneKind::kMissing, "missing"},
    {SceneKind::kBent, "bent"},
    {SceneKind::kClutter, "clutter"},
    {SceneKind::kSquare, "square"},
    {SceneKind::kBroken, "broken"},
    {SceneKind::kNoWall, "no_wall"},
    {SceneKind::kTilt10, "tilt_10"},
    {SceneKind::kIncline60, "incline_60"},
    {SceneKind::kIncline75, "incline_75"},
    {SceneKind::kThick, "thick"},
    {SceneKind::kDark, "dark"},
    {SceneKind::kEmptyRoom, "empty_room"},
    {SceneKind::kStairs, "stairs"},
    {SceneKind::kShelf, "shelf"},
    {SceneKind::kBoxes, "boxes"},
    {SceneKind::kPosts, "posts"},
    {SceneKind::kFreeBar, "free_bar"},
    {SceneKind::kCupboard, "cupboard"},
    {SceneKind::kWindowBars, "window_bars"},
    {SceneKind::kHandrail, "handrail"},
    {SceneKind::kScaffold, "scaffold"},
    {SceneKind::kLoose, "loose"},
    {SceneKind::kDoorway, "doorway"},
    {SceneKind::kFence, "fence"},
    {SceneKind::kTwoLadders, "two_ladders"},
    {SceneKind::kSteps, "steps"},
    {SceneKind::kNarrowShelf, "narrow_shelf"},
    {SceneKind::kChair, "chair"},
    {SceneKind::kPipes, "pipes"},
    {SceneKind::kTowelRail, "towel_rail"},
    {SceneKind::kGate, "gate"},
}};

/// Throws std::invalid_argument that lists the known kinds.
SceneKind scene_kind_from_string(std::string_view name);
std::string_view to_string(SceneKind kind);
/// False for the kinds that only look like a ladder.
bool is_ladder(SceneKind kind);

/// Across a rung. Oval: half as wide again as high. Flat top: round below, level above. Tread: a
/// level board, whatever the ladder leans.
enum class RungSection { kRound, kOval, kFlatTop, kTread };

/// Throws std::invalid_argument that lists "round", "oval", "flat_top" and "tread".
RungSection rung_section_from_string(std::string_view name);

struct SceneParams {
  SceneKind kind = SceneKind::kPlain;
  std::uint64_t seed = 1;                 ///< small variation of places, sizes and brightness
  double distance_m = 0.9;                ///< [0.3, 3] robot to ladder plane, at kDistanceHeight_m
  double yaw_deg = 0.0;                   ///< [-60, 60] turns the scene about its own vertical
  std::optional<double> rung_diameter_m;  ///< [0.01, 0.12]; none: 25-30 mm, drawn from the seed
  double spacing_m = 0.30;                ///< [0.15, 0.5] from rung to rung along the rails
  double clear_width_m = 0.40;            ///< [0.2, 0.8] between the inner faces of the rails
  int num_rungs = 8;                      ///< [1, 16]
  std::optional<int> damaged_rung;  ///< of kMissing, kBent, kBroken, kLoose; none: from the seed
  RungSection rung_section = RungSection::kRound;  ///< of sound rungs
  std::optional<double> rail_diameter_m;           ///< [0.01, 0.12]; none: flat bars
  double rail_width_m = 0.01;                      ///< [0.002, 0.12] of flat bars, seen from before
  std::optional<double> wall_reflectance;          ///< [0.01, 1]; none: from the seed
};

/// "" or the violated relation.
std::string check(const SceneParams& params);

/// Height at which distance_m is measured, which matters for a leaning ladder.
inline constexpr double kDistanceHeight_m = 0.55;

enum class Shape { kPlane, kSphere, kCapsule, kCylinder, kBox };
enum class Part { kOther, kRung, kRail };

/// half_size_m as MuJoCo has it: sphere (r, -, -), capsule and cylinder (r, half length, -) along
/// the solid's z axis, box (x, y, z), plane (0, 0, -) = without end, normal = z axis.
struct Solid {
  Shape shape = Shape::kBox;
  Part part = Part::kOther;
  int part_index = -1;  ///< index into Scene::rungs or Scene::rails
  Eigen::Vector3d center_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_world_solid = Eigen::Matrix3d::Identity();
  Eigen::Vector3d half_size_m = Eigen::Vector3d::Zero();
  double reflectance = 0.5;  ///< 0 = black .. 1 = white
};

/// The values of truth_t RUNG_*; a loose rung, one end down, counts as bent.
enum class RungKind : std::uint8_t { kUnknown = 0, kSound = 1, kBent = 2, kStub = 3, kBar = 4 };

struct Rung {
  int id = 0;  ///< place on the ladder from below; a missing rung leaves a gap
  RungKind kind = RungKind::kSound;
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();  ///< at the left rail's inner face
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();  ///< right rail's inner face, or broken end
  double radius_m = 0.0;
};

struct Rail {
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();
  double half_width_m = 0.0;
};

struct Scene {
  SceneParams params;
  std::vector<Solid> solids;
  std::vector<Rung> rungs;  ///< ascending; of a negative scene: bars that belong to no ladder
  std::vector<Rail> rails;
};

/// The same params give the same scene. Throws std::invalid_argument when check(params) objects.
Scene make_scene(const SceneParams& params);

/// The same scene after somebody took this rung (index into rungs) away.
Scene without_rung(Scene scene, int index);

}  // namespace simulator
