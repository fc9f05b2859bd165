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

constexpr double kRailHalfDepth_m = 0.025;  // flat bar, narrow side to the robot
constexpr double kBentDrop_m = 0.07;        // of the right end
constexpr double kBentSag_m = 0.05;         // of the middle
constexpr double kLooseDrop = 0.3;          // of the right end / clear width: 17 deg
constexpr double kDarkFactor = 0.2;
constexpr double kTreadHalfDepth_m = 0.05;

struct LadderShape {
  double radius_m = 0.0;
  double first_height_m = 0.0;
  double half_width_m = 0.0;  // of the clear width
  double rail_half_width_m = 0.0;
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
  shape.rail_half_width_m = 0.5 * params.rail_diameter_m.value_or(params.rail_width_m);
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
    const double y = side * (shape.half_width_m + shape.rail_half_width_m);
    const Vector3d bottom(0.0, y, 0.0), top(0.0, y, 2.0 * half_height);
    const int index = builder.true_rail({bottom, top, shape.rail_half_width_m});
    mark(builder.params().rail_diameter_m
             ? builder.rod(bottom, top, shape.rail_half_width_m)
             : builder.box({0.0, y, half_height},
                           {kRailHalfDepth_m, shape.rail_half_width_m, half_height}),
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
  Vector3d from = rung.end0_m + Vector3d(0.0, shape.rail_half_width_m, 0.0);
  Vector3d to = rung.end1_m - Vector3d(0.0, shape.rail_half_width_m, 0.0);
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
  const auto add = [&](Solid& solid) { mark(solid, Part::kRung, index, shape.reflectance); };
  const double r = shape.radius_m;
  const Vector3d middle = 0.5 * (from + to), half(r, 0.5 * (from.y() - to.y()), r);
  if (kind == SceneKind::kSquare) return add(builder.box(middle, half));
  const RungSection section = builder.params().rung_section;
  const Vector3d aside(section == RungSection::kOval ? 0.5 * r : 0.0, 0.0, 0.0);
  add(builder.rod(from + aside, to + aside, r));
  if (section == RungSection::kOval) {
    add(builder.rod(from - aside, to - aside, r));
    add(builder.box(middle, {0.5 * r, half.y(), r}));
  } else if (section == RungSection::kFlatTop) {
    add(builder.box(middle + Vector3d(0.0, 0.0, 0.5 * r), {r, half.y(), 0.5 * r}));
  }
}

/// A level board in a leaning ladder. Its truth is the nose, as a bar as thick as the board: what
/// comes first into a claw. That no claw closes round the whole board is not in the truth.
void add_tread(SceneBuilder& builder, const LadderShape& shape, int id) {
  const double along_m = shape.first_height_m + id * builder.params().spacing_m - kDistanceHeight_m;
  const double lean_rad = lean_deg(builder.params().kind) * std::numbers::pi / 180.0;
  const Vector3d middle(along_m * std::sin(lean_rad), 0.0,
                        kDistanceHeight_m + along_m * std::cos(lean_rad));
  const Vector3d left(0.0, shape.half_width_m, 0.0);
  const Vector3d nose = middle - Vector3d(kTreadHalfDepth_m - shape.radius_m, 0.0, 0.0);
  const int index =
      builder.true_rung({id, RungKind::kSound, nose + left, nose - left, shape.radius_m});
  mark(builder.box(middle, {kTreadHalfDepth_m, shape.half_width_m, shape.radius_m}), Part::kRung,
       index, shape.reflectance);
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

/// The ladder stands beside an opening, its trim proud of the wall; a room 2 m deep behind it.
void add_doorway(SceneBuilder& builder, double wall_m) {
  const double side = builder.draw(-1.0, 1.0) < 0.0 ? -1.0 : 1.0;
  const double near = 0.5 * builder.params().clear_width_m + builder.draw(0.10, 0.25);
  const double far = near + 0.9;
  const double wall_x = wall_m + 0.05, kTop_m = 2.0, kReach_m = 2.5;
  builder.box({wall_x, side * 0.5 * (near - kReach_m), 1.5}, {0.05, 0.5 * (near + kReach_m), 1.5});
  builder.box({wall_x, side * 0.5 * (far + kReach_m), 1.5}, {0.05, 0.5 * (kReach_m - far), 1.5});
  builder.box({wall_x, side * 0.5 * (near + far), 2.5}, {0.05, 0.45, 0.5});
  for (const double y : {near, far}) {
    builder.box({wall_m - 0.01, side * y, 0.5 * kTop_m}, {0.02, 0.03, 0.5 * kTop_m});
  }
  builder.wall(wall_m + 2.0);
}

/// Pickets between three rails close behind the ladder, and nothing behind them.
void add_fence(SceneBuilder& builder, double wall_m) {
  constexpr int kNumPickets = 21;
  for (int i = 0; i < kNumPickets; ++i) {
    const double y = 0.13 * i - 1.3;
    builder.box({wall_m + 0.03, y, 0.9}, {0.01, 0.04, 0.9});
  }
  for (const double z : {0.35, 0.95, 1.55}) builder.box({wall_m + 0.06, 0.0, z}, {0.02, 1.4, 0.04});
}

/// Another ladder beside this one, at the side that is farther from the robot, with its rungs at
/// other heights. Rungs of both are in the truth.
void add_second_ladder(SceneBuilder& builder, const LadderShape& shape) {
  const int num_rungs = builder.params().num_rungs;
  const double spacing_m = builder.params().spacing_m;
  const double side = builder.params().yaw_deg > 0.0 ? -1.0 : 1.0;
  const double middle_y = side * (2.0 * shape.half_width_m + builder.draw(0.25, 0.45));
  const double half_height = 0.5 * (shape.first_height_m + num_rungs * spacing_m);
  for (const double edge : {1.0, -1.0}) {
    const double y = middle_y + edge * (shape.half_width_m + shape.rail_half_width_m);
    const int index =
        builder.true_rail({{0.0, y, 0.0}, {0.0, y, 2.0 * half_height}, shape.rail_half_width_m});
    mark(builder.box({0.0, y, half_height},
                     {kRailHalfDepth_m, shape.rail_half_width_m, half_height}),
         Part::kRail, index, shape.reflectance);
  }
  const double first_m = shape.first_height_m - builder.draw(0.05, 0.2);
  for (int i = 0; i < num_rungs; ++i) {
    const Vector3d left(0.0, middle_y + shape.half_width_m, first_m + i * spacing_m);
    const Vector3d right(0.0, middle_y - shape.half_width_m, left.z());
    const int index =
        builder.true_rung({num_rungs + i, RungKind::kSound, left, right, shape.radius_m});
    mark(builder.rod(left, right, shape.radius_m), Part::kRung, index, shape.reflectance);
  }
}

/// Two steps of a floor before the ladder, which stands on the upper one.
void add_steps(SceneBuilder& builder) {
  const double rise = builder.draw(0.08, 0.17);
  builder.box({0.85, 0.0, 0.5 * rise}, {1.15, 1.2, 0.5 * rise});
  builder.box({0.95, 0.0, 0.5 * rise}, {1.05, 0.9, rise});
}

}  // namespace

void build_ladder_scene(SceneBuilder& builder) {
  const LadderShape shape = draw_shape(builder);
  const double lean = lean_deg(builder.params().kind);
  const bool has_treads = builder.params().rung_section == RungSection::kTread;
  builder.lean(lean);
  add_rails(builder, shape);
  if (has_treads) builder.lean(0.0);
  for (int id = 0; id < builder.params().num_rungs; ++id) {
    has_treads ? add_tread(builder, shape, id) : add_rung(builder, shape, id);
  }

  builder.lean(0.0);
  const double height =
      shape.first_height_m + builder.params().num_rungs * builder.params().spacing_m;
  const double reach = (height - kDistanceHeight_m) * std::sin(lean * std::numbers::pi / 180.0);
  const double wall_m = std::max(0.0, reach) + shape.radius_m + builder.draw(0.15, 0.20);
  switch (builder.params().kind) {
    case SceneKind::kNoWall:
      return;
    case SceneKind::kClutter:
      builder.wall(wall_m);
      return add_clutter(builder, wall_m);
    case SceneKind::kDoorway:
      return add_doorway(builder, wall_m);
    case SceneKind::kFence:
      return add_fence(builder, wall_m);
    case SceneKind::kTwoLadders:
      builder.wall(wall_m);
      return add_second_ladder(builder, shape);
    case SceneKind::kSteps:
      builder.wall(wall_m);
      return add_steps(builder);
    default:
      return builder.wall(wall_m);
  }
}

}  // namespace simulator
