// SPDX-License-Identifier: BSD-3-Clause
// ladder_latency counts what it plays and hears; its times are for scripts/bench, not for a test.
#include <chrono>
#include <map>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/support/child_process.h"

namespace {

using support::ChildProcess;
using namespace std::chrono_literals;

std::string own_url() {
  static int next_port = 31'000 + getpid() % 10'000 * 2;
  return "udpm://239.255.76.67:" + std::to_string(next_port++) + "?ttl=0&recv_buf_size=4194304";
}

/// The figures that it prints: name and value on each line.
std::map<std::string, double> figures(const std::string& output) {
  std::map<std::string, double> figures;
  std::istringstream lines(output);
  std::string name;
  for (double value = 0.0; lines >> name >> value;) figures[name] = value;
  return figures;
}

// With the real services every answer belongs to a frame that was heard, and no more come than
// rounds of heads were sent.
TEST(Latency, MatchesAnswersToFrames) {
  const std::string url = own_url();
  const ChildProcess sensor(LADDER_BIN_DIR "/sensor_service", {"--url", url});
  const ChildProcess gng(LADDER_BIN_DIR "/gng_service", {"--url", url});
  const ChildProcess ladder(LADDER_BIN_DIR "/ladder_service", {"--url", url});
  ChildProcess latency(LADDER_LATENCY, {"--url", url, "--seconds", "8", "--rate_hz", "5"});
  ASSERT_EQ(latency.wait(60s), 0) << latency.output();
  auto of = figures(latency.output());
  EXPECT_GT(of["rungs"], 0);
  EXPECT_LE(of["rungs"], of["frames_sent"] / 4 + 1);
  EXPECT_LE(of["rungs"], of["topologies"] + of["lost_here"]);
  EXPECT_GE(of["rungs_matched"] + of["lost_here"], of["rungs"]);
  EXPECT_EQ(of["services_heard"], 3);
}

// A consumer slower than its input takes the newest frame each time: whatever it received was
// worked on or overwritten.
TEST(Latency, SlowConsumerDropsWhatIsOld) {
  ChildProcess latency(LADDER_LATENCY, {"--url", own_url(), "--seconds", "2", "--rate_hz", "45",
                                        "--slow_work_ms", "50"});
  ASSERT_EQ(latency.wait(60s), 0) << latency.output();
  auto of = figures(latency.output());
  EXPECT_GT(of["worked_on"], 0);
  EXPECT_GT(of["overwritten"], 0);
  EXPECT_EQ(of["worked_on"] + of["overwritten"], of["received"]);
  EXPECT_LE(of["received"] + of["lost_here"], of["frames_sent"]);
}

// Nobody answers: exit code 1 and no latency is made up.
TEST(Latency, SaysWhenNothingCame) {
  ChildProcess latency(LADDER_LATENCY, {"--url", own_url(), "--seconds", "0.5"});
  EXPECT_EQ(latency.wait(60s), 1);
  EXPECT_EQ(figures(latency.output())["rungs"], 0);
}

}  // namespace
