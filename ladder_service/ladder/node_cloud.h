// SPDX-License-Identifier: BSD-3-Clause
// The input of one frame: the topological structure as the ladder search needs it. Odom frame (z up
// against gravity); the robot's own motion is already taken out. Owns its vectors so that a caller
// can refill one cloud every frame without allocating.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace ladder {

inline constexpr int kNumHeads = 4;

enum class NodeClass : std::uint8_t { kUnknown = 0, kSafeGround = 1, kWall = 2, kObstacle = 3 };

/// The points that a node won, from one head: weight (points; older frames count less), mean,
/// covariance about that mean.
struct HeadMoment {
  int node = 0;  ///< node index
  int head = 0;  ///< 0..3
  float weight = 0.0F;
  Eigen::Vector3f mean_m = Eigen::Vector3f::Zero();
  float xx_m2 = 0.0F, xy_m2 = 0.0F, xz_m2 = 0.0F, yy_m2 = 0.0F, yz_m2 = 0.0F, zz_m2 = 0.0F;
};

struct Edge {
  int a = 0;  ///< node index
  int b = 0;
};

/// Points p with normal . p = offset_m.
struct Plane {
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();
  float offset_m = 0.0F;
  NodeClass plane_class = NodeClass::kUnknown;
};

/// An axis-aligned box around a suspected object.
struct Box {
  Eigen::Vector3f center_m = Eigen::Vector3f::Zero();
  Eigen::Vector3f size_m = Eigen::Vector3f::Zero();  ///< full extent
};

/// The node vectors are parallel. Indices count from 0 into them; ids stay with a node for its
/// life.
struct NodeCloud {
  std::uint64_t sequence = 0;

  std::vector<int> id;  ///< ascending
  std::vector<float> x_m, y_m, z_m;
  std::vector<NodeClass> node_class;
  std::vector<int> plane;           ///< index into planes, -1 = off every plane
  std::vector<HeadMoment> moments;  ///< ascending (node, head); may be empty
  std::vector<Edge> edges;
  std::vector<Plane> planes;
  std::vector<Box> suspected;

  std::array<Eigen::Vector3f, kNumHeads> head_position_m{
      Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero(),
      Eigen::Vector3f::Zero()};
  std::array<bool, kNumHeads> head_valid{};  ///< false: the position means nothing
  Eigen::Vector3f body_position_m = Eigen::Vector3f::Zero();
  float pixel_pitch_rad = 0.0F;  ///< angle between neighbouring pixels
  float range_max_m = 0.0F;

  int num_nodes() const { return static_cast<int>(id.size()); }
  Eigen::Vector3d node_m(int i) const { return {x_m[i], y_m[i], z_m[i]}; }
  void clear();
};

/// Whether the vectors' lengths, order and indices keep what is written above and the robot's own
/// numbers are finite. Single nodes and moments may still be infinite or NaN: they are passed over.
bool is_consistent(const NodeCloud& cloud);

}  // namespace ladder
