// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/triangulation.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

#include <Eigen/Geometry>

#include "ddgng/heads.h"

namespace ddgng {
namespace {

constexpr int kMaxFacesInMessage = 524288;
constexpr double kMaxFaceArea_m2 = 1e6;  // a larger one is no measurement and would not fit a float

double distance_m(const Topology& topology, int a, int b) {
  return (topology.node_m(a).cast<double>() - topology.node_m(b).cast<double>()).norm();
}

bool is_before(const Edge& left, const Edge& right) {
  return std::tie(left.a, left.b) < std::tie(right.a, right.b);
}

}  // namespace

Triangulation::Triangulation(const StructureParams& params, int max_nodes, int max_edges)
    : complete_(params.complete_quadrilaterals_and_pentagons),
      max_faces_(static_cast<int>(std::min<std::int64_t>(
          std::int64_t{params.max_faces_per_node} * max_nodes, kMaxFacesInMessage))),
      max_sides_(2 * max_edges),
      joined_(max_nodes, max_edges) {
  added_sides_.reserve(max_edges);
  sides_.reserve(max_sides_);
  first_side_.reserve(max_nodes + 1);
  side_to_.reserve(max_nodes);
  near_a_.reserve(max_nodes);
  near_b_.reserve(max_nodes);
  face_sides_.reserve(max_faces_);
}

void Triangulation::build(const CloudView& cloud, Topology& topology) {
  num_dropped_ = 0;
  joined_.reset(topology.num_nodes(), topology.edges);
  if (complete_) {
    near_a_.assign(topology.num_nodes(), -1);
    near_b_.assign(topology.num_nodes(), -1);
    complete_pentagons(topology);
    complete_quadrilaterals(topology);
  }
  collect_sides(topology);
  find_faces(cloud, topology);
}

// Chordless cycles a-b-c-d-e over c. Each is met once: a is its smallest node and b < e. The order
// is ascending (a, b, c, d, e); each cycle sees the supplementary edges made before it. Marks rule
// out most cycles that have an edge as chord before the full test.
void Triangulation::complete_pentagons(const Topology& topology) {
  for (int a = 0; a < joined_.num_nodes(); ++a) {
    for (const int other : joined_.neighbors(a)) near_a_[other] = a;
    for (const int b : joined_.neighbors(a)) {
      if (b < a) continue;
      for (const int other : joined_.neighbors(b)) near_b_[other] = b;
      for (const int c : joined_.neighbors(b)) {
        if (c <= a || near_a_[c] == a) continue;
        for (const int d : joined_.neighbors(c)) {
          if (d <= a || d == b || near_a_[d] == a || near_b_[d] == b) continue;
          for (const int e : joined_.neighbors(d)) {
            if (e <= b || near_a_[e] != a || near_b_[e] == b) continue;
            complete_pentagon(topology, {a, b, c, d, e});
          }
        }
      }
    }
  }
}

void Triangulation::complete_pentagon(const Topology& topology, const std::array<int, 5>& cycle) {
  if (has_chord(cycle) || is_surrounded(cycle)) return;
  // A fan of two edges from the node to which they are shortest; ties to the first of the cycle.
  int apex = 0;
  double shortest_m = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double length_m = distance_m(topology, cycle[i], cycle[(i + 2) % 5]) +
                            distance_m(topology, cycle[i], cycle[(i + 3) % 5]);
    if (i > 0 && length_m >= shortest_m) continue;
    apex = i;
    shortest_m = length_m;
  }
  join(cycle[apex], cycle[(apex + 2) % 5]);
  join(cycle[apex], cycle[(apex + 3) % 5]);
}

bool Triangulation::has_chord(const std::array<int, 5>& cycle) const {
  for (int i = 0; i < 5; ++i) {
    if (joined_.is_joined(cycle[i], cycle[(i + 2) % 5])) return true;
  }
  return false;
}

// True when another node is joined to four or more of the five: it closes the pentagon already. It
// is then joined to at least one of any two of them.
bool Triangulation::is_surrounded(const std::array<int, 5>& cycle) const {
  bool found = false;
  const auto count_joined = [&](int node) {
    if (std::find(cycle.begin(), cycle.end(), node) != cycle.end()) return;
    int num_joined = 0;
    for (const int member : cycle) num_joined += joined_.is_joined(node, member) ? 1 : 0;
    if (num_joined >= 4) found = true;
  };
  joined_.for_each_joined(cycle[0], count_joined);
  if (!found) joined_.for_each_joined(cycle[1], count_joined);
  return found;
}

// Chordless cycles a-b-c-d over c, a the smallest node and b < d, in ascending (a, b, c, d): the
// shorter diagonal is added, a-c when both are equal.
void Triangulation::complete_quadrilaterals(const Topology& topology) {
  for (int a = 0; a < joined_.num_nodes(); ++a) {
    for (const int other : joined_.neighbors(a)) near_a_[other] = a;
    for (const int b : joined_.neighbors(a)) {
      if (b < a) continue;
      for (const int c : joined_.neighbors(b)) {
        if (c <= a || near_a_[c] == a) continue;
        for (const int d : joined_.neighbors(c)) {
          if (d <= b || near_a_[d] != a) continue;
          if (joined_.is_joined(a, c) || joined_.is_joined(b, d)) continue;
          if (distance_m(topology, a, c) <= distance_m(topology, b, d)) {
            join(a, c);
          } else {
            join(b, d);
          }
        }
      }
    }
  }
}

void Triangulation::join(int a, int b) {
  if (!joined_.join(a, b)) ++num_dropped_;
}

void Triangulation::collect_sides(const Topology& topology) {
  const auto supplementary = joined_.supplementary();
  added_sides_.assign(supplementary.begin(), supplementary.end());
  std::sort(added_sides_.begin(), added_sides_.end(), is_before);
  sides_.resize(topology.edges.size() + added_sides_.size());
  std::merge(topology.edges.begin(), topology.edges.end(), added_sides_.begin(), added_sides_.end(),
             sides_.begin(), is_before);

  first_side_.assign(topology.num_nodes() + 1, 0);
  for (const Edge& side : sides_) ++first_side_[side.a + 1];
  for (int node = 0; node < topology.num_nodes(); ++node) {
    first_side_[node + 1] += first_side_[node];
  }
}

// All a < b < c pairwise joined in c or c', in ascending order.
void Triangulation::find_faces(const CloudView& cloud, Topology& topology) {
  topology.faces.clear();
  face_sides_.clear();
  side_to_.assign(topology.num_nodes(), -1);
  for (int a = 0; a < topology.num_nodes(); ++a) {
    for (int ab = first_side_[a]; ab < first_side_[a + 1]; ++ab) side_to_[sides_[ab].b] = ab;
    for (int ab = first_side_[a]; ab < first_side_[a + 1]; ++ab) {
      const int b = sides_[ab].b;
      for (int bc = first_side_[b]; bc < first_side_[b + 1]; ++bc) {
        const int ac = side_to_[sides_[bc].b];
        if (ac >= 0) add_face(cloud, {ab, bc, ac}, topology);
      }
    }
    for (int ab = first_side_[a]; ab < first_side_[a + 1]; ++ab) side_to_[sides_[ab].b] = -1;
  }
}

void Triangulation::add_face(const CloudView& cloud, const std::array<int, 3>& sides,
                             Topology& topology) {
  Face face;
  face.nodes = {sides_[sides[0]].a, sides_[sides[0]].b, sides_[sides[1]].b};
  const Eigen::Vector3f p0 = topology.node_m(face.nodes[0]);
  const Eigen::Vector3f p1 = topology.node_m(face.nodes[1]);
  const Eigen::Vector3f p2 = topology.node_m(face.nodes[2]);

  // Eq. (1), and the area as half the length of the cross product.
  const Eigen::Vector3d cross =
      (p0.cast<double>() - p1.cast<double>()).cross(p0.cast<double>() - p2.cast<double>());
  const double length = cross.norm();
  face.area_m2 = static_cast<float>(0.5 * std::min(length, 4.0 * kMaxFaceArea_m2));
  if (face.area_m2 <= 0.0F || face.area_m2 > kMaxFaceArea_m2) return;
  face.normal = (cross / length).cast<float>();

  const Eigen::Vector3f centroid_m = (p0 + p1 + p2) / 3.0F;
  if (const auto head_m = nearest_head_position(cloud, centroid_m)) {
    if (face.normal.dot(centroid_m - *head_m) > 0.0F) face.normal = -face.normal;
  } else if (face.normal.z() < 0.0F) {
    face.normal = -face.normal;
  }

  if (static_cast<int>(topology.faces.size()) == max_faces_) {
    ++num_dropped_;
    return;
  }
  topology.faces.push_back(face);
  face_sides_.push_back(sides);
}

}  // namespace ddgng
