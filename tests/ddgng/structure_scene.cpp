// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ddgng/structure_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace structure_scene {
namespace {

constexpr float kWall_m = 1.2F;
constexpr float kLadder_m = 1.0F;

float uniform(base::Rng& rng, float low, float high) {
  return low + (high - low) * static_cast<float>(rng.uniform());
}

// Braces, unlike parentheses, fix the order of the draws for all compilers.
Eigen::Vector3f noise(base::Rng& rng, float sigma_m) {
  const std::array<double, 3> draw = {rng.gaussian(), rng.gaussian(), rng.gaussian()};
  return sigma_m * Eigen::Vector3f(static_cast<float>(draw[0]), static_cast<float>(draw[1]),
                                   static_cast<float>(draw[2]));
}

/// Collects nodes and edges of one part after another.
struct Builder {
  explicit Builder(std::uint64_t seed) : rng(seed) {}

  int add_node(const Eigen::Vector3f& p, Part part) {
    nodes_m.push_back(p + noise(rng, 0.002F));
    parts.push_back(part);
    return static_cast<int>(nodes_m.size()) - 1;
  }

  /// A grid with one diagonal in most of its cells.
  void add_grid(const Eigen::Vector3f& corner, const Eigen::Vector3f& u, const Eigen::Vector3f& v,
                int num_u, int num_v, Part part) {
    for (int j = 0; j < num_v; ++j) {
      for (int i = 0; i < num_u; ++i) {
        const int node =
            add_node(corner + static_cast<float>(i) * u + static_cast<float>(j) * v, part);
        if (i > 0) edges.emplace_back(node - 1, node);
        if (j > 0) edges.emplace_back(node - num_u, node);
        if (i > 0 && j > 0 && rng.below(4) > 0) edges.emplace_back(node - num_u - 1, node);
      }
    }
  }

  void add_chain(const Eigen::Vector3f& from, const Eigen::Vector3f& to, int num) {
    for (int i = 0; i < num; ++i) {
      const float share = static_cast<float>(i) / static_cast<float>(num - 1);
      const int node = add_node(from + share * (to - from), Part::kLadder);
      if (i > 0) edges.emplace_back(node - 1, node);
    }
  }

  base::Rng rng;
  std::vector<Eigen::Vector3f> nodes_m;
  std::vector<Part> parts;
  std::vector<std::pair<int, int>> edges;
};

void add_points(LadderScene& scene, base::Rng& rng, Part part, int num) {
  for (int i = 0; i < num; ++i) {
    Eigen::Vector3f p;
    const float y = uniform(rng, -0.7F, 0.7F);
    if (part == Part::kFloor) {
      p = {uniform(rng, 0.3F, kWall_m), y, 0.0F};
    } else if (part == Part::kWall) {
      p = {kWall_m, y, uniform(rng, 0.0F, 2.0F)};
    } else if (i % 2 == 0) {
      p = {kLadder_m, uniform(rng, -0.2F, 0.2F), 0.3F * static_cast<float>(1 + rng.below(5))};
    } else {
      p = {kLadder_m, rng.below(2) == 0 ? -0.2F : 0.2F, uniform(rng, 0.12F, 1.8F)};
    }
    const Eigen::Vector3f ray = (p - Eigen::Vector3f(0, 0, 0.55F)).normalized();
    scene.cloud.add(p + ray * (0.01F * p.x() * static_cast<float>(rng.gaussian())));
    scene.point_part.push_back(part);
  }
}

}  // namespace

void Cloud::add(const Eigen::Vector3f& p) {
  x_m.push_back(p.x());
  y_m.push_back(p.y());
  z_m.push_back(p.z());
  head.push_back(static_cast<std::uint8_t>(head.size() % ddgng::kNumHeads));
}

ddgng::CloudView Cloud::view() const {
  ddgng::CloudView view;
  view.x_m = x_m;
  view.y_m = y_m;
  view.z_m = z_m;
  view.head = head;
  for (int i = 0; i < ddgng::kNumHeads; ++i) {
    view.head_position_m[i] = {0.0F, 0.05F * (static_cast<float>(i) - 1.5F), 0.55F};
    view.head_valid[i] = true;
  }
  view.sequence = sequence;
  view.time_step_s = 0.1F;
  return view;
}

ddgng::Topology make_topology(const std::vector<Eigen::Vector3f>& nodes_m,
                              std::vector<std::pair<int, int>> edges) {
  ddgng::Topology topology;
  for (const Eigen::Vector3f& p : nodes_m) {
    topology.node_id.push_back(topology.num_nodes());
    topology.node_x_m.push_back(p.x());
    topology.node_y_m.push_back(p.y());
    topology.node_z_m.push_back(p.z());
  }
  for (auto& [a, b] : edges) {
    if (a > b) std::swap(a, b);
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  for (const auto& [a, b] : edges) topology.edges.push_back({a, b});
  return topology;
}

ddgng::Topology random_surface(base::Rng& rng, int num_nodes) {
  std::vector<Eigen::Vector3f> nodes_m;
  const float side_m = 0.1F * std::sqrt(static_cast<float>(num_nodes));
  for (int i = 0; i < num_nodes; ++i) {
    const float x = uniform(rng, 0.0F, side_m);
    const float y = uniform(rng, 0.0F, side_m);
    nodes_m.emplace_back(1.0F + x, y, 0.3F * x * x + uniform(rng, 0.0F, 0.01F));
  }
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < num_nodes; ++i) {
    for (int j = i + 1; j < num_nodes; ++j) {
      const bool near = (nodes_m[i] - nodes_m[j]).norm() < 0.14F;
      if (near ? rng.below(10) < 7 : rng.below(200) == 0) edges.emplace_back(i, j);
    }
  }
  return make_topology(nodes_m, edges);
}

ddgng::Topology random_tangle(base::Rng& rng, int num_nodes) {
  std::vector<Eigen::Vector3f> nodes_m;
  std::vector<std::pair<int, int>> edges;
  for (int i = 0; i < num_nodes; ++i) {
    const std::array<float, 3> p = {uniform(rng, 0.5F, 1.5F), uniform(rng, -0.5F, 0.5F),
                                    uniform(rng, 0.0F, 1.0F)};
    nodes_m.emplace_back(p[0], p[1], p[2]);
    for (int j = 0; j < i; ++j) {
      if (rng.below(100) < 35) edges.emplace_back(j, i);
    }
  }
  return make_topology(nodes_m, edges);
}

LadderScene make_ladder_scene(std::uint64_t seed) {
  Builder builder(seed);
  builder.add_grid({0.3F, -0.7F, 0.0F}, {0.1F, 0, 0}, {0, 0.1F, 0}, 9, 15, Part::kFloor);
  builder.add_grid({kWall_m, -0.7F, 0.1F}, {0, 0.1F, 0}, {0, 0, 0.1F}, 15, 20, Part::kWall);
  const int first_ladder_node = static_cast<int>(builder.nodes_m.size());
  builder.add_chain({kLadder_m, -0.2F, 0.12F}, {kLadder_m, -0.2F, 1.8F}, 30);
  builder.add_chain({kLadder_m, 0.2F, 0.12F}, {kLadder_m, 0.2F, 1.8F}, 30);
  for (int rung = 1; rung <= 5; ++rung) {
    const float z = 0.3F * static_cast<float>(rung);
    builder.add_chain({kLadder_m, -0.17F, z}, {kLadder_m, 0.17F, z}, 10);
  }
  // Rungs touch the rails.
  const int num_nodes = static_cast<int>(builder.nodes_m.size());
  for (int i = first_ladder_node; i < num_nodes; ++i) {
    for (int j = i + 1; j < num_nodes; ++j) {
      if ((builder.nodes_m[i] - builder.nodes_m[j]).norm() < 0.05F)
        builder.edges.emplace_back(i, j);
    }
  }

  LadderScene scene;
  scene.topology = make_topology(builder.nodes_m, builder.edges);
  scene.node_part = builder.parts;
  scene.cloud.sequence = seed;
  base::Rng rng(seed, 7);
  add_points(scene, rng, Part::kFloor, 12000);
  add_points(scene, rng, Part::kWall, 20000);
  add_points(scene, rng, Part::kLadder, 3000);
  return scene;
}

}  // namespace structure_scene
