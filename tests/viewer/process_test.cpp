// SPDX-License-Identifier: BSD-3-Clause
// ladder_viewer as a process: how it starts and ends, and that nothing of it reaches LCM.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "runtime/bus.h"
#include "tests/support/child_process.h"
#include "tests/viewer/raw_client.h"

namespace {

using support::ChildProcess;
using ::testing::HasSubstr;
using viewer_test::client_frame;
using viewer_test::RawClient;
using namespace std::chrono_literals;

const std::string kViewer = std::string(LADDER_BIN_DIR) + "/ladder_viewer";

class ViewerProcess : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(page_);
    std::ofstream(page_ + "/index.html") << "<title>Ladder</title>";
  }
  void TearDown() override { std::filesystem::remove_all(page_); }

  /// Where it says it is.
  static std::uint16_t port_of(const ChildProcess& child) {
    for (int i = 0; i < 100; ++i) {
      const std::string said = child.output();
      const std::size_t at = said.find("http://127.0.0.1:");
      if (at != std::string::npos && said.find('\n', at) != std::string::npos) {
        return static_cast<std::uint16_t>(std::stoi(said.substr(at + 17)));
      }
      std::this_thread::sleep_for(50ms);
    }
    return 0;
  }

  const std::string page_ = "/tmp/ladder-viewer-page-" + std::to_string(getpid());
  const std::string url_ =
      "udpm://239.255.76.67:" + std::to_string(30'000 + getpid() % 10'000) + "?ttl=0";
};

// Wrong arguments end with 2 and name the fix: no page, no log, an open address without a token.
TEST_F(ViewerProcess, WrongArguments) {
  const auto refusal = [&](const std::vector<std::string>& arguments) {
    ChildProcess child(kViewer, arguments);
    EXPECT_EQ(child.wait(10s), 2);
    return child.output();
  };
  EXPECT_THAT(refusal({"--page", "/no/such", "--url", url_}), HasSubstr("viewer/web/build"));
  EXPECT_THAT(refusal({"--page", page_, "--log", "/no/such.lcm"}), HasSubstr("/no/such.lcm"));
  EXPECT_THAT(refusal({"--page", page_, "--address", "0.0.0.0"}), HasSubstr("--token-file"));
  EXPECT_THAT(refusal({"--page", page_, "--address", "nonsense"}), HasSubstr("nonsense"));
  refusal({"--no-such-option"});
}

// A port that is taken ends with 3.
TEST_F(ViewerProcess, TakenPort) {
  ChildProcess first(kViewer, {"--page", page_, "--url", url_, "--port", "0"});
  const std::uint16_t port = port_of(first);
  ASSERT_NE(port, 0);
  ChildProcess second(kViewer, {"--page", page_, "--url", url_, "--port", std::to_string(port)});
  EXPECT_EQ(second.wait(10s), 3);
  EXPECT_THAT(second.output(), HasSubstr(std::to_string(port)));
}

// What is on LCM is shown; whatever a client sends, nothing of it is on LCM; SIGTERM ends with 0.
TEST_F(ViewerProcess, OnlyListens) {
  ChildProcess child(kViewer, {"--page", page_, "--url", url_, "--port", "0"});
  const std::uint16_t port = port_of(child);
  ASSERT_NE(port, 0);
  int num_on_lcm = 0;
  const auto connection = runtime::open_lcm(url_);
  lcm_subscribe(
      connection.get(), ".*",
      [](const lcm_recv_buf_t*, const char*, void* count) { ++*static_cast<int*>(count); },
      &num_on_lcm);
  for (int i = 0; i < 20; ++i) {
    RawClient client(port);
    client.open_messages();
    client.send(client_frame(1 + i % 2, std::string("LADDER_COMMAND") + std::string(7, '\1')));
  }
  RawClient session(port);
  ASSERT_TRUE(session.open_messages());
  runtime::Bus bus(connection);
  ladder_msgs::pose_t pose{};
  pose.utime = 1;
  pose.q_odom_body[0] = 1.0;
  bus.publish(runtime::channels::kPose, pose);
  const auto frame = session.read_message();
  ASSERT_TRUE(frame) << child.output();
  EXPECT_EQ(frame->payload.size(), 10U + static_cast<std::size_t>(pose.getEncodedSize()));
  while (lcm_handle_timeout(connection.get(), 200) > 0) {
  }
  EXPECT_EQ(num_on_lcm, 1);
  child.signal(SIGTERM);
  EXPECT_EQ(child.wait(5s), 0);
}

}  // namespace
