// SPDX-License-Identifier: BSD-3-Clause
// The program ladder_plant itself: it serves its sockets, obeys a tester's hand, and ends cleanly.
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <linux/can.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/temporary_folder.h"

namespace {

using namespace std::chrono_literals;

pid_t start(const std::vector<std::string>& arguments) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  std::vector<char*> words = {const_cast<char*>(LADDER_PLANT_PROGRAM)};
  for (const std::string& argument : arguments)
    words.push_back(const_cast<char*>(argument.c_str()));
  words.push_back(nullptr);
  ::execv(words[0], words.data());
  ::_exit(127);
}

int exit_code(pid_t child) {
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
}

int connect_to(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), address.sun_path);
  for (int i = 0; i < 500; ++i) {
    const int client = ::socket(AF_UNIX, SOCK_SEQPACKET, 0);
    if (::connect(client, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0)
      return client;
    ::close(client);
    std::this_thread::sleep_for(10ms);
  }
  return -1;
}

/// The next packet within ten seconds; 0 = none or closed.
template <class T>
std::size_t next_packet(int client, T& packet) {
  pollfd waiting{client, POLLIN, 0};
  if (::poll(&waiting, 1, 10'000) != 1) return 0;
  const ssize_t size = ::recv(client, &packet, sizeof packet, 0);
  return size > 0 ? static_cast<std::size_t>(size) : 0;
}

// Wrong arguments and doors that cannot be opened end at once with the documented codes.
TEST(PlantProgram, RefusesBadArguments) {
  EXPECT_EQ(exit_code(start({"--nonsense"})), 2);
  EXPECT_EQ(exit_code(start({"--can", "unix:/tmp/x_plant", "--fault", "1 no_such_fault"})), 2);
  EXPECT_EQ(exit_code(start({"--can", "nocan77"})), 3);
  EXPECT_EQ(exit_code(start({"--can", "unix:/no/such/folder/can"})), 3);
}

// A controller's door: a drive answers over the socket, the E-stop wire is cut by a tester's record
// and read back low; SIGTERM ends with 0 and removes both socket files.
TEST(PlantProgram, ServesAndEnds) {
  const support::TemporaryFolder folder;
  const pid_t plant = start({"--can", "unix:" + folder / "can", "--lines",
                             "unix:" + folder / "lines", "--print_period_s", "0"});
  const int can = connect_to(folder / "can");
  const int lines = connect_to(folder / "lines");
  ASSERT_GE(can, 0);
  ASSERT_GE(lines, 0);

  ::can_frame request{};
  request.can_id = 0x605;
  request.can_dlc = 8;
  request.data[0] = 0x40;
  request.data[2] = 0x10;  // 1000h
  bool answered = false;
  for (int i = 0; i < 100 && !answered; ++i) {
    ASSERT_EQ(::send(can, &request, sizeof request, 0), static_cast<ssize_t>(sizeof request));
    ::can_frame answer{};
    pollfd waiting{can, POLLIN, 0};
    while (!answered && ::poll(&waiting, 1, 50) == 1 && next_packet(can, answer) > 0) {
      answered = answer.can_id == 0x585 && answer.data[4] == 0x92;
    }
  }
  EXPECT_TRUE(answered);

  const unsigned char cut[2] = {4, 0};
  ASSERT_EQ(::send(lines, cut, sizeof cut, 0), 2);
  std::vector<int> estop_levels;
  unsigned char record[2] = {};
  while (next_packet(lines, record) == 2) {
    if (record[0] == 4) estop_levels.push_back(record[1]);
    if (estop_levels.size() >= 2 && estop_levels.back() == 0) break;
  }
  EXPECT_EQ(estop_levels.back(), 0);

  ASSERT_EQ(::kill(plant, SIGTERM), 0);
  EXPECT_EQ(exit_code(plant), 0);
  EXPECT_NE(::access((folder / "can").c_str(), F_OK), 0);
  EXPECT_NE(::access((folder / "lines").c_str(), F_OK), 0);
  ::close(can);
  ::close(lines);
}

}  // namespace
