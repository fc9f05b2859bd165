// SPDX-License-Identifier: BSD-3-Clause
// Ladders: eight rungs between two flat rails before a wall, and what can be wrong with them.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "simulator/scene_builder.h"

namespace simulator {
namespace {

using Eigen::Vector3d;

constexpr double kRailHalfDepth_m = 0.025;  // flat bar 50 x 10 mm, narrow side to the robot
constexpr double kRailHalfWidth_m = 0.005;
constexpr double kBentDrop_m = 0.07;  // of the right end
constexpr double kBentSag_m = 0.05;   // of the middle
constexpr double kLooseDrop = 0.3;    // of the right end / clear width: 17 deg
constexpr double kDarkFactor = 0.2;

struct LadderShape {
  double radius_m = 0.0;
  double first_height_m = 0.0;
  double half_width_m = 0.0;  // of the clear width
  double reflectance = 0.5;
  int damaged = -1;  // which rung is missing, bent, broken or loose
};

double lean_deg(SceneKind kind) {
  switch (kind) {
    case SceneKind::kTilt10:
      return 10.0;
    case SceneKind::kIncline75:
      return 15.0;
    case SceneKind::kIncline60:
      return 30.0;
    default:
      return 0.0;
  }
}

double radius_m(SceneBuilder& builder) {
  const double drawn = builder.draw(0.025, 0.030);
  double diameter = builder.params().rung_diameter_m.value_or(drawn);
  if (!builder.params().rung_diameter_m) {
    if (builder.params().kind == SceneKind::kSquare) diameter = 0.028;
    if (builder.params().kind == SceneKind::kThick) diameter = 0.100;
  }
  return 0.5 * diameter;
}

LadderShape draw_shape(SceneBuilder& builder) {
  const SceneParams& params = builder.params();
  LadderShape shape;
  shape.radius_m = radius_m(builder);
  shape.first_height_m = params.spacing_m * builder.draw(0.85, 1.15);
  shape.half_width_m = 0.5 * params.clear_width_m;
  shape.reflectance = builder.draw(0.4, 0.7);
  // Among the rungs that the heads see well.
  const int damaged =
      builder.draw_index(std::min(1, params.num_rungs - 1), std::min(3, params.num_rungs - 1));
  const bool has_damage = params.kind == SceneKind::kMissing || params.kind == SceneKind::kBent ||
                          params.kind == SceneKind::kBroken || params.kind == SceneKind::kLoose;
  if (has_damage) shape.damaged = params.damaged_rung.value_or(damaged);
  if (params.kind == SceneKind::kDark) shape.reflectance *= kDarkFactor;
  return shape;
}

void mark(Solid& solid, Part part, int index, double reflectance) {
  solid.part = part;
  solid.part_index = index;
  solid.reflectance = reflectance;
}

void add_rails(SceneBuilder& builder, const LadderShape& shape) {
  const double half_height =
      0.5 * (shape.first_height_m + builder.params().num_rungs * builder.params().spacing_m);
  for (const double side : {1.0, -1.0}) {
    const double y = side * (shape.half_width_m + kRailHalfWidth_m);
    const int index =
        builder.true_rail({{0.0, y, 0.0}, {0.0, y, 2.0 * half_height}, kRailHalfWidth_m});
    mark(builder.box({0.0, y, half_height}, {kRailHalfDepth_m, kRailHalfWidth_m, half_height}),
         Part::kRail, index, shape.reflectance);
  }
}

/// One end low and the middle sagging, as a chain of short capsules.
void add_bent_rung(SceneBuilder& builder, const LadderShape& shape, const Rung& rung) {
  constexpr int kNumPieces = 8;
  const int index = builder.true_rung(rung);
  const auto point = [&rung](double s) -> Vector3d {
    return rung.end0_m + s * (rung.end1_m - rung.end0_m) -
           Vector3d(0.0, 0.0, 4.0 * kBentSag_m * s * (1.0 - s));
  };
  for (int i = 0; i < kNumPieces; ++i) {
    mark(builder.capsule(point(static_cast<double>(i) / kNumPieces),
                         point(static_cast<double>(i + 1) / kNumPieces), shape.radius_m),
         Part::kRung, index, shape.reflectance);
  }
}

void add_rung(SceneBuilder& builder, const LadderShape& shape, int id) {
  const double z = shape.first_height_m + id * builder.params().spacing_m;
  Rung rung{id,
            RungKind::kSound,
            {0.0, shape.half_width_m, z},
            {0.0, -shape.half_width_m, z},
            shape.radius_m};
  // A sound rung is let into the rails; the truth ends at their inner faces.
  Vector3d from = rung.end0_m + Vector3d(0.0, kRailHalfWidth_m, 0.0);
  Vector3d to = rung.end1_m - Vector3d(0.0, kRailHalfWidth_m, 0.0);
  const SceneKind kind = builder.params().kind;
  if (id == shape.damaged && kind == SceneKind::kMissing) return;
  if (id == shape.damaged && kind == SceneKind::kBent) {
    rung.kind = RungKind::kBent;
    rung.end1_m.z() -= kBentDrop_m;
    return add_bent_rung(builder, shape, rung);
  }
  if (id == shape.damaged && kind == SceneKind::kBroken) {
    rung.kind = RungKind::kStub;
    rung.end1_m.y() = rung.end0_m.y() - builder.draw(0.4, 0.6) * builder.params().clear_width_m;
    to = rung.end1_m;
  }
  if (id == shape.damaged && kind == SceneKind::kLoose) {  // hangs from the left rail, straight
    rung.kind = RungKind::kBent;
    rung.end1_m.z() -= kLooseDrop * builder.params().clear_width_m;
    to = rung.end1_m;
  }
  const int index = builder.true_rung(rung);
  if (kind == SceneKind::kSquare) {
    const Vector3d half(shape.radius_m, 0.5 * (from.y() - to.y()), shape.radius_m);
    mark(builder.box(0.5 * (from + to), half), Part::kRung, index, shape.reflectance);
  } else {
    mark(builder.rod(from, to, shape.radius_m), Part::kRung, index, shape.reflectance);
  }
}

/// Pipes, a cable, boxes and a bracket around and behind the ladder; rungs stay visible.
void add_clutter(SceneBuilder& builder, double wall_m) {
  const double edge = 0.5 * builder.params().clear_width_m + 0.06;
  for (const double side : {1.0, -1.0}) {
    const double y = side * (edge + builder.draw(0.02, 0.15));
    builder.capsule({wall_m - 0.03, y, 0.0}, {wall_m - 0.03, y, 2.6}, builder.draw(0.015, 0.03));
    const double half = builder.draw(0.08, 0.2);
    builder.box({builder.draw(-0.1, 0.1), side * (edge + half + builder.draw(0.02, 0.2)), half},
                {half, half, half});
  }
  const double z = builder.draw(0.6, 1.2);
  builder.capsule({wall_m - 0.02, -1.2, z}, {wall_m - 0.02, 1.2, z}, 0.012);
  const double y = builder.draw(-0.1, 0.1);
  builder.capsule({0.05, y, 0.0}, {0.06, y + builder.draw(-0.1, 0.1), 2.4}, 0.005);
  builder.box({wall_m - 0.04, builder.draw(-0.15, 0.15), builder.draw(0.7, 1.3)},
              {0.04, 0.06, 0.09});
}

}  // namespace

void build_ladder_scene(SceneBuilder& builder) {
  const LadderShape shape = draw_shape(builder);
  const double lean = lean_deg(builder.params().kind);
  builder.lean(lean);
  add_rails(builder, shape);
  for (int id = 0; id < builder.params().num_rungs; ++id) add_rung(builder, shape, id);

  builder.lean(0.0);
  const double height =
      shape.first_height_m + builder.params().num_rungs * builder.params().spacing_m;
  const double reach = (height - kDistanceHeight_m) * std::sin(lean * std::numbers::pi / 180.0);
  const double wall_m = std::max(0.0, reach) + shape.radius_m + builder.draw(0.15, 0.20);
  if (builder.params().kind != SceneKind::kNoWall) builder.wall(wall_m);
  if (builder.params().kind == SceneKind::kClutter) add_clutter(builder, wall_m);
}

}  // namespace simulator
