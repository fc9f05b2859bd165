// SPDX-License-Identifier: BSD-3-Clause
// Up and heading without odometry, in every attitude.
#include "tof/gravity.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "tests/tof/frame_builder.h"

namespace {

using tof_test::kStart_us;
using tof_test::turn;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kG = 9.81;
constexpr std::int64_t kStep_us = 5000;

tof::Gravity fresh() {
  return tof::Gravity(tof::GravityParams{}, tof::PoseParams{});
}

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180.0 / M_PI;
}

tof::ImuSample at_rest(std::int64_t utime_us, const Eigen::Vector3d& up) {
  return {utime_us, kG * up, Eigen::Vector3d::Zero()};
}

Eigen::Vector3d random_direction(base::Rng& rng) {
  return Eigen::Vector3d(rng.gaussian(), rng.gaussian(), rng.gaussian()).normalized();
}

// No sample, no up.
TEST(Gravity, NeverASample) {
  EXPECT_FALSE(fresh().up_at(kStart_us).has_value());
  EXPECT_FALSE(fresh().newest_up().has_value());
}

// What is not a measurement of gravity leaves no trace.
TEST(Gravity, BadSamplesAreRefused) {
  tof::Gravity gravity = fresh();
  EXPECT_FALSE(gravity.add({kStart_us, {kNaN, 0, kG}, {0, 0, 0}}));
  EXPECT_FALSE(gravity.add({kStart_us, {0, 0, kG}, {0, kNaN, 0}}));
  EXPECT_FALSE(gravity.add({kStart_us, {0, 0, 0}, {0, 0, 0}}));
  EXPECT_FALSE(gravity.add({kStart_us, {0, 0, 1e9}, {0, 0, 0}}));
  EXPECT_FALSE(gravity.add({kStart_us, {0, 0, 3 * kG}, {0, 0, 0}})) << "a first sample in a crash";
  EXPECT_FALSE(gravity.newest_up().has_value());
  EXPECT_TRUE(gravity.add({kStart_us, {0, 0, kG}, {0, 0, 0}}));
  EXPECT_FALSE(gravity.add({kStart_us, {0, kG, 0}, {0, 0, 0}})) << "the same time again";
  EXPECT_FALSE(gravity.add({kStart_us - 1, {0, kG, 0}, {0, 0, 0}})) << "backwards";
  EXPECT_EQ(*gravity.newest_up(), Eigen::Vector3d::UnitZ());
}

// The first sample is the estimate: pitch 90 and upside-down are like any other attitude.
TEST(Gravity, FirstSampleInitialises) {
  for (const Eigen::Vector3d& up : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, -1),
                                    Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0, 0, 1)}) {
    tof::Gravity gravity = fresh();
    ASSERT_TRUE(gravity.add(at_rest(kStart_us, up)));
    EXPECT_LT(angle_deg(*gravity.up_at(kStart_us), up), 1e-6);
  }
}

// However wrong the first sample, the estimate is within 1 deg after one second.
TEST(Gravity, ConvergesWithinASecondFromAnyAttitude) {
  base::Rng rng(11);
  for (int trial = 0; trial < 60; ++trial) {
    const Eigen::Vector3d truth =
        trial == 0 ? Eigen::Vector3d::UnitX().eval() : random_direction(rng);
    const Eigen::Vector3d first = trial % 3 == 0 ? (-truth).eval() : random_direction(rng);
    tof::Gravity gravity = fresh();
    gravity.add(at_rest(kStart_us, first));
    std::int64_t utime_us = kStart_us;
    while (utime_us < kStart_us + 1'000'000) {
      utime_us += kStep_us;
      gravity.add(at_rest(utime_us, truth));
    }
    EXPECT_LT(angle_deg(*gravity.up_at(utime_us), truth), 1.0) << trial;
  }
}

// Turning at 1 rad/s through pitch 90 deg and on over the back: the gyroscope carries it, the noise
// of the accelerometer is averaged.
TEST(Gravity, FollowsATurnThroughPitch90) {
  base::Rng rng(2);
  tof::Gravity gravity = fresh();
  double worst_deg = 0.0;
  for (int i = 0; i < 800; ++i) {
    const double pitch_rad = 1e-6 * static_cast<double>(kStep_us) * i;
    const Eigen::Quaterniond q_world_body = turn(-pitch_rad, Eigen::Vector3d::UnitY());
    const Eigen::Vector3d up = q_world_body.inverse() * Eigen::Vector3d::UnitZ();
    tof::ImuSample sample = at_rest(kStart_us + kStep_us * i, up);
    sample.gyroscope_rad_s = {0.0, -1.0, 0.0};
    sample.accelerometer_m_s2 += 0.3 * random_direction(rng);
    gravity.add(sample);
    worst_deg = std::max(worst_deg, angle_deg(*gravity.newest_up(), up));
  }
  EXPECT_LT(worst_deg, 2.0);
}

// A shove of 1 g sideways for a quarter of a second moves the estimate by less than 3 deg.
TEST(Gravity, LargeAccelerationsHaveLittleWeight) {
  tof::Gravity gravity = fresh();
  double worst_deg = 0.0;
  for (int i = 0; i < 400; ++i) {
    const bool is_shove = i >= 200 && i < 250;
    tof::ImuSample sample = at_rest(kStart_us + kStep_us * i, Eigen::Vector3d::UnitZ());
    if (is_shove) sample.accelerometer_m_s2.x() = kG;
    gravity.add(sample);
    worst_deg = std::max(worst_deg, angle_deg(*gravity.newest_up(), Eigen::Vector3d::UnitZ()));
  }
  EXPECT_LT(worst_deg, 3.0);
}

// After a silence the next sample starts afresh; in the silence there is no up.
TEST(Gravity, SilenceRestarts) {
  tof::Gravity gravity = fresh();
  gravity.add(at_rest(kStart_us, Eigen::Vector3d::UnitZ()));
  gravity.add(at_rest(kStart_us + 2'000'000, Eigen::Vector3d::UnitX()));
  EXPECT_FALSE(gravity.up_at(kStart_us + 1'000'000).has_value());
  EXPECT_LT(angle_deg(*gravity.newest_up(), Eigen::Vector3d::UnitX()), 1e-6);
}

// A body turned by any rotation measures the turned up, bit for bit close: no attitude is special.
TEST(Gravity, IsEquivariant) {
  base::Rng rng(23);
  for (int trial = 0; trial < 30; ++trial) {
    const Eigen::Quaterniond turned = turn(6.0 * rng.uniform(), random_direction(rng));
    tof::Gravity plain = fresh();
    tof::Gravity other = fresh();
    for (int i = 0; i < 100; ++i) {
      tof::ImuSample sample = at_rest(kStart_us + kStep_us * i, Eigen::Vector3d::UnitZ());
      sample.accelerometer_m_s2 += random_direction(rng);
      sample.gyroscope_rad_s = random_direction(rng);
      plain.add(sample);
      sample.accelerometer_m_s2 = turned * sample.accelerometer_m_s2;
      sample.gyroscope_rad_s = turned * sample.gyroscope_rad_s;
      other.add(sample);
    }
    EXPECT_LT((turned * *plain.newest_up() - *other.newest_up()).norm(), 1e-9);
  }
}

// z of odom is up and the horizontal part of the view is x, for any attitude and any head.
TEST(GravityFrame, HeadingIsWhereTheHeadLooks) {
  base::Rng rng(31);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Vector3d up = random_direction(rng);
    const Eigen::Quaterniond q_body_head = turn(6.0 * rng.uniform(), random_direction(rng));
    const Eigen::Vector3d view = q_body_head * Eigen::Vector3d::UnitZ();
    tof::GravityFrame frame;
    frame.fix(up, view, q_body_head * -Eigen::Vector3d::UnitY());
    const Eigen::Quaterniond q = frame.q_odom_body(up);
    EXPECT_LT((q * up - Eigen::Vector3d::UnitZ()).norm(), 1e-4);
    if (std::abs(view.dot(up)) > 0.99) continue;
    const Eigen::Vector3d seen = q * view;
    EXPECT_NEAR(seen.y(), 0.0, 1e-4);
    EXPECT_GT(seen.x(), 0.0);
  }
}

// A head that looks straight down is steered by its image's upper edge, straight up by the lower.
TEST(GravityFrame, VerticalViews) {
  for (const double sign : {-1.0, 1.0}) {
    tof::GravityFrame frame;
    frame.fix(Eigen::Vector3d::UnitZ(), sign * Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY());
    const Eigen::Vector3d edge =
        frame.q_odom_body(Eigen::Vector3d::UnitZ()) * (-sign * Eigen::Vector3d::UnitY());
    EXPECT_LT((edge - Eigen::Vector3d::UnitX()).norm(), 1e-6);
  }
}

// Pitching up to the ladder and back brings every direction back: the heading does not wander.
TEST(GravityFrame, HeadingDoesNotDrift) {
  tof::GravityFrame frame;
  const Eigen::Vector3d ahead = Eigen::Vector3d::UnitX();
  frame.fix(Eigen::Vector3d::UnitZ(), ahead, Eigen::Vector3d::UnitZ());
  for (int degree = 0; degree <= 90; degree += 5) {
    const Eigen::Quaterniond q_odom_body = turn(-degree * M_PI / 180.0, Eigen::Vector3d::UnitY());
    const Eigen::Vector3d up = q_odom_body.inverse() * Eigen::Vector3d::UnitZ();
    EXPECT_LT(frame.q_odom_body(up).angularDistance(q_odom_body), 1e-6) << degree;
  }
  EXPECT_LT((frame.q_odom_body(Eigen::Vector3d::UnitZ()) * ahead - ahead).norm(), 1e-12);
}

}  // namespace
