// SPDX-License-Identifier: BSD-3-Clause
#include "tests/reference/structure_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace reference {
namespace {

using ddgng::Class;

using Matrix = std::vector<std::vector<bool>>;

struct Graph {
  std::vector<Eigen::Vector3d> h;
  Matrix c;       ///< edges of the GNG
  Matrix joined;  ///< c or c'

  int size() const { return static_cast<int>(h.size()); }
  double length(int i, int j) const { return (h[i] - h[j]).norm(); }
  void add(int i, int j) { joined[i][j] = joined[j][i] = true; }
};

Graph make_graph(const ddgng::Topology& topology) {
  const int r = topology.num_nodes();
  Graph graph;
  for (int i = 0; i < r; ++i) graph.h.push_back(topology.node_m(i).cast<double>());
  graph.c.assign(r, std::vector<bool>(r, false));
  for (const ddgng::Edge& edge : topology.edges) {
    graph.c[edge.a][edge.b] = graph.c[edge.b][edge.a] = true;
  }
  graph.joined = graph.c;
  return graph;
}

void complete_pentagon(Graph& graph, const std::array<int, 5>& v) {
  for (int i = 0; i < 5; ++i) {
    if (graph.joined[v[i]][v[(i + 2) % 5]]) return;
  }
  for (int other = 0; other < graph.size(); ++other) {
    if (std::count(v.begin(), v.end(), other) > 0) continue;
    int num_joined = 0;
    for (const int node : v) num_joined += graph.joined[other][node] ? 1 : 0;
    if (num_joined >= 4) return;
  }
  int apex = -1;
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 5; ++i) {
    const double sum = graph.length(v[i], v[(i + 2) % 5]) + graph.length(v[i], v[(i + 3) % 5]);
    if (sum < best) {
      best = sum;
      apex = i;
    }
  }
  graph.add(v[apex], v[(apex + 2) % 5]);
  graph.add(v[apex], v[(apex + 3) % 5]);
}

// Each cycle a-b-c-d-e once: a smallest, b < e; in ascending (a, b, c, d, e).
void complete_pentagons(Graph& graph) {
  const int r = graph.size();
  for (int a = 0; a < r; ++a)
    for (int b = a + 1; b < r; ++b)
      for (int c = a + 1; c < r; ++c)
        for (int d = a + 1; d < r; ++d) {
          if (c == b || d == b || d == c) continue;
          if (!graph.c[a][b] || !graph.c[b][c] || !graph.c[c][d]) continue;
          for (int e = b + 1; e < r; ++e) {
            if (e == c || e == d || !graph.c[d][e] || !graph.c[e][a]) continue;
            complete_pentagon(graph, {a, b, c, d, e});
          }
        }
}

// Each cycle a-b-c-d once: a smallest, b < d; in ascending (a, b, c, d).
void complete_quadrilaterals(Graph& graph) {
  const int r = graph.size();
  for (int a = 0; a < r; ++a)
    for (int b = a + 1; b < r; ++b)
      for (int c = a + 1; c < r; ++c)
        for (int d = b + 1; d < r; ++d) {
          if (c == b || d == c) continue;
          if (!graph.c[a][b] || !graph.c[b][c] || !graph.c[c][d] || !graph.c[d][a]) continue;
          if (graph.joined[a][c] || graph.joined[b][d]) continue;
          if (graph.length(a, c) <= graph.length(b, d)) {
            graph.add(a, c);
          } else {
            graph.add(b, d);
          }
        }
}

/// Eq. (1).
Eigen::Vector3d normal_of(const Graph& graph, const std::array<int, 3>& n,
                          const ddgng::CloudView& cloud) {
  const Eigen::Vector3d& n0 = graph.h[n[0]];
  Eigen::Vector3d normal = (n0 - graph.h[n[1]]).cross(n0 - graph.h[n[2]]);
  normal /= normal.norm();
  const Eigen::Vector3d centroid = (n0 + graph.h[n[1]] + graph.h[n[2]]) / 3.0;
  Eigen::Vector3d sensor = Eigen::Vector3d::Zero();
  double nearest = std::numeric_limits<double>::infinity();
  for (int head = 0; head < ddgng::kNumHeads; ++head) {
    if (!cloud.head_valid[head]) continue;
    const Eigen::Vector3d position = cloud.head_position_m[head].cast<double>();
    if ((position - centroid).norm() >= nearest) continue;
    nearest = (position - centroid).norm();
    sensor = position;
  }
  return normal.dot(centroid - sensor) > 0.0 ? Eigen::Vector3d(-normal) : normal;
}

double area_of(const Graph& graph, const std::array<int, 3>& n) {  // Heron
  const double a = graph.length(n[0], n[1]);
  const double b = graph.length(n[1], n[2]);
  const double c = graph.length(n[2], n[0]);
  const double s = (a + b + c) / 2.0;
  return std::sqrt(std::max(0.0, s * (s - a) * (s - b) * (s - c)));
}

double angle_deg(const Eigen::Vector3d& left, const Eigen::Vector3d& right) {  // Eq. (2)
  const double cosine = left.dot(right) / (left.norm() * right.norm());
  return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// Surfaces that share an edge with surface i: at most three, those with the smallest angles.
std::vector<int> neighbors_of(const Structure& structure, int i) {
  std::vector<int> found;
  for (int j = 0; j < static_cast<int>(structure.faces.size()); ++j) {
    if (j == i) continue;
    int num_shared = 0;
    for (const int node : structure.faces[i]) {
      num_shared +=
          static_cast<int>(std::count(structure.faces[j].begin(), structure.faces[j].end(), node));
    }
    if (num_shared == 2) found.push_back(j);
  }
  std::stable_sort(found.begin(), found.end(), [&](int left, int right) {
    return angle_deg(structure.normals[i], structure.normals[left]) <
           angle_deg(structure.normals[i], structure.normals[right]);
  });
  if (found.size() > 3) found.resize(3);
  return found;
}

/// Section II-A, steps 1 to 5.
void segment(double theta_seg_deg, Structure& structure, std::vector<Eigen::Vector3d>& T,
             std::vector<int>& L) {
  const int B = static_cast<int>(structure.faces.size());
  std::vector<int>& l = structure.face_label;
  // 1.
  l.assign(B, 0);
  int n = 0;
  L.assign(B + 1, 0);
  T.assign(B + 1, Eigen::Vector3d::Zero());
  for (int i = 0; i < B; ++i) {
    // 2.
    if (l[i] == 0) {
      ++n;
      l[i] = n;
      L[n] = 1;
      T[n] = structure.normals[i];
    }
    for (const int j : neighbors_of(structure, i)) {
      if (angle_deg(structure.normals[i], structure.normals[j]) >= theta_seg_deg) continue;
      if (l[j] == 0) {  // 3.
        l[j] = l[i];
        ++L[l[i]];
        T[l[i]] += structure.normals[j];
      } else if (l[j] != l[i]) {  // 4.
        const int merged = l[j];
        L[l[i]] += L[merged];
        T[l[i]] += T[merged];
        L[merged] = 0;
        T[merged].setZero();
        std::replace(l.begin(), l.end(), merged, l[i]);
      }
    }
  }  // 5.
}

Class classify(const ddgng::StructureParams& params, const Eigen::Vector3d& normal, double area,
               int count) {
  if (area < params.small_area_m2 || count <= params.small_faces) return Class::kObstacle;
  if (area <= params.large_area_m2 || count < params.large_faces) return Class::kObstacle;
  const double theta = angle_deg(normal, Eigen::Vector3d::UnitZ());  // Eq. (4)
  if (theta <= params.safe_ground_slope_deg) return Class::kSafeGround;
  if (std::abs(theta - 90.0) <= params.wall_half_width_deg) return Class::kWall;
  return Class::kObstacle;
}

}  // namespace

Structure build_structure(const ddgng::StructureParams& params, const ddgng::CloudView& cloud,
                          const ddgng::Topology& topology) {
  Graph graph = make_graph(topology);
  if (params.complete_quadrilaterals_and_pentagons) {
    complete_pentagons(graph);
    complete_quadrilaterals(graph);
  }
  Structure structure;
  const int r = graph.size();
  for (int i = 0; i < r; ++i)
    for (int j = i + 1; j < r; ++j)
      for (int k = j + 1; k < r; ++k) {
        if (!graph.joined[i][j] || !graph.joined[i][k] || !graph.joined[j][k]) continue;
        structure.faces.push_back({i, j, k});
        structure.normals.push_back(normal_of(graph, {i, j, k}, cloud));
      }

  std::vector<Eigen::Vector3d> T;
  std::vector<int> L;
  segment(params.segment_angle_deg, structure, T, L);
  for (std::size_t i = 0; i < structure.faces.size(); ++i) {
    const int label = structure.face_label[i];
    double area = 0.0;
    for (std::size_t j = 0; j < structure.faces.size(); ++j) {
      if (structure.face_label[j] == label) area += area_of(graph, structure.faces[j]);
    }
    structure.face_label_normal.push_back(T[label] / L[label]);  // Eq. (3)
    structure.face_class.push_back(
        classify(params, structure.face_label_normal.back(), area, L[label]));
  }
  return structure;
}

}  // namespace reference
