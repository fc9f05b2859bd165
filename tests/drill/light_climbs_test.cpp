// SPDX-License-Identifier: BSD-3-Clause
// Light climbs: the seed says everything, a plain ladder is climbed to its top, damage is no fall,
// and a climb can be written down.
#include "robot_in_a_box/light_climbs.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include <gtest/gtest.h>
#include <lcm/lcm-cpp.hpp>

#include "robot_in_a_box/climb_log.h"

namespace robot_in_a_box {
namespace {

// The same seed gives the same frames, alone or among others; another one does not.
TEST(LightClimbs, SeedSaysEverything) {
  LightClimbParams brief;
  brief.limit_us = 20'000'000;
  const auto together = run_light_climbs(1, 3, 2, brief);
  const auto alone = run_light_climbs(2, 1, 1, brief);
  ASSERT_EQ(together.size(), 3U);
  EXPECT_EQ(together[1].frame_hash, alone[0].frame_hash);
  EXPECT_EQ(together[1].num_targets, alone[0].num_targets);
  EXPECT_NE(together[0].frame_hash, together[1].frame_hash);
  for (const LightScore& score : together) EXPECT_GT(score.num_targets, 0);
}

bool is_sound(const simulator::LadderRung& rung) {
  const bool is_whole = (rung.end1_m - rung.end0_m).norm() > 0.35;
  return is_whole && !rung.broken && !rung.break_on_touch && std::isinf(rung.break_load_N);
}

// Without troubles, ladders that nothing is wrong with are climbed to the top, others are not
// fallen off, and no invariant is broken.
TEST(LightClimbs, ClimbsWhatCanBeClimbed) {
  LightClimbParams params;
  params.has_troubles = false;
  params.num_rungs_to_climb = 1;
  int num_sound = 0;
  for (const LightScore& score : run_light_climbs(1, 16, 2, params)) {
    EXPECT_NE(score.end, LightEnd::kFallen) << score.seed;
    EXPECT_EQ(score.num_violations, 0) << score.seed << " " << score.first_violation;
    params.seed = score.seed;
    const auto rungs = light_box_params(params).plant.rungs;
    if (!std::all_of(rungs.begin(), rungs.end(), is_sound)) continue;
    ++num_sound;
    EXPECT_EQ(score.end, LightEnd::kTop) << score.seed << " " << score.reason;
  }
  EXPECT_GE(num_sound, 3);
}

// Ten rungs of a plain ladder in one go, each at its first try.
TEST(LightClimbs, TenRungsOfAPlainLadder) {
  ClimbBoxParams params;
  params.perception.bias_m = params.perception.jitter_m = 0.0;
  params.plant.rungs = simulator::straight_ladder({.num_rungs = 13});
  ClimbBox box(params);
  LightClimbParams climb;
  climb.has_troubles = false;
  climb.limit_us = 500'000'000;
  int num_vain = 0;
  const auto watch = [&] {
    for (const climb::LimbState limb : box.report().output.limbs) {
      num_vain += limb >= climb::LimbState::kRegrasp ? 1 : 0;
    }
  };
  const LightResult result = run_light_climb(climb, box, watch);
  EXPECT_EQ(result.end, LightEnd::kTop) << result.reason;
  EXPECT_EQ(result.rungs_climbed, 10);
  EXPECT_EQ(num_vain, 0);
}

// A climb as a log: rungs, poses and states at their rates, in order of time.
TEST(LightClimbs, IsWrittenAsALog) {
  const std::string path = testing::TempDir() + "/light_climb.lcm";
  LightClimbParams params;
  params.limit_us = 5'000'000;
  ClimbBox box(light_box_params(params));
  {
    ClimbLog log(path);
    run_light_climb(params, box, [&] { log.write(box); });
    EXPECT_TRUE(log.good());
  }
  lcm::LogFile file(path, "r");
  ASSERT_TRUE(file.good());
  std::map<std::string, int> events;
  std::int64_t last_us = 0;
  while (const lcm::LogEvent* event = file.readNextEvent()) {
    ++events[event->channel];
    EXPECT_GE(event->timestamp, last_us);
    last_us = event->timestamp;
  }
  EXPECT_EQ(events["LADDER_POSE"], 250);
  EXPECT_EQ(events["LADDER_CLIMB"], 50);
  EXPECT_NEAR(events["LADDER_RUNGS"], 75, 3);
  std::remove(path.c_str());
  ClimbLog nowhere("/no/such/folder/climb.lcm");
  EXPECT_FALSE(nowhere.good());
}

}  // namespace
}  // namespace robot_in_a_box
