// SPDX-License-Identifier: BSD-3-Clause
// The stream of messages: times, order, reproducibility, truth.
#include "simulator/simulation.h"

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace simulator {
namespace {

using ladder_msgs::imu_t;
using ladder_msgs::tof_frame_t;
using ladder_msgs::truth_t;

constexpr std::int64_t kStart_us = 1'000'000'000;

SimulationParams small(SceneKind kind = SceneKind::kPlain) {
  SimulationParams params;
  params.scene.kind = kind;
  params.start_utime_us = kStart_us;
  return params;
}

std::vector<Message> run(const SimulationParams& params, std::int64_t duration_us,
                         std::int64_t step_us) {
  Simulation simulation(params);
  std::vector<Message> all;
  for (std::int64_t t = 0; t <= duration_us; t += step_us) {
    const auto& due = simulation.advance_to(params.start_utime_us + t);
    all.insert(all.end(), due.begin(), due.end());
  }
  return all;
}

std::vector<std::uint8_t> bytes_of(const std::vector<Message>& messages) {
  std::vector<std::uint8_t> bytes;
  for (const Message& message : messages) {
    std::visit(
        [&bytes](const auto& value) {
          const auto size = static_cast<std::size_t>(value.getEncodedSize());
          bytes.resize(bytes.size() + size);
          value.encode(bytes.data() + bytes.size() - size, 0, static_cast<int>(size));
        },
        message);
  }
  return bytes;
}

template <class Msg>
std::vector<Msg> only(const std::vector<Message>& messages) {
  std::vector<Msg> found;
  for (const Message& message : messages) {
    if (const Msg* value = std::get_if<Msg>(&message)) found.push_back(*value);
  }
  return found;
}

// Nothing is due before the start; a time asked for twice or going back gives nothing new.
TEST(Simulation, AskedTooEarlyTwiceOrBackwards) {
  Simulation simulation(small());
  EXPECT_TRUE(simulation.advance_to(kStart_us - 1).empty());
  EXPECT_FALSE(simulation.advance_to(kStart_us + 100'000).empty());
  EXPECT_TRUE(simulation.advance_to(kStart_us + 100'000).empty());
  EXPECT_TRUE(simulation.advance_to(kStart_us).empty());
}

// The messages do not depend on how often one asks, and a second run has the same bytes; another
// seed has others.
TEST(Simulation, SameSeedSameBytes) {
  const auto bytes = bytes_of(run(small(), 300'000, 1'000));
  EXPECT_EQ(bytes, bytes_of(run(small(), 300'000, 100'000)));
  SimulationParams other = small();
  other.scene.seed = 2;
  EXPECT_NE(bytes, bytes_of(run(other, 300'000, 1'000)));
}

// Messages come in order of time, seq counts from 0 without a gap, and no time is later than asked.
TEST(Simulation, OrderAndSequence) {
  Simulation simulation(small());
  std::int64_t last_us = 0;
  std::map<std::string, std::int64_t> next_seq;
  for (std::int64_t t = kStart_us; t <= kStart_us + 400'000; t += 7'000) {
    for (const Message& message : simulation.advance_to(t)) {
      EXPECT_GE(utime_us(message), last_us);
      EXPECT_LE(utime_us(message), t);
      last_us = utime_us(message);
      std::string stream = std::to_string(message.index());
      if (const auto* frame = std::get_if<tof_frame_t>(&message))
        stream += std::to_string(frame->head);
      EXPECT_EQ(std::visit([](const auto& m) { return m.seq; }, message), next_seq[stream]++);
    }
  }
  EXPECT_EQ(next_seq.size(), 6U) << "four heads, IMU, truth";
}

// Heads follow one another by 1/60 s and repeat with 15 Hz; the IMU runs at 200 Hz.
TEST(Simulation, Times) {
  const auto messages = run(small(), 999'999, 999'999);
  const auto frames = only<tof_frame_t>(messages);
  ASSERT_EQ(frames.size(), 60U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].head, static_cast<int>(i % 4));
    EXPECT_NEAR(static_cast<double>(frames[i].utime - kStart_us),
                1e6 * static_cast<double>(i) / 60.0, 1.01);
  }
  EXPECT_EQ(only<imu_t>(messages).size(), 200U);
}

// A frame describes itself: sizes, intrinsics, range, unit quaternion, depths within the range.
TEST(Simulation, FrameIsComplete) {
  for (const tof_frame_t& frame : only<tof_frame_t>(run(small(), 60'000, 60'000))) {
    EXPECT_EQ(frame.num_pixels, 224 * 171);
    EXPECT_EQ(frame.depth_mm.size(), 224U * 171U);
    EXPECT_EQ(frame.confidence.size(), 224U * 171U);
    EXPECT_NEAR(frame.fx_px, 186.4, 0.1);
    EXPECT_NEAR(frame.fy_px, 206.4, 0.1);
    double norm = 0.0;
    for (const double q : frame.q_body_head) norm += q * q;
    EXPECT_NEAR(norm, 1.0, 1e-12);
    for (const std::int16_t depth_mm : frame.depth_mm) {
      ASSERT_TRUE(depth_mm == 0 || (depth_mm >= 100 && depth_mm <= 4000));
    }
  }
}

// Dead heads are silent, the others go on, and the truth counts what the living ones see.
TEST(Simulation, DeadHeads) {
  SimulationParams params = small();
  params.head_dead = {true, false, true, false};
  const auto messages = run(params, 66'000, 66'000);
  for (const tof_frame_t& frame : only<tof_frame_t>(messages)) EXPECT_EQ(frame.head % 2, 1);
  const auto truths = only<truth_t>(messages);
  ASSERT_EQ(truths.size(), 1U);
  EXPECT_GT(*std::max_element(truths[0].rung_hits.begin(), truths[0].rung_hits.end()), 0);
}

// With no head alive there is still gravity, and a truth without hits.
TEST(Simulation, NoHeadAlive) {
  SimulationParams params = small();
  params.head_dead = {true, true, true, true};
  const auto messages = run(params, 200'000, 200'000);
  EXPECT_TRUE(only<tof_frame_t>(messages).empty());
  EXPECT_EQ(only<imu_t>(messages).size(), 41U);
  const auto truths = only<truth_t>(messages);
  ASSERT_EQ(truths.size(), 3U);
  for (const int hits : truths[0].rung_hits) EXPECT_EQ(hits, 0);
}

// At rest the accelerometer points up with 9.81 m/s^2.
TEST(Simulation, ImuFeelsGravity) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto samples = only<imu_t>(run(small(), 1'000'000, 1'000'000));
  for (const imu_t& sample : samples) {
    sum += Eigen::Map<const Eigen::Vector3d>(sample.accelerometer_m_s2);
    EXPECT_LT(std::abs(sample.gyroscope_rad_s[0]), 0.02);
  }
  const Eigen::Vector3d mean = sum / static_cast<double>(samples.size());
  EXPECT_LT((mean - Eigen::Vector3d(0.0, 0.0, 9.81)).norm(), 0.01);
}

// Odom starts at the body, and head 0 looks along its x axis (seen from above).
TEST(Simulation, OdomFollowsHeadZero) {
  const Simulation simulation(small());
  const Eigen::Isometry3d T_odom_body =
      simulation.T_odom_world() * simulation.T_world_body(kStart_us);
  EXPECT_LT(T_odom_body.translation().norm(), 1e-12);
  const Eigen::Vector3d ahead =
      (T_odom_body * simulation.head(0).T_body_head_nominal()).linear().col(2);
  EXPECT_NEAR(ahead.y(), 0.0, 1e-12);
  EXPECT_GT(ahead.x(), 0.5);
  EXPECT_NEAR((T_odom_body.linear() * Eigen::Vector3d::UnitZ()).z(), 1.0, 1e-12);
}

// The points of clean rung pixels, taken to odom with the nominal mounting as a receiver would, lie
// on the rungs that the truth describes.
TEST(Simulation, FramesAndTruthShareTheOdomFrame) {
  SimulationParams params = small();
  params.sensor.noise_share = params.sensor.noise_floor_m = params.sensor.wiggle_m = 0.0;
  params.sensor.extrinsic_sigma_m = params.sensor.extrinsic_sigma_deg = 0.0;
  Simulation simulation(params);
  const auto messages = simulation.advance_to(kStart_us + 60'000);
  const truth_t truth = only<truth_t>(messages).at(0);
  const Eigen::Quaterniond q_odom_body(truth.q_odom_body[0], truth.q_odom_body[1],
                                       truth.q_odom_body[2], truth.q_odom_body[3]);
  int num_points = 0;
  for (const tof_frame_t& frame : only<tof_frame_t>(messages)) {
    const HeadImage& image = simulation.image(frame.head);
    const Eigen::Quaterniond q_body_head(frame.q_body_head[0], frame.q_body_head[1],
                                         frame.q_body_head[2], frame.q_body_head[3]);
    for (std::size_t i = 0; i < image.clean_geom.size(); ++i) {
      if (image.clean_geom[i] < 0) continue;
      const int rung = simulation.world().rung_of_geom()[image.clean_geom[i]];
      if (rung < 0) continue;
      const double x_px = static_cast<double>(i % 224), y_px = static_cast<double>(i / 224);
      const Eigen::Vector3d ray = Eigen::Vector3d((x_px - frame.cx_px) / frame.fx_px,
                                                  (y_px - frame.cy_px) / frame.fy_px, 1.0)
                                      .normalized();
      const Eigen::Vector3d p_body = Eigen::Map<const Eigen::Vector3d>(frame.p_body_head_m) +
                                     q_body_head * (1e-3 * frame.depth_mm[i] * ray);
      const Eigen::Vector3d p_odom = q_odom_body * p_body;
      const Eigen::Vector3d end0(truth.rung_x0_m[rung], truth.rung_y0_m[rung],
                                 truth.rung_z0_m[rung]);
      const Eigen::Vector3d end1(truth.rung_x1_m[rung], truth.rung_y1_m[rung],
                                 truth.rung_z1_m[rung]);
      const Eigen::Vector3d axis = (end1 - end0).normalized();
      const double distance = (p_odom - end0).cross(axis).norm();
      // A quarter of a pixel at the rim may lie a millimetre or two beside the round surface.
      ASSERT_NEAR(distance, truth.rung_radius_m[rung], 0.004);
      ++num_points;
    }
  }
  EXPECT_GT(num_points, 1000);
}

// The truth's hits agree with a brute-force image of rung numbers by MuJoCo's rays.
TEST(Simulation, HitsAgreeWithBruteForce) {
  SimulationParams params = small();
  params.sensor.random_dropout = 0.0;
  params.sensor.edge_dropout = 1.0;
  Simulation simulation(params);
  const truth_t truth = only<truth_t>(simulation.advance_to(kStart_us + 60'000)).at(0);
  std::vector<int> expected(truth.rung_hits.size());
  const World& world = simulation.world();
  for (int head = 0; head < kNumHeads; ++head) {
    const HeadRenderer& renderer = simulation.head(head);
    const Eigen::Isometry3d pose = simulation.T_world_body(kStart_us) * renderer.T_body_head_true();
    const Eigen::Vector3d origin = pose.translation();
    for (std::size_t i = 0; i < renderer.pinhole().num_pixels(); ++i) {
      if (simulation.image(head).depth_mm[i] == 0) continue;
      const Eigen::Vector3d v = pose.linear() * renderer.ray(i).cast<double>();
      int geom = -1;
      mj_ray(&world.model(), &world.state(), origin.data(), v.data(), nullptr, 1, -1, &geom);
      if (geom >= 0 && world.rung_of_geom()[geom] >= 0) ++expected[world.rung_of_geom()[geom]];
    }
  }
  int num_seen = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(truth.rung_hits[i], expected[i], 3 + 0.02 * expected[i]) << "rung " << i;
    EXPECT_EQ(truth.rung_visible[i] > 0.0F, expected[i] > 0) << "rung " << i;
    num_seen += truth.rung_visible[i] > 0.95F ? 1 : 0;
  }
  EXPECT_GE(num_seen, 3);
}

// A negative scene says that it is no ladder, and which scene it is.
TEST(Simulation, NegativeSceneSaysSo) {
  for (const SceneKind kind : {SceneKind::kStairs, SceneKind::kPosts}) {
    const auto truths = only<truth_t>(run(small(kind), 60'000, 60'000));
    ASSERT_EQ(truths.size(), 1U);
    EXPECT_EQ(truths[0].is_ladder, 0);
    EXPECT_EQ(truths[0].num_rails, 0);
    EXPECT_EQ(truths[0].scene, std::string(to_string(kind)) + " 1");
  }
}

// Parameters out of range are refused by name.
TEST(Simulation, BadParametersAreRefused) {
  SimulationParams params = small();
  params.rate_hz = 0.0;
  EXPECT_THROW(Simulation{params}, std::invalid_argument);
  params = small();
  params.scene.distance_m = -1.0;
  EXPECT_THROW(Simulation{params}, std::invalid_argument);
}

// Above 15 Hz the heads' flashes move closer together instead of overtaking the next round.
TEST(Simulation, FastHeadsStayInOrder) {
  SimulationParams params = small();
  params.rate_hz = 45.0;
  std::int64_t last_us = 0;
  for (const tof_frame_t& frame : only<tof_frame_t>(run(params, 100'000, 100'000))) {
    EXPECT_GT(frame.utime, last_us);
    last_us = frame.utime;
  }
}

// A body that sways comes back after a period; its inertial unit feels what the path says.
TEST(Motion, SwayIsPeriodicAndFelt) {
  MotionParams motion;
  motion.sway_m = 0.03;
  motion.sway_deg = 2.0;
  EXPECT_EQ(check(motion), "");
  const Eigen::Isometry3d start(Eigen::Translation3d(0.0, 0.0, 0.55));
  EXPECT_TRUE(moved(motion, start, 0.0).isApprox(start));
  EXPECT_TRUE(moved(motion, start, 2.0).isApprox(start, 1e-9));
  EXPECT_NEAR((moved(motion, start, 0.5).translation() - start.translation()).norm(), 0.03, 1e-12);
  const BodyMotion turning_point = motion_at(motion, start, 0.5);
  EXPECT_NEAR(turning_point.acceleration_m_s2.norm(), 0.03 * 9.8696, 1e-3);
  EXPECT_NEAR(turning_point.angular_rate_rad_s.norm(), 0.0, 1e-4);
  EXPECT_NEAR(motion_at(motion, start, 1.0).angular_rate_rad_s.norm(), 0.0349 * 3.1416, 1e-3);
  motion.sway_hz = 0.0;
  EXPECT_NE(check(motion), "");
}

// A climbing body rises, and the truth says so.
TEST(Motion, TruthFollowsTheBody) {
  SimulationParams params = small();
  params.motion.climb_m_s = 0.1;
  const auto truths = only<truth_t>(run(params, 1'000'000, 50'000));
  const double rise_m = truths.back().p_odom_body_m[2] - truths.front().p_odom_body_m[2];
  const double passed_s = 1e-6 * static_cast<double>(truths.back().utime - truths.front().utime);
  EXPECT_NEAR(rise_m, 0.1 * passed_s, 1e-6);
}

// A rung that is taken away is gone from truth and images; the others keep their ids.
TEST(Removal, TakesOneRungAway) {
  SimulationParams params = small();
  params.removal = Removal{2, 0.5};
  const auto truths = only<truth_t>(run(params, 1'000'000, 50'000));
  EXPECT_EQ(truths.front().num_rungs, 8);
  ASSERT_EQ(truths.back().num_rungs, 7);
  EXPECT_GT(truths.front().rung_hits[2], 0);
  EXPECT_EQ(truths.back().rung_id[1], 1);
  EXPECT_EQ(truths.back().rung_id[2], 3);
  EXPECT_EQ(truths.back().rung_z0_m[2], truths.front().rung_z0_m[3]);
  params.removal = Removal{99, 0.5};
  EXPECT_THROW(Simulation{params}, std::invalid_argument);
}

// Heads may follow each other more slowly than by default.
TEST(Simulation, StaggerIsAParameter) {
  SimulationParams params = small();
  params.rate_hz = 10.0;
  params.stagger_hz = 40.0;
  const auto frames = only<tof_frame_t>(run(params, 99'000, 1'000));
  ASSERT_EQ(frames.size(), 4U);
  EXPECT_EQ(frames[3].utime - frames[0].utime, 75'000);
}

}  // namespace
}  // namespace simulator
