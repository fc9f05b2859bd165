// SPDX-License-Identifier: BSD-3-Clause
// Points against the pinhole model worked out in double precision.
#include "tof/projection.h"

#include <numeric>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "tests/tof/frame_builder.h"

namespace {

using tof_test::FrameBuilder;

Eigen::Vector3d literal_point(const tof::DepthFrame& frame, int row, int column,
                              const tof::Pose& T_odom_head) {
  const auto& k = frame.intrinsics;
  Eigen::Vector3d ray((column - k.cx_px) / k.fx_px, (row - k.cy_px) / k.fy_px, 1.0);
  if (frame.depth_kind == tof::DepthKind::kRadial) ray.normalize();
  const double depth_m = frame.depth_mm[row * frame.width_px + column] * 0.001;
  return T_odom_head.p_m + T_odom_head.q * (depth_m * ray);
}

// Both kinds of depth, any pose: within a hundredth of a millimetre at 4 m.
TEST(Projection, AgreesWithThePinholeModel) {
  base::Rng rng(3);
  for (const auto kind : {tof::DepthKind::kZ, tof::DepthKind::kRadial}) {
    for (int trial = 0; trial < 20; ++trial) {
      FrameBuilder builder(37, 5, 0);
      for (auto& d : builder.depth_mm) d = static_cast<std::int16_t>(1 + rng.below(4000));
      builder.frame.depth_kind = kind;
      builder.frame.intrinsics = {30.0 + 200.0 * rng.uniform(), 30.0 + 200.0 * rng.uniform(),
                                  40.0 * rng.uniform(), 5.0 * rng.uniform()};
      const tof::DepthFrame frame = builder.view();
      tof::Pose pose;
      pose.p_m = {rng.gaussian(), rng.gaussian(), rng.gaussian()};
      pose.q = tof_test::turn(6.0 * rng.uniform(), {rng.gaussian(), rng.gaussian(), 1.0});
      tof::RayTable rays;
      rays.fit(frame);
      std::vector<int> columns(37);
      std::iota(columns.begin(), columns.end(), 0);
      std::vector<float> x(37), y(37), z(37);
      for (int row = 0; row < 5; ++row) {
        tof::project_row({row, 37, columns.data(), builder.depth_mm.data() + row * 37}, rays,
                         tof::Placement(pose), {x.data(), y.data(), z.data()});
        for (int c = 0; c < 37; ++c) {
          const Eigen::Vector3d expected = literal_point(frame, row, c, pose);
          EXPECT_LT((Eigen::Vector3d(x[c], y[c], z[c]) - expected).norm(), 1e-5);
        }
      }
    }
  }
}

// The table is built once per camera, and again whenever anything about it changes.
TEST(Projection, TableIsRebuiltOnlyOnChange) {
  FrameBuilder builder(4, 3, 1000);
  tof::RayTable rays;
  rays.fit(builder.view());
  rays.fit(builder.view());
  EXPECT_EQ(rays.num_rebuilds(), 1);
  builder.frame.intrinsics.cx_px += 1e-9;
  rays.fit(builder.view());
  EXPECT_EQ(rays.num_rebuilds(), 2);
  builder.frame.depth_kind = tof::DepthKind::kRadial;
  rays.fit(builder.view());
  EXPECT_EQ(rays.num_rebuilds(), 3);
  FrameBuilder transposed(3, 4, 1000);
  transposed.frame.intrinsics = builder.frame.intrinsics;
  transposed.frame.depth_kind = builder.frame.depth_kind;
  rays.fit(transposed.view());
  EXPECT_EQ(rays.num_rebuilds(), 4);
}

}  // namespace
