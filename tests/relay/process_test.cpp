// SPDX-License-Identifier: BSD-3-Clause
// ladder_relay as a process: what it refuses, and two of them between two LCM ports.
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "runtime/bus.h"
#include "tests/support/child_process.h"

namespace {

using support::ChildProcess;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

const std::string kRelay = std::string(LADDER_BIN_DIR) + "/ladder_relay";

std::string url(int which) {
  return "udpm://239.255.76.67:" + std::to_string(40'000 + 2 * (getpid() % 5'000) + which) +
         "?ttl=0";
}

// Wrong arguments end with 2 and name the culprit: neither end, both, no address, a channel that is
// none or would go both ways, an open address without a token.
TEST(RelayProcess, WrongArguments) {
  const auto refusal = [](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--url", url(0)});
    ChildProcess child(kRelay, arguments);
    EXPECT_EQ(child.wait(10s), 2) << child.output();
    return child.output();
  };
  refusal({});
  refusal({"--serve", "127.0.0.1:0", "--connect", "localhost:7700"});
  for (const char* address :
       {"127.0.0.1", ":7700", "127.0.0.1:", "127.0.0.1:x", "nonsense:7700", "127.0.0.1:99999"}) {
    EXPECT_THAT(refusal({"--serve", address}), HasSubstr(address));
  }
  EXPECT_THAT(refusal({"--serve", "127.0.0.1:0", "--send", "LADDER_X"}), HasSubstr("LADDER_X"));
  EXPECT_THAT(refusal({"--serve", "127.0.0.1:0", "--receive", "LADDER_RUNGS"}),
              HasSubstr("for ever"));
  EXPECT_THAT(refusal({"--serve", "0.0.0.0:0"}), HasSubstr("--token-file"));
}

// A message on one LCM is heard on the other; SIGTERM ends both ends with 0.
TEST(RelayProcess, BetweenTwoPorts) {
  const std::string port = std::to_string(20'000 + getpid() % 10'000);
  ChildProcess robot(kRelay, {"--serve", "127.0.0.1:" + port, "--url", url(0)});
  ChildProcess ground(kRelay, {"--connect", "localhost:" + port, "--url", url(1)});
  runtime::Bus at_robot(url(0));
  runtime::Bus on_ground(url(1));
  auto& heard = on_ground.newest(runtime::channels::kPose);
  ladder_msgs::pose_t pose{};
  pose.q_odom_body[0] = 1.0;
  for (int i = 1; i < 200 && !heard.fresh(); ++i) {
    pose.utime = pose.seq = i;
    at_robot.publish(runtime::channels::kPose, pose);
    std::this_thread::sleep_for(50ms);
    on_ground.drain();
  }
  EXPECT_TRUE(heard.fresh()) << robot.output() << ground.output();
  for (ChildProcess* child : {&robot, &ground}) {
    child->signal(SIGTERM);
    EXPECT_EQ(child->wait(5s), 0) << child->output();
  }
}

}  // namespace
