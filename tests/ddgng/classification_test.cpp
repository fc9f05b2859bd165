// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/classification.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace ddgng {
namespace {

Eigen::Vector3f normal_at(double slope_deg) {
  const double angle_rad = slope_deg * std::numbers::pi / 180.0;
  return {static_cast<float>(std::sin(angle_rad)), 0.0F, static_cast<float>(std::cos(angle_rad))};
}

Label label_with(const Eigen::Vector3f& normal, float area_m2, int num_faces) {
  Label label;
  label.normal = normal;
  label.area_m2 = area_m2;
  label.num_faces = num_faces;
  return label;
}

Class class_of(const Label& label) {
  Topology topology;
  topology.labels.push_back(label);
  classify_labels(StructureParams(), topology);
  return topology.labels[0].label_class;
}

// The approximation stays within its bound and never rises, over a fine grid of floats.
TEST(ArcCosine, FollowsTheStandardLibraryAndNeverRises) {
  float before = arc_cosine(0.0F);
  for (int i = 0; i <= 1000000; ++i) {
    const float cosine = static_cast<float>(i) * 1e-6F;
    const float angle_rad = arc_cosine(std::min(cosine, 1.0F));
    ASSERT_NEAR(angle_rad, std::acos(std::min(static_cast<double>(cosine), 1.0)), 1e-6) << cosine;
    ASSERT_LE(angle_rad, before) << cosine;
    before = angle_rad;
  }
}

// Eq. (5): the slope decides at 15 deg and at 90 +- 10 deg; ceilings are no ground.
TEST(ClassifySlope, ChangesAtTheThresholds) {
  const StructureParams params;
  EXPECT_EQ(classify_slope(params, normal_at(0.0)), Class::kSafeGround);
  EXPECT_EQ(classify_slope(params, normal_at(14.9)), Class::kSafeGround);
  EXPECT_EQ(classify_slope(params, normal_at(15.1)), Class::kObstacle);
  EXPECT_EQ(classify_slope(params, normal_at(79.9)), Class::kObstacle);
  EXPECT_EQ(classify_slope(params, normal_at(80.1)), Class::kWall);
  EXPECT_EQ(classify_slope(params, normal_at(99.9)), Class::kWall);
  EXPECT_EQ(classify_slope(params, normal_at(100.1)), Class::kObstacle);
  EXPECT_EQ(classify_slope(params, normal_at(180.0)), Class::kObstacle);
}

// The length of a mean normal does not matter, and a vanishing one has no slope.
TEST(ClassifySlope, IgnoresTheLength) {
  const StructureParams params;
  EXPECT_EQ(classify_slope(params, 0.2F * normal_at(14.0)), Class::kSafeGround);
  EXPECT_EQ(classify_slope(params, Eigen::Vector3f::Zero()), Class::kObstacle);
}

// Small labels are obstacle parts and middling ones too, whatever their slope.
TEST(ClassifyLabels, OnlyLargeLabelsAreGroundOrWall) {
  EXPECT_EQ(class_of(label_with(normal_at(0), 0.08F, 15)), Class::kSafeGround);
  EXPECT_EQ(class_of(label_with(normal_at(90), 0.08F, 15)), Class::kWall);
  EXPECT_EQ(class_of(label_with(normal_at(0), 0.06F, 15)), Class::kObstacle);
  EXPECT_EQ(class_of(label_with(normal_at(0), 0.08F, 14)), Class::kObstacle);
  EXPECT_EQ(class_of(label_with(normal_at(90), 0.005F, 40)), Class::kObstacle);
  EXPECT_EQ(class_of(label_with(normal_at(45), 1.0F, 100)), Class::kObstacle);
}

// Where labels meet, a node is ground before wall and wall before obstacle; without a face it is an
// obstacle.
TEST(ClassifyNodes, GroundBeforeWallBeforeObstacle) {
  Topology topology;
  for (int id = 0; id < 6; ++id) topology.node_id.push_back(id);
  topology.labels.resize(3);
  topology.labels[0].label_class = Class::kSafeGround;
  topology.labels[1].label_class = Class::kObstacle;
  topology.labels[2].label_class = Class::kWall;
  topology.faces.resize(3);
  topology.faces[0].nodes = {0, 1, 2};
  topology.faces[1].nodes = {1, 3, 4};
  topology.faces[2].nodes = {2, 3, 4};
  for (const int last_node : {4, 5}) {
    topology.faces[1].nodes[2] = last_node;
    for (int i = 0; i < 3; ++i) topology.faces[i].label = i;
    classify_nodes_by_labels(topology);
    using enum Class;
    EXPECT_EQ(topology.node_class,
              (std::vector{kSafeGround, kSafeGround, kSafeGround, kWall, kWall, kObstacle}));
  }
}

// The safety degree falls evenly from 1 (level) to 0 (vertical) and stays 0 beyond.
TEST(SafetyDegree, FallsWithTheSlope) {
  EXPECT_FLOAT_EQ(safety_degree(normal_at(0)), 1.0F);
  EXPECT_NEAR(safety_degree(normal_at(30)), 2.0F / 3.0F, 1e-5F);
  EXPECT_NEAR(safety_degree(normal_at(60)), 1.0F / 3.0F, 1e-5F);
  EXPECT_NEAR(safety_degree(normal_at(90)), 0.0F, 1e-5F);
  EXPECT_EQ(safety_degree(normal_at(135)), 0.0F);
  EXPECT_EQ(safety_degree(Eigen::Vector3f::Zero()), 0.0F);
}

}  // namespace
}  // namespace ddgng
