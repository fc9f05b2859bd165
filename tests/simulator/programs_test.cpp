// SPDX-License-Identifier: BSD-3-Clause
// The two programs as a user meets them: exit codes, logs that repeat, SIGTERM.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temporary_folder.h"

namespace {

int run(const std::string& command) {
  const int status = std::system((command + " >/dev/null 2>&1").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

const std::string kSimulator = LADDER_SIMULATOR;
const std::string kScore = LADDER_SCORE;

class Programs : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_ / name; }

  support::TemporaryFolder folder_;
};

// Wrong arguments are 2, help is 0, a bus or file that is not there is 3 (reader: 2).
TEST_F(Programs, ExitCodes) {
  EXPECT_EQ(run(kSimulator + " --help"), 0);
  EXPECT_EQ(run(kSimulator + " --scene nowhere"), 2);
  EXPECT_EQ(run(kSimulator + " --no_such_option"), 2);
  EXPECT_EQ(run(kSimulator + " --seed -1x"), 2);
  EXPECT_EQ(run(kSimulator + " --distance_m nan --frames 1 --log " + path("a")), 2);
  EXPECT_EQ(run(kSimulator + " --dead_heads 4 --frames 1 --log " + path("a")), 2);
  EXPECT_EQ(run(kSimulator + " --log " + path("a")), 2) << "endless log";
  EXPECT_EQ(run(kSimulator + " --frames 1 --log " + path("no/such/folder/a")), 3);
  EXPECT_EQ(run(kSimulator + " --url nonsense://"), 3);
  EXPECT_EQ(run(kScore), 2);
  EXPECT_EQ(run(kScore + " --log " + path("missing")), 2);
  EXPECT_EQ(run(kScore + " --live --seconds 0.1 --url nonsense://"), 3);
}

// The same arguments write the same log; another seed another one; a log without rungs has nothing
// to score.
TEST_F(Programs, LogsRepeat) {
  ASSERT_EQ(run(kSimulator + " --scene bent --frames 3 --log " + path("a.lcm")), 0);
  ASSERT_EQ(run(kSimulator + " --scene bent --frames 3 --log " + path("b.lcm")), 0);
  ASSERT_EQ(run(kSimulator + " --scene bent --seed 2 --frames 3 --log " + path("c.lcm")), 0);
  EXPECT_EQ(content(path("a.lcm")), content(path("b.lcm")));
  EXPECT_NE(content(path("a.lcm")), content(path("c.lcm")));
  EXPECT_GT(content(path("a.lcm")).size(), 3U * 4U * 114'000U);
  EXPECT_EQ(run(kScore + " --log " + path("a.lcm") + " --json " + path("a.json")), 1);
  EXPECT_NE(content(path("a.json")).find("\"LADDER_TRUTH\": 3"), std::string::npos);
}

// A damaged log is read as far as it goes.
TEST_F(Programs, DamagedLog) {
  ASSERT_EQ(run(kSimulator + " --frames 2 --log " + path("a.lcm")), 0);
  std::string bytes = content(path("a.lcm"));
  bytes.resize(bytes.size() / 2);
  for (std::size_t i = 1000; i < bytes.size(); i += 997) bytes[i] = '\xff';
  std::ofstream(path("b.lcm"), std::ios::binary) << bytes;
  EXPECT_EQ(run(kScore + " --log " + path("b.lcm")), 1);
}

// SIGTERM ends the live simulator with 0.
TEST_F(Programs, StopsWhenAsked) {
  const pid_t pid = fork();
  if (pid == 0) {
    execl(kSimulator.c_str(), "ladder_simulator", "--url", "memq://", nullptr);
    _exit(127);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ASSERT_EQ(kill(pid, SIGTERM), 0);
  int status = 0;
  ASSERT_EQ(waitpid(pid, &status, 0), pid);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
