// SPDX-License-Identifier: BSD-3-Clause
// How well the filter of own limbs does while the robot in physics climbs: of the pixels that hit
// the robot itself how many become points, and how many of the ladder's are lost to it. Pixels as
// sensor_service gets them (noise, mounting errors, angles as the drives tell them), truth from the
// geom that each pixel hit.
#include <cstdio>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "climb_controller/convert.h"
#include "robot_in_a_box/physical_climb.h"
#include "sensor_service/convert.h"
#include "simulator/head_renderer.h"
#include "simulator/mjcf.h"
#include "simulator/sensor_messages.h"
#include "tof/self_filter.h"

namespace robot_in_a_box {
namespace {

enum class Thing { kOther, kOwn, kLadder };

std::vector<Thing> things_of(const simulator::PhysicsModel& model, const simulator::Scene& scene) {
  const mjModel& m = model.model();
  std::vector<Thing> things(static_cast<std::size_t>(m.ngeom), Thing::kOther);
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const std::string body = mj_id2name(&m, mjOBJ_BODY, m.geom_bodyid[geom]);
    for (const char* part : {"torso", "abduction", "thigh", "shank", "claw", "jaw"}) {
      if (body.starts_with(part)) things[static_cast<std::size_t>(geom)] = Thing::kOwn;
    }
  }
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    if (scene.solids[i].part == simulator::Part::kOther) continue;
    const int geom = mj_name2id(&m, mjOBJ_GEOM, simulator::solid_name(i).c_str());
    things.at(static_cast<std::size_t>(geom)) = Thing::kLadder;
  }
  return things;
}

struct Counts {
  int images = 0, pixels = 0;
  int own = 0, own_through = 0;     ///< returned; of these, kept by all filters
  int ladder = 0, ladder_lost = 0;  ///< kept by the filters before; of these, taken for a limb
};

/// Looks through all four heads and counts.
class LimbWitness {
 public:
  explicit LimbWitness(PhysicalClimb& climb)
      : climb_(climb), things_(things_of(climb.model(), climb.scene())), filter_(params_.filter) {
    for (int head = 0; head < simulator::kNumHeads; ++head) {
      heads_.emplace_back(sensor_, simulator::heads_climb()[static_cast<std::size_t>(head)], head,
                          7);
    }
  }

  void look() {
    climb_controller::to_message(climb_.box().report(), state_);
    const auto angles_rad = sensor_service::to_joints(state_);
    if (!angles_rad) return;
    const tof::Limbs limbs = tof::limbs_of(params_.limbs, *angles_rad);
    for (std::size_t head = 0; head < heads_.size(); ++head) look_through(head, limbs);
    ++frame_;
  }

  const Counts& counts() const { return counts_; }

 private:
  void look_through(std::size_t head, const tof::Limbs& limbs) {
    heads_[head].render(climb_.model().model(), climb_.model().state(),
                        climb_.box().plant().T_world_body(), frame_, image_);
    ladder_msgs::tof_frame_t message = frame_message(heads_[head], sensor_, image_);
    message.utime = 1 + climb_.box().now_us();
    message.head = static_cast<std::int8_t>(head);
    const tof::DepthFrame frame = sensor_service::to_depth_frame(message);
    rays_[head].fit(frame);
    filter_.apply(frame, filtered_);
    const std::vector<std::int16_t> before = filtered_.depth_mm;
    drop_limbs(frame, rays_[head], limbs, filtered_);
    ++counts_.images;
    for (std::size_t i = 0; i < before.size(); ++i) {
      ++counts_.pixels;
      const int geom = image_.clean_geom[i];
      if (geom < 0) continue;
      const Thing thing = things_[static_cast<std::size_t>(geom)];
      const bool is_kept = filtered_.depth_mm[i] != 0;
      if (thing == Thing::kOwn) {
        ++counts_.own;
        counts_.own_through += is_kept ? 1 : 0;
      } else if (thing == Thing::kLadder && before[i] != 0) {
        ++counts_.ladder;
        counts_.ladder_lost += is_kept ? 0 : 1;
      }
    }
  }

  PhysicalClimb& climb_;
  std::vector<Thing> things_;
  tof::TofParams params_;
  simulator::SensorParams sensor_;
  tof::Filter filter_;
  std::vector<simulator::HeadRenderer> heads_;
  std::array<tof::RayTable, simulator::kNumHeads> rays_;
  simulator::HeadImage image_;
  tof::FilteredImage filtered_;
  ladder_msgs::climb_state_t state_{};
  std::uint64_t frame_ = 0;
  Counts counts_;
};

/// While it climbs, limb after limb: less than a hundredth of its own pixels become points, less
/// than a twentieth of the ladder's is taken for a limb (what claws hold is within their margin).
TEST(OwnLimbs, AreDroppedAndTheLadderIsKept) {
  PhysicalClimbParams params;
  params.scene.num_rungs = 5;
  params.scene.seed = params.seed = 2;
  PhysicalClimb climb(params);
  ASSERT_TRUE(climb.hang()) << climb.reason();
  LimbWitness witness(climb);
  climb.each_second([&witness] { witness.look(); });
  ASSERT_EQ(climb.climb(true, 25.0), ClimbEnd::kTooLong) << climb.reason();
  const Counts& n = witness.counts();
  const auto share = [](int part, int whole) { return static_cast<double>(part) / whole; };
  ASSERT_GT(n.own, 10'000);
  ASSERT_GT(n.ladder, 10'000);
  std::printf(
      "%d images: %.1f %% of the pixels hit the robot itself, %.2f %% of these get through; %.2f "
      "%% "
      "of the ladder's pixels are lost\n",
      n.images, 100.0 * share(n.own, n.pixels), 100.0 * share(n.own_through, n.own),
      100.0 * share(n.ladder_lost, n.ladder));
  EXPECT_LT(share(n.own_through, n.own), 0.01);
  EXPECT_LT(share(n.ladder_lost, n.ladder), 0.05);
}

}  // namespace
}  // namespace robot_in_a_box
