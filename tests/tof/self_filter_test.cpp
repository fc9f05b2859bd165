// SPDX-License-Identifier: BSD-3-Clause
// Own limbs: every pixel on one goes, and no other.
#include "tof/self_filter.h"

#include <cmath>

#include <gtest/gtest.h>

#include "frame_builder.h"
#include "tof/fusion.h"

namespace {

using tof_test::FrameBuilder;

struct Scene {
  Scene() : built(60, 40, 500) {
    built.view();
    built.frame.T_body_head = {Eigen::Vector3d::Zero(), tof_test::looking_ahead()};
    rays.fit(built.frame);
    image.depth_mm = built.depth_mm;
    image.num_kept = static_cast<int>(built.depth_mm.size());
  }
  /// In the body's frame, which is the head's turned.
  Eigen::Vector3d point_m(int column, int row) const {
    const tof::Intrinsics& k = built.frame.intrinsics;
    const Eigen::Vector3d p((column - k.cx_px) / k.fx_px * 0.5, (row - k.cy_px) / k.fy_px * 0.5,
                            0.5);
    return built.frame.T_body_head.q * p;
  }
  FrameBuilder built;
  tof::RayTable rays;
  tof::FilteredImage image;
};

double distance_m(const Eigen::Vector3d& p, const tof::Capsule& c) {
  const Eigen::Vector3d along = c.to_m - c.from_m;
  const double share =
      std::clamp((p - c.from_m).dot(along) / std::max(along.squaredNorm(), 1e-18), 0.0, 1.0);
  return (p - c.from_m - share * along).norm();
}

/// Exactly the pixels within a capsule are dropped, wherever it lies: across the image, at its
/// border, towards the head, a point, behind the head.
TEST(SelfFilter, DropsWhatIsWithinACapsuleAndNothingElse) {
  const tof::Capsule capsules[] = {
      {{0.5, 0.03, 0.0}, {0.5, -0.03, 0.01}, 0.01},   {{0.5, 0.2, 0.2}, {0.5, 0.04, 0.03}, 0.02},
      {{0.1, 0.0, 0.0}, {0.7, 0.02, 0.0}, 0.015},     {{0.0, 0.0, 0.0}, {0.5, 0.0, 0.0}, 0.02},
      {{0.49, 0.01, 0.01}, {0.49, 0.01, 0.01}, 0.02}, {{-0.5, 0.0, 0.0}, {-0.3, 0.0, 0.0}, 0.1}};
  for (const tof::Capsule& capsule : capsules) {
    Scene scene;
    tof::Limbs limbs;
    limbs.fill({{9.0, 9.0, 9.0}, {9.0, 9.0, 9.0}, 0.0});
    limbs[0] = capsule;
    const int dropped = tof::drop_limbs(scene.built.frame, scene.rays, limbs, scene.image);
    int expected = 0;
    for (int row = 0; row < scene.built.height; ++row) {
      for (int column = 0; column < scene.built.width; ++column) {
        const double off_m = distance_m(scene.point_m(column, row), capsule) - capsule.radius_m;
        if (std::fabs(off_m) < 1e-6) continue;  // on the surface: either
        const bool is_kept =
            scene.image.depth_mm[static_cast<std::size_t>(row * scene.built.width + column)] != 0;
        EXPECT_EQ(is_kept, off_m > 0.0) << column << "," << row << " of capsule "
                                        << (&capsule - capsules) << ", off by " << off_m;
        expected += off_m <= 0.0 ? 1 : 0;
      }
    }
    EXPECT_EQ(dropped, expected);
    EXPECT_EQ(scene.image.num_kept, 60 * 40 - expected);
  }
}

/// Joint angles that are no angles, or have no time, are not taken.
TEST(SelfFilter, RefusesAnglesThatAreNone) {
  tof::Fusion fusion{tof::TofParams{}};
  tof::JointAngles angles{};
  EXPECT_FALSE(fusion.add_joints(0, angles));
  EXPECT_TRUE(fusion.add_joints(tof_test::kStart_us, angles));
  EXPECT_FALSE(fusion.add_joints(tof_test::kStart_us, angles));
  angles[3] = std::nan("");
  EXPECT_FALSE(fusion.add_joints(tof_test::kStart_us + 1, angles));
  angles[3] = 5.0;
  EXPECT_FALSE(fusion.add_joints(tof_test::kStart_us + 1, angles));
}

}  // namespace
