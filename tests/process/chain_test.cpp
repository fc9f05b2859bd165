// SPDX-License-Identifier: BSD-3-Clause
// Simulator and services as separate processes: the chain works, survives the death of any member,
// and malformed messages.
#include <chrono>
#include <csignal>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "runtime/bus.h"
#include "runtime/clock.h"
#include "tests/support/child_process.h"

namespace {

using support::ChildProcess;
using namespace std::chrono_literals;
namespace channels = runtime::channels;

const std::string kBin = LADDER_BIN_DIR;

class Chain : public ::testing::Test {
 protected:
  void SetUp() override {
    static int next_port = 30'000 + getpid() % 10'000 * 3;
    url_ = "udpm://239.255.76.67:" + std::to_string(next_port++) + "?ttl=0&recv_buf_size=4194304";
    bus_ = std::make_unique<runtime::Bus>(url_);
    rungs_ = &bus_->queue(channels::kRungs, 64);
    health_ = &bus_->shared_queue(channels::kHealth, 64);
    for (const char* service : {"sensor_service", "gng_service", "ladder_service"}) start(service);
    start("ladder_simulator");
  }

  void start(const std::string& program) {
    std::vector<std::string> arguments{"--url", url_};
    members_[program] = std::make_unique<ChildProcess>(kBin + "/" + program, arguments);
  }

  /// Whether condition() became true; keeps receiving meanwhile.
  template <class Condition>
  bool wait_for(Condition condition, std::chrono::milliseconds timeout) {
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      usleep(2'000);
      receive();
    }
    return true;
  }

  void receive() {
    bus_->drain();
    while (rungs_->take(0) != nullptr) ++num_rungs_messages_;
    while (const ladder_msgs::health_t* health = health_->take(0))
      latest_[health->service] = *health;
  }

  /// A new rungs message from now on.
  bool rungs_flow(std::chrono::milliseconds timeout) {
    receive();
    const int before = num_rungs_messages_;
    return wait_for([&] { return num_rungs_messages_ > before; }, timeout);
  }

  void publish_raw(const char* channel, const std::vector<std::uint8_t>& bytes) {
    if (!raw_) raw_ = runtime::open_lcm(url_);
    lcm_publish(raw_.get(), channel, bytes.data(), static_cast<unsigned int>(bytes.size()));
  }

  std::string url_;
  std::unique_ptr<runtime::Bus> bus_;
  std::shared_ptr<lcm_t> raw_;
  runtime::Queue<ladder_msgs::ladder_t>* rungs_ = nullptr;
  runtime::Queue<ladder_msgs::health_t>* health_ = nullptr;
  std::map<std::string, std::unique_ptr<ChildProcess>> members_;
  std::map<int, ladder_msgs::health_t> latest_;
  int num_rungs_messages_ = 0;
};

// Depth frames become rungs, every service reports that it works, and SIGTERM ends each within a
// second with 0.
TEST_F(Chain, WorksAndStops) {
  ASSERT_TRUE(rungs_flow(10s));
  EXPECT_TRUE(wait_for(
      [&] {
        int working = 0;
        for (const auto& [service, health] : latest_) {
          working += health.state == ladder_msgs::health_t::STATE_WORKING ||
                     health.state == ladder_msgs::health_t::STATE_DEGRADED;
        }
        return working >= 3;
      },
      5s));
  for (auto& [name, member] : members_) {
    member->signal(SIGTERM);
    EXPECT_EQ(member->wait(1s), 0) << name << ":\n" << member->output();
  }
}

// kill -9 of any member: the others go on, and after a restart rungs flow again within two seconds.
TEST_F(Chain, RecoversFromTheDeathOfAnyMember) {
  ASSERT_TRUE(rungs_flow(10s));
  for (const char* victim :
       {"sensor_service", "gng_service", "ladder_service", "ladder_simulator"}) {
    members_.at(victim)->signal(SIGKILL);
    members_.at(victim)->wait(2s);
    EXPECT_FALSE(rungs_flow(300ms)) << victim << " is dead, yet rungs arrive";
    for (auto& [name, member] : members_) {
      if (name == victim) continue;
      EXPECT_TRUE(member->running()) << name << " died with " << victim << ":\n"
                                     << member->output();
    }
    start(victim);
    EXPECT_TRUE(rungs_flow(2s)) << "not recovered after the restart of " << victim;
  }
}

// Malformed messages on every input channel are counted in health and end nothing.
TEST_F(Chain, MalformedMessagesAreCounted) {
  ASSERT_TRUE(rungs_flow(10s));
  for (int i = 0; i < 20; ++i) {
    for (const char* channel :
         {"LADDER_TOF_0", "LADDER_IMU", "LADDER_POSE", "LADDER_CLOUD", "LADDER_TOPOLOGY"}) {
      publish_raw(channel, {});
      publish_raw(channel, std::vector<std::uint8_t>(100, 0xFF));
    }
  }
  EXPECT_TRUE(wait_for(
      [&] {
        using Health = ladder_msgs::health_t;
        for (const int service :
             {Health::SERVICE_SENSOR, Health::SERVICE_GNG, Health::SERVICE_LADDER}) {
          const Health& health = latest_[service];
          if (health.rejected_size < 20 || health.rejected_fingerprint < 20) return false;
        }
        return true;
      },
      5s));
  EXPECT_TRUE(rungs_flow(2s));
  for (auto& [name, member] : members_)
    EXPECT_TRUE(member->running()) << name << ":\n" << member->output();
}

}  // namespace
