// SPDX-License-Identifier: BSD-3-Clause
// What is behind a bar: a wall, half a wall, nothing, or only things before it.
#include "ladder/backdrop.h"

#include <limits>

#include <gtest/gtest.h>

namespace ladder {
namespace {

/// One metre ahead, from left to right.
SeenStretch bar() {
  SeenStretch stretch;
  stretch.axis = {{1.0, 0.0, 0.5}, -Eigen::Vector3d::UnitY()};
  stretch.from_m = -0.2;
  stretch.to_m = 0.2;
  stretch.eye_m = {0.0, 0.0, 0.5};
  return stretch;
}

void add_node(float x, float y, float z, int plane, NodeCloud& cloud) {
  cloud.id.push_back(cloud.num_nodes());
  cloud.x_m.push_back(x);
  cloud.y_m.push_back(y);
  cloud.z_m.push_back(z);
  cloud.node_class.push_back(NodeClass::kUnknown);
  cloud.plane.push_back(plane);
}

/// Nodes 0.2 m apart, for y from `from_m` to 0.6.
NodeCloud wall(float x, float from_m) {
  NodeCloud cloud;
  cloud.planes.resize(1);
  for (float y = from_m; y < 0.7F; y += 0.2F) {
    for (float z = 0.1F; z < 1.0F; z += 0.2F) add_node(x, y, z, 0, cloud);
  }
  return cloud;
}

// A wall behind it stands behind all of it, half a wall behind about half.
TEST(Backdrop, AWallStandsBehind) {
  EXPECT_EQ(backed_share(wall(1.2F, -0.6F), bar()), 1.0);
  const double half = backed_share(wall(1.2F, 0.2F), bar());
  EXPECT_GT(half, 0.2);
  EXPECT_LT(half, 0.9);
}

// Nothing, what is before it, what it is itself, and what is not a number is no backdrop.
TEST(Backdrop, NothingElseDoes) {
  EXPECT_EQ(backed_share(NodeCloud{}, bar()), 0.0);
  EXPECT_EQ(backed_share(wall(0.7F, -0.6F), bar()), 0.0);
  NodeCloud cloud;
  for (float y = -0.2F; y <= 0.2F; y += 0.02F) add_node(1.01F, y, 0.5F, -1, cloud);
  add_node(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.5F, -1, cloud);
  EXPECT_EQ(backed_share(cloud, bar()), 0.0);
}

// A pipe behind it counts where the rays meet it, and not beside.
TEST(Backdrop, LooseNodesReachAShortWay) {
  NodeCloud cloud;
  add_node(1.5F, 0.0F, 0.52F, -1, cloud);
  EXPECT_NEAR(backed_share(cloud, bar()), 0.2, 1e-9);
  NodeCloud beside;
  add_node(1.5F, 0.0F, 0.65F, -1, beside);
  EXPECT_EQ(backed_share(beside, bar()), 0.0);
}

}  // namespace
}  // namespace ladder
