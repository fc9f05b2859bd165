// SPDX-License-Identifier: BSD-3-Clause
// Graphs and clouds for the tests of the structure part: random ones, and a ladder before a wall.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "base/rng.h"
#include "ddgng/cloud.h"
#include "ddgng/structure_params.h"
#include "ddgng/topology.h"

namespace structure_scene {

/// A cloud that owns its points; seen from four heads near (0, 0, 0.55).
struct Cloud {
  std::vector<float> x_m, y_m, z_m;
  std::vector<std::uint8_t> head;
  std::uint64_t sequence = 1;

  void add(const Eigen::Vector3f& p);
  ddgng::CloudView view() const;
};

/// Nodes with ids 0, 1, ...; edges may be given in any order and more than once.
ddgng::Topology make_topology(const std::vector<Eigen::Vector3f>& nodes_m,
                              std::vector<std::pair<int, int>> edges);

/// Random nodes on gently curved ground, joined when near; some edges are left out, so that
/// quadrilaterals and pentagons remain, and some far nodes are joined.
ddgng::Topology random_surface(base::Rng& rng, int num_nodes);

/// Random nodes in a cube, joined at random: many edges with more than two faces.
ddgng::Topology random_tangle(base::Rng& rng, int num_nodes);

/// Which part of the ladder scene a node or point belongs to.
enum class Part : std::uint8_t { kFloor, kWall, kLadder };

struct LadderScene {
  ddgng::Topology topology;
  std::vector<Part> node_part;
  Cloud cloud;
  std::vector<Part> point_part;
};

/// Floor (z = 0), wall (x = 1.2 m) and before it a ladder of five rungs with two rails (x = 1.0 m);
/// nodes and points carry noise of 1 % of the distance.
LadderScene make_ladder_scene(std::uint64_t seed);

}  // namespace structure_scene
