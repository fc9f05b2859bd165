// SPDX-License-Identifier: BSD-3-Clause
// Robot and ground station in one process: an LCM each, in memory, and TCP between them.
#include <chrono>
#include <functional>
#include <optional>

#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ladder_msgs/command_t.hpp"
#include "ladder_msgs/ladder_t.hpp"
#include "relay/client.h"
#include "relay/server.h"
#include "runtime/bus.h"
#include "runtime/clock.h"

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using relay::channels_of;
using relay::Client;
using relay::Endpoint;
using relay::Server;
using namespace std::chrono_literals;

constexpr const char* kToken = "0123456789abcdef";
const tcp::endpoint kAnyPort(asio::ip::address_v4::loopback(), 0);

ladder_msgs::ladder_t rungs(std::int64_t seq) {
  ladder_msgs::ladder_t message{};
  message.utime = 1000 + seq;
  message.seq = seq;
  message.ladder_state = message.LADDER_NONE;
  return message;
}

ladder_msgs::command_t order(std::int64_t seq) {
  ladder_msgs::command_t message{};
  message.utime = 1000 + seq;
  message.seq = seq;
  message.session_id = 5;
  message.order = message.ORDER_HOLD;
  return message;
}

/// One computer's LCM and what is heard there.
struct Host {
  explicit Host(const char* send, const char* receive)
      : endpoint(connection, channels_of(send), channels_of(receive)) {}

  std::shared_ptr<lcm_t> connection = runtime::open_lcm("memq://");
  Endpoint endpoint;
  runtime::Bus bus{connection};
  runtime::Queue<ladder_msgs::ladder_t>& heard_rungs =
      bus.shared_queue(runtime::channels::kRungs, 100);
  runtime::Queue<ladder_msgs::command_t>& heard_orders =
      bus.shared_queue(runtime::channels::kCommand, 100);
};

class RelayTest : public ::testing::Test {
 protected:
  void serve(std::uint16_t port = 0) {
    server_.emplace(io_, tcp::endpoint(kAnyPort.address(), port), kToken, robot_.endpoint);
  }
  void connect(const std::string& token = kToken) {
    client_.emplace(io_, "127.0.0.1", std::to_string(server_->port()), token, ground_.endpoint);
  }
  /// Everything goes on until it is true; false after ten seconds.
  bool until(const std::function<bool()>& is_done) {
    const std::int64_t end_us = runtime::clock_now().monotonic_us + 10'000'000;
    while (!is_done()) {
      if (runtime::clock_now().monotonic_us > end_us) return false;
      go_on(5ms);
    }
    return true;
  }
  void go_on(std::chrono::milliseconds time) {
    robot_.bus.drain();  // one connection each: also what the endpoint subscribes to
    ground_.bus.drain();
    if (server_) server_->send_newest();
    if (client_) client_->send_newest();
    io_.run_for(time);
  }
  bool until_connected() {
    return until([&] { return client_->is_connected() && server_->num_connections() == 1; });
  }

  Host robot_{"LADDER_RUNGS", "LADDER_COMMAND"};
  Host ground_{"LADDER_COMMAND", "LADDER_RUNGS"};
  asio::io_context io_;
  std::optional<Server> server_;
  std::optional<Client> client_;
};

// Chosen channels arrive at the other end as they were; others, and a name that is none, do not.
TEST_F(RelayTest, CarriesChosenChannels) {
  EXPECT_THROW(channels_of("LADDER_RUNGS,LADDER_NONSENSE"), std::runtime_error);
  EXPECT_TRUE(channels_of("").empty());
  EXPECT_FALSE(channels_of(relay::kTelemetry).empty());
  serve();
  connect();
  ASSERT_TRUE(until_connected());
  ladder_msgs::pose_t pose{};
  pose.utime = 1;
  pose.q_odom_body[0] = 1.0;
  robot_.bus.publish(runtime::channels::kPose, pose);
  robot_.bus.publish(runtime::channels::kRungs, rungs(7));
  const ladder_msgs::ladder_t* heard = nullptr;
  ASSERT_TRUE(until([&] { return (heard = ground_.heard_rungs.take(0)) != nullptr; }));
  EXPECT_EQ(heard->seq, 7);
  EXPECT_EQ(heard->utime, 1007);
  EXPECT_EQ(ground_.endpoint.num_published(), 1);
}

// Orders go the other way, every one of them and in their order.
TEST_F(RelayTest, OrdersAreNotSkipped) {
  serve();
  connect();
  ASSERT_TRUE(until_connected());
  for (int i = 0; i < 10; ++i) ground_.bus.publish(runtime::channels::kCommand, order(i));
  while (ground_.heard_orders.take(0) != nullptr) {
  }
  for (int i = 0; i < 10; ++i) {
    const ladder_msgs::command_t* heard = nullptr;
    ASSERT_TRUE(until([&] { return (heard = robot_.heard_orders.take(0)) != nullptr; }));
    EXPECT_EQ(heard->seq, i);
  }
}

// A channel that would go both ways is refused: it would go round for ever.
TEST_F(RelayTest, NoCircles) {
  EXPECT_THROW(Endpoint(runtime::open_lcm("memq://"), channels_of("LADDER_RUNGS,LADDER_POSE"),
                        channels_of("LADDER_POSE")),
               std::runtime_error);
}

// Without the right word nobody gets a connection, and the slot is free again.
TEST_F(RelayTest, Token) {
  serve();
  connect("0123456789abcdeX");
  go_on(1500ms);
  EXPECT_EQ(server_->num_connections(), 0);
  client_.reset();
  io_.restart();
  connect();
  EXPECT_TRUE(until_connected());
}

// When the serving end dies and comes back, the other connects again by itself.
TEST_F(RelayTest, ConnectsAgain) {
  serve();
  const std::uint16_t port = server_->port();
  connect();
  ASSERT_TRUE(until_connected());
  server_.reset();
  ASSERT_TRUE(until([&] { return !client_->is_connected(); }));
  robot_.bus.publish(runtime::channels::kRungs, rungs(1));
  go_on(1500ms);
  EXPECT_EQ(ground_.heard_rungs.take(0), nullptr);
  serve(port);
  EXPECT_TRUE(until([&] { return ground_.heard_rungs.take(0) != nullptr; }));
}

/// A peer that speaks for itself.
class Peer {
 public:
  Peer(asio::io_context& io, std::uint16_t port) : socket_(io) {
    socket_.connect({kAnyPort.address(), port});
  }
  void say(const std::string& bytes) {
    boost::system::error_code ignored;
    asio::write(socket_, asio::buffer(bytes), ignored);
  }
  void say_message(std::int16_t number, const std::string& message) {
    std::string head;
    for (int shift = 24; shift >= 0; shift -= 8) head += static_cast<char>(message.size() >> shift);
    head += static_cast<char>(number >> 8);
    head += static_cast<char>(number);
    say(head + message);
  }

 private:
  tcp::socket socket_;
};

std::string bytes_of(const ladder_msgs::command_t& message) {
  std::string bytes(static_cast<std::size_t>(message.getEncodedSize()), '\0');
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

// A peer that knows the word can still send nothing but sound messages of the channels it may:
// unsound ones are counted, another channel or a length beyond its type's ends the connection.
TEST_F(RelayTest, HostilePeer) {
  constexpr auto kCommand = ladder_msgs::health_t::CHANNEL_COMMAND;
  const std::string word = std::string("LADDER-RELAY 1 ") + kToken + "\n";
  serve();
  {
    Peer peer(io_, server_->port());
    peer.say(word);
    peer.say_message(kCommand, "nonsense");
    std::string cut = bytes_of(order(1));
    cut.pop_back();
    peer.say_message(kCommand, cut);
    peer.say_message(kCommand, bytes_of(order(2)));
    ASSERT_TRUE(until([&] { return robot_.endpoint.num_published() == 1; }));
    EXPECT_EQ(robot_.endpoint.num_rejected(), 2);
  }
  ASSERT_TRUE(until([&] { return server_->num_connections() == 0; }));
  const std::string huge("\xff\xff\xff\xff\x00\x0a", 6);
  const std::string not_allowed("\x00\x00\x00\x01\x00\x09x", 7);
  const std::string unknown("\x00\x00\x00\x01\x7f\xffx", 7);
  for (const std::string& bad : {huge, not_allowed, unknown}) {
    Peer peer(io_, server_->port());
    peer.say(word);
    ASSERT_TRUE(until([&] { return server_->num_connections() == 1; }));
    peer.say(bad);
    EXPECT_TRUE(until([&] { return server_->num_connections() == 0; }));
  }
  EXPECT_EQ(robot_.endpoint.num_published(), 1);
}

// A peer that reads nothing costs one message on its way: the robot goes on, memory is bounded by
// the board, and a silent connection is given up.
TEST_F(RelayTest, PeerThatDoesNotRead) {
  serve();
  Peer peer(io_, server_->port());
  peer.say(std::string("LADDER-RELAY 1 ") + kToken + "\n");
  ASSERT_TRUE(until([&] { return server_->num_connections() == 1; }));
  std::int64_t seq = 0;
  EXPECT_TRUE(until([&] {
    for (int i = 0; i < 100; ++i) robot_.bus.publish(runtime::channels::kRungs, rungs(seq++));
    while (robot_.heard_rungs.take(0) != nullptr) {
    }
    return server_->num_connections() == 0;
  }));
}

}  // namespace
