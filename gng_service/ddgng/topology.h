// SPDX-License-Identifier: BSD-3-Clause
// The result of one frame of DD-GNG: nodes, edges, triangles, their segmentation, and what was
// recognised in them. All vectors of a group are parallel. Indices count from 0 into this
// structure; ids stay with a node for its life.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace ddgng {

inline constexpr int kNumHeads = 4;

enum class Class : std::uint8_t { kUnknown = 0, kSafeGround = 1, kWall = 2, kObstacle = 3 };

/// The points that a node won, from one head: weight (points; older frames count less), mean,
/// covariance about it.
struct Moment {
  int node = 0;  ///< node index
  int head = 0;
  float weight = 0.0F;
  Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();
  float xx_m2 = 0.0F, xy_m2 = 0.0F, xz_m2 = 0.0F, yy_m2 = 0.0F, yz_m2 = 0.0F, zz_m2 = 0.0F;
};

struct Edge {
  int a = 0;  ///< node index, a < b
  int b = 0;
};

/// A triangle of three pairwise joined nodes (algorithm B of the paper, "surface").
struct Face {
  std::array<int, 3> nodes{};                         ///< node indices, ascending
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< Eq. (1), unit, towards the nearest head
  float area_m2 = 0.0F;
  int label = -1;  ///< index into labels
};

/// A segment: faces joined across edges where the angle between them stays below the threshold (Eq.
/// 2).
struct Label {
  Class label_class = Class::kUnknown;
  Eigen::Vector3f normal =
      Eigen::Vector3f::UnitZ();  ///< Eq. (3), mean of the faces' normals, not normalised
  float area_m2 = 0.0F;
  int num_faces = 0;
  float safety = 0.0F;  ///< 1 = level, 0 = vertical or worse
};

/// A large label refitted to points: normal . p = offset_m; the heads lie on the positive side.
struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float offset_m = 0.0F;
  Class plane_class = Class::kUnknown;
};

/// A connected group of obstacle nodes with its axis-aligned box.
struct Object {
  Eigen::Vector3f center_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f size_m = Eigen::Vector3f::Zero();  ///< full extent
  Eigen::Vector3f velocity_m_s = Eigen::Vector3f::Zero();
  bool suspected = false;  ///< steers the density of the next frame
};

struct Topology {
  std::vector<int> node_id;  ///< ascending
  std::vector<float> node_x_m, node_y_m, node_z_m;
  std::vector<float> node_strength;
  std::vector<float> node_error_m2, node_utility_m2;
  std::vector<Class> node_class;
  std::vector<int> node_object;  ///< index into objects, -1 = none
  std::vector<int> node_plane;   ///< index into planes, -1 = off every plane
  std::vector<Moment> moments;   ///< ascending (node, head)
  std::vector<Edge> edges;       ///< ascending (a, b)
  std::vector<Face> faces;       ///< ascending nodes
  std::vector<Label> labels;
  std::vector<Plane> planes;
  std::vector<Object> objects;

  int num_nodes() const { return static_cast<int>(node_id.size()); }
  Eigen::Vector3f node_m(int i) const { return {node_x_m[i], node_y_m[i], node_z_m[i]}; }
};

}  // namespace ddgng
