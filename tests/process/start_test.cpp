// SPDX-License-Identifier: BSD-3-Clause
// How each service starts and ends: exit codes, messages that name the fix, readiness, signals.
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/support/child_process.h"

namespace {

using support::ChildProcess;
using ::testing::HasSubstr;
using namespace std::chrono_literals;

const std::string kBin = LADDER_BIN_DIR;
const std::string kConfig = std::string(LADDER_CONFIG_DIR) + "/robot.toml";

class EachService : public ::testing::TestWithParam<const char*> {
 protected:
  std::string program() const { return kBin + "/" + GetParam(); }
  /// "sensor" for sensor_service
  std::string table() const {
    return std::string(GetParam()).substr(0, std::string(GetParam()).find('_'));
  }
  std::string url() const {
    return "udpm://239.255.76.67:" + std::to_string(20'000 + getpid() % 10'000) + "?ttl=0";
  }
};

// --help explains and ends with 0; an unknown argument is a configuration error, 2.
TEST_P(EachService, Arguments) {
  ChildProcess help(program(), {"--help"});
  EXPECT_EQ(help.wait(10s), 0);
  EXPECT_THAT(help.output(), HasSubstr("--config"));
  ChildProcess unknown(program(), {"--no-such-thing"});
  EXPECT_EQ(unknown.wait(10s), 2);
}

// --check prints the resolved configuration without touching the network; the shipped file is
// accepted.
TEST_P(EachService, CheckAcceptsTheShippedConfiguration) {
  ChildProcess child(program(), {"--check", "--config", kConfig});
  EXPECT_EQ(child.wait(10s), 0);
  EXPECT_THAT(child.output(), HasSubstr(table() + "."));
}

// The shipped file says what the code would do anyway: every key of the service stands in it with
// its default.
TEST_P(EachService, ShippedConfigurationEqualsTheDefaults) {
  ChildProcess with_file(program(), {"--check", "--config", kConfig});
  ChildProcess without(program(), {"--check"});
  ASSERT_EQ(with_file.wait(10s), 0);
  ASSERT_EQ(without.wait(10s), 0);
  EXPECT_EQ(with_file.output(), without.output());
}

// A missing file, an unknown key, a wrong type and a value out of range end with 2 and name the
// culprit.
TEST_P(EachService, WrongConfiguration) {
  ChildProcess missing(program(), {"--config", "/no/such.toml"});
  EXPECT_EQ(missing.wait(10s), 2);
  EXPECT_THAT(missing.output(), HasSubstr("/no/such.toml"));
  ChildProcess unknown(program(), {"--set", table() + ".no_such_key=1"});
  EXPECT_EQ(unknown.wait(10s), 2);
  EXPECT_THAT(unknown.output(), HasSubstr(table() + ".no_such_key"));
}

// Without a route for multicast the service ends with 3 and prints the command that adds one.
TEST_P(EachService, MissingRouteNamesTheFix) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root for a network namespace";
  ChildProcess child("unshare", {"-n", program(), "--url", url()});
  EXPECT_EQ(child.wait(15s), 3);
  EXPECT_THAT(child.output(), HasSubstr("ip route replace 239.255.76.67/32 dev lo src 127.0.0.1"));
}

// Where LCM can send but what it sends never comes back, the service ends with 3 and names what may
// drop it. Here datagrams leave by another interface than the one at which the group was joined
// (17 is UDP: without netbase it has no name).
TEST(LcmThatIsDeaf, IsNamed) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root for a network namespace";
  const std::string network =
      "ip link set lo up && ip link add eth1 type veth peer name far && "
      "ip link set eth1 up && ip link set far up && "
      "ip route add 239.255.76.67/32 dev lo src 127.0.0.1 && "
      "ip route add 239.255.76.67/32 dev eth1 table 100 && "
      "ip rule add ipproto 17 dport 7667 lookup 100 && ";
  ChildProcess child("unshare", {"-n", "sh", "-c",
                                 network + "exec " + kBin +
                                     "/gng_service --url 'udpm://239.255.76.67:7667?ttl=0'"});
  EXPECT_EQ(child.wait(40s), 3) << child.output();  // LCM itself waits for 10 s
  EXPECT_THAT(child.output(), HasSubstr("ladder-doctor --only route"));
}

// A socket buffer that would lose clouds is said at the start with the exact fix; the service runs
// on.
TEST_P(EachService, SmallSocketBufferIsSaid) {
  ChildProcess child(program(), {"--url", url() + "&recv_buf_size=100000"});
  std::this_thread::sleep_for(500ms);
  EXPECT_TRUE(child.running());
  EXPECT_THAT(child.output(), HasSubstr("sysctl -w net.core.rmem_max"));
}

// SIGTERM and SIGINT end it within a second with 0, also when nothing was ever received.
TEST_P(EachService, StopsAsAsked) {
  for (const int number : {SIGTERM, SIGINT}) {
    ChildProcess child(program(), {"--url", url()});
    std::this_thread::sleep_for(300ms);
    ASSERT_TRUE(child.running()) << child.output();
    child.signal(number);
    EXPECT_EQ(child.wait(1s), 0) << child.output();
  }
}

// systemd is told READY=1 and then WATCHDOG=1 from the work loop.
TEST_P(EachService, TellsSystemd) {
  const std::string path = "/tmp/ladder-notify-" + std::to_string(getpid());
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  ASSERT_EQ(bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  timeval timeout{.tv_sec = 5, .tv_usec = 0};
  setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
  {
    ChildProcess child(program(), {"--url", url()}, {"NOTIFY_SOCKET=" + path});
    std::string told;
    for (int i = 0; i < 5; ++i) {
      char text[256] = {};
      if (recv(socket, text, sizeof(text) - 1, 0) > 0) told += std::string(text) + "\n";
    }
    EXPECT_TRUE(told.starts_with("READY=1")) << told;
    EXPECT_THAT(told, HasSubstr("WATCHDOG=1"));
  }
  close(socket);
  unlink(path.c_str());
}

INSTANTIATE_TEST_SUITE_P(Services, EachService,
                         ::testing::Values("sensor_service", "gng_service", "ladder_service"));

}  // namespace
