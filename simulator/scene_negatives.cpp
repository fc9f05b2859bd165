// SPDX-License-Identifier: BSD-3-Clause
// Scenes without a ladder: what a careless detector takes for one.
#include "simulator/scene_builder.h"

namespace simulator {
namespace {

using Eigen::Vector3d;

void add_bar(SceneBuilder& builder, const Vector3d& from_m, const Vector3d& to_m, double radius_m) {
  const int id = builder.num_rungs();
  const int index = builder.true_rung({id, RungKind::kBar, from_m, to_m, radius_m});
  Solid& solid = builder.rod(from_m, to_m, radius_m);
  solid.part = Part::kRung;
  solid.part_index = index;
}

/// Open-riser stairs: rise 0.19 m, boards 40 mm thick between two stringers.
void add_stairs(SceneBuilder& builder) {
  constexpr double kRise_m = 0.19, kGoing_m = 0.25;
  constexpr int kNumTreads = 9;
  for (int i = 0; i < kNumTreads; ++i) {
    builder.box({i * kGoing_m, 0.0, (i + 1) * kRise_m}, {0.13, 0.45, 0.02});
  }
  const double lean = 52.765;  // [deg] from vertical: atan(going / rise)
  builder.lean(lean);
  for (const double side : {1.0, -1.0}) {
    builder.box({0.287, side * 0.47, 1.59}, {0.05, 0.02, 1.35});
  }
  builder.lean(0.0);
  builder.wall(2.4);
}

void add_shelf(SceneBuilder& builder) {
  for (const double side : {1.0, -1.0}) builder.box({0.0, side * 0.42, 1.0}, {0.125, 0.02, 1.0});
  for (int i = 0; i < 6; ++i) builder.box({0.0, 0.0, 0.1 + 0.33 * i}, {0.125, 0.40, 0.012});
  builder.wall(0.14);
}

void add_boxes(SceneBuilder& builder) {
  for (int i = 0; i < 7; ++i) {
    const Vector3d half(builder.draw(0.05, 0.2), builder.draw(0.05, 0.25),
                        builder.draw(0.05, 0.35));
    builder.box({builder.draw(0.0, 0.8), builder.draw(-0.8, 0.8), half.z()}, half);
  }
  builder.wall(1.1);
}

void add_posts(SceneBuilder& builder) {
  for (const double y : {0.25, -0.25}) builder.capsule({0.0, y, 0.0}, {0.0, y, 1.6}, 0.025);
  const double z = builder.draw(0.5, 1.0);
  add_bar(builder, {0.0, 0.25, z}, {0.0, -0.25, z}, 0.015);
  builder.wall(builder.draw(0.2, 0.8));
}

void add_free_bar(SceneBuilder& builder) {
  const double z = builder.draw(0.5, 1.0);
  add_bar(builder, {0.0, 0.4, z}, {0.0, -0.4, z}, 0.014);
  builder.wall(builder.draw(0.2, 0.8));
}

/// Drawers 0.28 m high, each with a bar as handle.
void add_cupboard(SceneBuilder& builder) {
  builder.box({0.30, 0.0, 0.8}, {0.25, 0.4, 0.8});
  for (int i = 0; i < 5; ++i) {
    const double z = 0.2 + 0.28 * i;
    builder.box({0.045, 0.0, z}, {0.01, 0.38, 0.13});
    add_bar(builder, {0.0, 0.1, z}, {0.0, -0.1, z}, 0.006);
    for (const double y : {0.09, -0.09}) builder.rod({0.0, y, z}, {0.04, y, z}, 0.005);
  }
  builder.wall(0.56);
}

/// A grating of upright bars in a frame with two cross-bars.
void add_window_bars(SceneBuilder& builder) {
  for (int i = 0; i < 8; ++i) {
    const double y = -0.42 + 0.12 * i;
    builder.rod({0.0, y, 0.5}, {0.0, y, 1.5}, 0.008);
  }
  add_bar(builder, {0.0, 0.5, 0.5}, {0.0, -0.5, 0.5}, 0.012);
  add_bar(builder, {0.0, 0.5, 1.5}, {0.0, -0.5, 1.5}, 0.012);
  builder.wall(builder.draw(0.08, 0.15));
}

/// Balustrade: posts, hand and knee rail.
void add_handrail(SceneBuilder& builder) {
  for (const double y : {0.75, -0.75}) builder.rod({0.0, y, 0.0}, {0.0, y, 1.1}, 0.021);
  add_bar(builder, {0.0, 1.4, 0.55}, {0.0, -1.4, 0.55}, 0.017);
  add_bar(builder, {0.0, 1.4, 1.1}, {0.0, -1.4, 1.1}, 0.021);
  builder.box({0.0, 0.0, 0.06}, {0.005, 1.4, 0.06});
}

/// Tube scaffold: standards 1.2 m apart, ledgers 0.5 m apart, one diagonal, a deck.
void add_scaffold(SceneBuilder& builder) {
  for (const double x : {0.0, 0.7}) {
    for (const double y : {0.6, -0.6}) builder.rod({x, y, 0.0}, {x, y, 2.5}, 0.024);
  }
  for (int i = 0; i < 4; ++i) {
    const double z = 0.3 + 0.5 * i;
    add_bar(builder, {0.05, 0.65, z}, {0.05, -0.65, z}, 0.024);
  }
  builder.rod({0.7, 0.6, 0.2}, {0.7, -0.6, 1.9}, 0.024);
  builder.box({0.35, 0.0, 1.86}, {0.33, 0.62, 0.02});
  builder.wall(1.0);
}

/// Open shelf as narrow as a ladder: deep boards between side walls, no back.
void add_narrow_shelf(SceneBuilder& builder) {
  const double half_width = builder.draw(0.18, 0.26), spacing = builder.draw(0.26, 0.34);
  for (const double side : {1.0, -1.0}) {
    builder.box({0.0, side * (half_width + 0.01), 0.9}, {0.14, 0.01, 0.9});
  }
  for (int i = 0; i < 6; ++i) {
    builder.box({0.0, 0.0, 0.08 + spacing * i}, {0.14, half_width, 0.011});
  }
  builder.wall(builder.draw(0.16, 0.4));
}

/// Ladder-back chair: four slats between two posts, a seat and legs, its back to the robot.
void add_chair(SceneBuilder& builder) {
  for (const double y : {0.21, -0.21}) {
    builder.rod({0.0, y, 0.0}, {0.0, y, 1.1}, 0.018);
    builder.rod({0.42, y, 0.0}, {0.42, y, 0.45}, 0.018);
    builder.rod({0.0, y, 0.15}, {0.42, y, 0.15}, 0.010);
  }
  builder.box({0.21, 0.0, 0.45}, {0.22, 0.22, 0.012});
  for (const double x : {0.0, 0.42}) add_bar(builder, {x, 0.21, 0.2}, {x, -0.21, 0.2}, 0.010);
  for (int i = 0; i < 4; ++i) builder.box({0.0, 0.0, 0.58 + 0.15 * i}, {0.008, 0.20, 0.03});
  builder.wall(builder.draw(0.7, 1.5));
}

/// Pipes along a wall, on upright channels 0.6 m apart.
void add_pipes(SceneBuilder& builder) {
  const double spacing = builder.draw(0.22, 0.35);
  for (const double y : {0.3, -0.3}) builder.box({0.05, y, 1.2}, {0.02, 0.02, 1.2});
  for (int i = 0; i < 6; ++i) {
    const double z = 0.25 + spacing * i;
    add_bar(builder, {0.0, 1.6, z}, {0.0, -1.6, z}, 0.017);
  }
  builder.wall(0.07);
}

/// Bathroom radiator: two uprights, tubes in groups with gaps for towels.
void add_towel_rail(SceneBuilder& builder) {
  for (const double y : {0.26, -0.26}) builder.rod({0.0, y, 0.2}, {0.0, y, 1.6}, 0.019);
  for (const double group_m : {0.28, 0.70, 1.12}) {
    for (int i = 0; i < 5; ++i) {
      const double z = group_m + 0.05 * i;
      add_bar(builder, {0.0, 0.26, z}, {0.0, -0.26, z}, 0.011);
    }
  }
  builder.wall(0.09);
}

/// Field gate: five tubes nearer to each other below, between stiles 1.5 m apart, with a brace.
void add_gate(SceneBuilder& builder) {
  for (const double y : {0.75, -0.75}) builder.rod({0.0, y, 0.1}, {0.0, y, 1.2}, 0.022);
  for (const double z : {0.2, 0.38, 0.58, 0.83, 1.15}) {
    add_bar(builder, {0.0, 0.75, z}, {0.0, -0.75, z}, 0.019);
  }
  builder.rod({0.03, 0.75, 0.2}, {0.03, -0.75, 1.15}, 0.015);
}

}  // namespace

void build_negative_scene(SceneBuilder& builder) {
  switch (builder.params().kind) {
    case SceneKind::kStairs:
      return add_stairs(builder);
    case SceneKind::kShelf:
      return add_shelf(builder);
    case SceneKind::kBoxes:
      return add_boxes(builder);
    case SceneKind::kPosts:
      return add_posts(builder);
    case SceneKind::kFreeBar:
      return add_free_bar(builder);
    case SceneKind::kCupboard:
      return add_cupboard(builder);
    case SceneKind::kWindowBars:
      return add_window_bars(builder);
    case SceneKind::kHandrail:
      return add_handrail(builder);
    case SceneKind::kScaffold:
      return add_scaffold(builder);
    case SceneKind::kNarrowShelf:
      return add_narrow_shelf(builder);
    case SceneKind::kChair:
      return add_chair(builder);
    case SceneKind::kPipes:
      return add_pipes(builder);
    case SceneKind::kTowelRail:
      return add_towel_rail(builder);
    case SceneKind::kGate:
      return add_gate(builder);
    default:
      break;
  }
  // An empty room: a wall ahead and one at the left.
  builder.wall(builder.draw(0.3, 1.2));
  builder.box({0.0, 1.3, 1.5}, {2.5, 0.05, 1.5});
}

}  // namespace simulator
