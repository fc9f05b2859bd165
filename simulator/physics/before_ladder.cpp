// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/physics/before_ladder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace simulator {
namespace {

constexpr double kLowestRung_m = 0.20;
constexpr double kSameHeight_m = 0.02;
/// The dock of a ladder with wider spaces holds the body so far above the rear claws' rung: the
/// heads see down to 0.32 m, but near that edge not both ends of it, and it looks like a stub.
constexpr double kUsualSpacing_m = 0.30;
constexpr double kSeenBelow_m = 0.20;

int rung_at(const Scene& scene, double height_m) {
  for (std::size_t i = 0; i < scene.rungs.size(); ++i) {
    const Rung& rung = scene.rungs[i];
    const bool sound = rung.kind == RungKind::kSound;
    if (sound && std::fabs(rung.end0_m.z() - height_m) < kSameHeight_m) return static_cast<int>(i);
  }
  throw std::invalid_argument("the ladder has no sound rung at a height of " +
                              std::to_string(height_m) + " m for the claws to start from");
}

double lowest_height_m(const Scene& scene) {
  for (const Rung& rung : scene.rungs) {
    if (rung.kind == RungKind::kSound && rung.end0_m.z() > kLowestRung_m) return rung.end0_m.z();
  }
  throw std::invalid_argument("the scene has no ladder to climb");
}

}  // namespace

PlantParams before_ladder(const Scene& scene, PlantParams params) {
  const double spacing_m = scene.params.spacing_m;
  const double low_m = lowest_height_m(scene);
  params.rungs.clear();
  for (const Rung& rung : scene.rungs) {
    LadderRung held;
    held.end0_m = rung.end0_m;
    held.end1_m = rung.end1_m;
    held.radius_m = rung.radius_m;
    params.rungs.push_back(held);
  }
  const int rear = rung_at(scene, low_m);
  const int front = rung_at(scene, low_m + 2.0 * spacing_m);
  params.start_rung = {front, front, rear, rear};
  params.ladder_x_m = scene.rungs[static_cast<std::size_t>(rear)].end0_m.x();
  params.body_height_m = low_m + (spacing_m > kUsualSpacing_m ? kSeenBelow_m : spacing_m);
  return params;
}

}  // namespace simulator
