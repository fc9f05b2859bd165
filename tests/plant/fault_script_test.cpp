// SPDX-License-Identifier: BSD-3-Clause
// Fault scripts: bad text first, then what each fault does to the plant, and random ones.
#include "simulator/plant/fault_script.h"

#include <gtest/gtest.h>

#include "robot_bench.h"

namespace simulator {
namespace {

// Bad lines are refused with their number; nothing is guessed.
TEST(FaultScript, RefusesBadText) {
  EXPECT_TRUE(parse_faults("").faults.empty());
  EXPECT_EQ(parse_faults("# nothing\n\n   \n").problem, "");
  for (const char* bad : {"stuck 3", "1.0", "-1 stuck 3", "nan stuck 3", "1 stuk 3", "1 stuck 16",
                          "1 stuck -1", "1 slow 3 fast", "1 touch_stuck_low 4", "1 stuck x",
                          "1 slow 3 0.5 0.1 more", "1 slow 3 0.5 long"}) {
    const ParsedFaults parsed = parse_faults(std::string("# first\n") + bad);
    EXPECT_EQ(parsed.problem.rfind("line 2: ", 0), 0U) << bad;
  }
}

// Every kind can be written and read back; lines come out in order of time.
TEST(FaultScript, ReadsWhatItWrites) {
  std::string text;
  for (int kind = kNumFaultKinds - 1; kind >= 0; --kind) {
    Fault fault;
    fault.kind = static_cast<FaultKind>(kind);
    fault.time_us = 1000 * kind;
    fault.value = 0.1 + kind;
    fault.duration_us = 5000;
    text += to_text(fault) + "\n";
  }
  const ParsedFaults parsed = parse_faults(text);
  ASSERT_EQ(parsed.problem, "");
  ASSERT_EQ(parsed.faults.size(), static_cast<std::size_t>(kNumFaultKinds));
  for (int kind = 0; kind < kNumFaultKinds; ++kind) {
    const Fault& fault = parsed.faults[static_cast<std::size_t>(kind)];
    EXPECT_EQ(fault.kind, static_cast<FaultKind>(kind));
    EXPECT_EQ(fault.time_us, 1000 * kind);
    EXPECT_EQ(fault.value, 0.1 + kind);
    EXPECT_EQ(fault.duration_us, 5000);
  }
  EXPECT_EQ(parse_faults("1 emergency 3 0x2310").faults.at(0).value, 0x2310);
}

/// Runs a script over four held claws for half a second.
struct ScriptRun {
  explicit ScriptRun(const std::string& text) : bench(gripping_params()) {
    FaultPlayer player(parse_faults(text).faults, bench.bus);
    close_all(bench);
    bench.heard.clear();
    begin_us = bench.now_us;
    for (int i = 0; i < 50; ++i) {
      player.apply(bench.now_us, bench.plant, bench.bus);
      bench.cycle();
    }
    num_begun = player.num_begun();
  }
  RobotBench bench;
  std::int64_t begin_us = 0;
  int num_begun = 0;
};

// A silent axis sends nothing and is back afterwards; its own watchdog stopped it meanwhile.
TEST(FaultScript, SilenceEnds) {
  ScriptRun run("0.4 silent 5 0 0.2");
  EXPECT_EQ(run.num_begun, 1);
  EXPECT_LT(run.bench.num_frames(0x186), 35);
  EXPECT_GT(run.bench.num_frames(0x186), 25);
  EXPECT_EQ(run.bench.num_frames(0x187), 50);
  EXPECT_GE(run.bench.num_frames(0x086), 1);  // 8130h, reported when it speaks again
}

// Emergency, reboot, lost heartbeat, wrong length and lost frames look on the bus as they should.
TEST(FaultScript, FaultsOnTheBus) {
  ScriptRun run(
      "0.4 emergency 0 0x2310\n0.4 reboot 1\n0.4 no_heartbeat 2\n0.4 wrong_length 3\n"
      "0.4 frame_loss 4 1.0\n0.4 under_voltage 5\n0.4 pre_operational 6\n0.4 no_state 7\n");
  const auto& bench = run.bench;
  EXPECT_EQ(bench.plant.drive(0).power_state(), PowerState::kFault);
  EXPECT_EQ(bench.num_frames(0x081), 1);
  EXPECT_GE(bench.num_frames(0x702), 1);
  EXPECT_LE(bench.num_frames(0x703), 1);
  EXPECT_EQ(bench.num_frames(0x183), 50);
  const bool short_one = std::any_of(bench.heard.begin(), bench.heard.end(), [](const auto& frame) {
    return frame.id == 0x184 && frame.length == 7;
  });
  EXPECT_TRUE(short_one);
  EXPECT_LE(bench.num_frames(0x185), 5);
  EXPECT_EQ(bench.num_frames(0x086), 1);
  EXPECT_EQ(bench.plant.drive(5).power_state(), PowerState::kOperationEnabled);
  EXPECT_EQ(bench.plant.drive(6).power_state(), PowerState::kQuickStopActive);
  EXPECT_LE(bench.num_frames(0x188), 5);
}

// Lines, rungs and the dock obey as well.
TEST(FaultScript, FaultsOfTheWorld) {
  ScriptRun run("0.4 touch_stuck_high 1\n0.4 touch_stuck_low 0\n0.4 estop\n0.4 rung_breaks 0\n");
  const PlantTruth truth = run.bench.plant.truth();
  EXPECT_EQ(truth.lines, (LineLevels{false, true, false, false, false}));
  EXPECT_EQ(truth.num_broken_rungs, 1);
  EXPECT_EQ(truth.legs[2].last_loss, LossCause::kRungBroke);
}

// Junk and foreign frames reach the master's port and disturb no drive.
TEST(FaultScript, JunkDisturbsNoDrive) {
  ScriptRun run("0.4 junk_frames 0 100\n0.41 foreign_sync");
  EXPECT_GE(run.bench.num_frames(kExtendedFlag | 0x181), 20);
  for (int axis = 0; axis < kNumAxes; ++axis) {
    EXPECT_EQ(run.bench.plant.drive(axis).power_state(), PowerState::kOperationEnabled);
  }
}

// Two hundred seeds of random faults under a master that does not care: every number stays finite,
// and the same seed gives the same faults.
TEST(FaultScript, RandomFaultsLeaveThePlantSane) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomFaultParams random;
    random.num_faults = 6;
    random.from_us = 300'000;
    random.until_us = 800'000;
    const auto faults = random_faults(seed, random);
    RobotBench bench(gripping_params(), seed);
    FaultPlayer player(faults, bench.bus);
    close_all(bench);
    for (int i = 0; i < 60; ++i) {
      for (int axis = 0; axis < kNumAxes; ++axis) {
        bench.goal_rad[static_cast<std::size_t>(axis)] += 0.01;
      }
      player.apply(bench.now_us, bench.plant, bench.bus);
      bench.cycle();
    }
    const PlantTruth truth = bench.plant.truth();
    ASSERT_TRUE(truth.T_world_body.matrix().allFinite()) << seed;
    for (const double angle : truth.joint_rad) ASSERT_LT(std::fabs(angle), 4.0) << seed;
    const auto again = random_faults(seed, random);
    ASSERT_TRUE(
        std::equal(faults.begin(), faults.end(), again.begin(), again.end(),
                   [](const Fault& a, const Fault& b) { return to_text(a) == to_text(b); }));
  }
}

// A fault that comes while the player runs begins at once when it is past, else in its turn.
TEST(FaultScript, OneMoreWhileItRuns) {
  RobotBench bench(gripping_params());
  FaultPlayer player(parse_faults("1000 stuck 0").faults, bench.bus);
  player.add(parse_faults("500 estop").faults.at(0));
  player.apply(bench.now_us, bench.plant, bench.bus);
  EXPECT_EQ(player.num_begun(), 0);
  player.add(parse_faults("0 estop 0 0 0.05").faults.at(0));
  bench.cycle();
  player.apply(bench.now_us, bench.plant, bench.bus);
  EXPECT_EQ(player.num_begun(), 1);
  EXPECT_FALSE(bench.plant.truth().lines[kEstopN]);
  player.apply(60'000, bench.plant, bench.bus);
  EXPECT_TRUE(bench.plant.truth().lines[kEstopN]) << "it was for 50 ms";
  EXPECT_EQ(player.num_begun(), 1);
}

}  // namespace
}  // namespace simulator
