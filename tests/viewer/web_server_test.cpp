// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/web_server.h"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include <boost/asio/post.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "base/rng.h"
#include "tests/viewer/raw_client.h"

namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using viewer::WebServer;
using viewer_test::client_frame;
using viewer_test::RawClient;

constexpr const char* kUpgrade = "Host: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n";

/// A server with a page of two files, on a thread of its own.
class WebServerTest : public ::testing::Test {
 protected:
  void start(const std::string& token = "", bool plays_log = false) {
    folder_ = "/tmp/ladder-page-" + std::to_string(getpid());
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ + "/index.html") << "<title>Ladder</title>";
    std::ofstream(folder_ + "/page.js") << "let ladder;";
    std::ofstream(folder_ + "/secret.key") << "not a page";
    viewer::ServerContext context{viewer::Page::load(folder_), token, board_,
                                  [](std::int64_t) { return std::string("{}"); }, nullptr};
    if (plays_log) {
      context.on_order = [this](std::string_view order) { orders_.emplace_back(order); };
    }
    server_.emplace(io_, boost::asio::ip::tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0),
                    std::move(context));
    port_ = server_->port();
    thread_ = std::thread([this] { io_.run(); });
  }
  void TearDown() override {
    io_.stop();
    if (thread_.joinable()) thread_.join();
    std::filesystem::remove_all(folder_);
  }

  /// Runs on the server's thread.
  template <class Work>
  void there(Work work) {
    std::promise<void> done;
    boost::asio::post(io_, [&] {
      work();
      done.set_value();
    });
    done.get_future().wait();
  }
  void post_rungs(std::uint8_t content, std::size_t num_bytes = 1) {
    there([&] {
      const std::vector<std::uint8_t> bytes(num_bytes, content);
      board_.post({*runtime::find_channel("LADDER_RUNGS"), 0, bytes}, 0x0102030405060708);
      server_->send_newest();
    });
  }
  std::string answer_to(const std::string& request) {
    RawClient client(port_);
    client.send(request);
    return client.read_all();
  }
  int num_web_sockets() {
    int number = 0;
    there([&] { number = server_->num_web_sockets(); });
    return number;
  }

  std::string folder_;
  boost::asio::io_context io_;
  runtime::MessageBoard board_;
  std::vector<std::string> orders_;  ///< of the server's thread
  std::optional<WebServer> server_;
  std::uint16_t port_ = 0;
  std::thread thread_;
};

// The page's files are served, one request per connection; nothing else of the disk is, however it
// is asked for.
TEST_F(WebServerTest, Files) {
  start();
  const auto get = [&](const std::string& target) {
    return answer_to("GET " + target + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  };
  EXPECT_THAT(get("/"), HasSubstr("<title>Ladder</title>"));
  EXPECT_THAT(get("/page.js?x=1"), HasSubstr("text/javascript"));
  EXPECT_THAT(get("/"), HasSubstr("Content-Security-Policy: default-src 'self'"));
  for (const char* target : {"/secret.key", "/../../etc/passwd", "/%2e%2e/etc/passwd", "//",
                             "/page", "/page.js/", "*", "http://localhost/"}) {
    EXPECT_THAT(get(target), StartsWith("HTTP/1.1 404")) << target;
  }
}

// Whatever is not a plain request to look is refused or cut off; the server goes on.
TEST_F(WebServerTest, BadRequests) {
  start();
  const std::string end = "Host: localhost\r\n\r\n";
  EXPECT_THAT(answer_to("POST / HTTP/1.1\r\n" + end), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(answer_to("DELETE / HTTP/1.1\r\n" + end), StartsWith("HTTP/1.1 405"));
  EXPECT_THAT(answer_to("GET / HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(answer_to("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(answer_to("GET /elsewhere HTTP/1.1\r\n" + std::string(kUpgrade) + "\r\n"),
              StartsWith("HTTP/1.1 404"));
  EXPECT_EQ(answer_to("\r\n\r\n\x01\x02 nonsense\r\n\r\n"), "");
  EXPECT_EQ(answer_to("GET / HTTP/9.9\r\n" + end), "");
  EXPECT_EQ(answer_to("POST / HTTP/1.1\r\nContent-Length: 5\r\n" + end + "12345"), "");
  EXPECT_EQ(answer_to("GET / HTTP/1.1\r\nX: " + std::string(20'000, 'x') + "\r\n" + end), "");
  EXPECT_THAT(answer_to("GET / HTTP/1.1\r\n" + end), StartsWith("HTTP/1.1 200"));
}

// With a token nobody sees anything without it; with it a cookie takes its place.
TEST_F(WebServerTest, Token) {
  const std::string token = "0123456789abcdef";
  start(token);
  EXPECT_THAT(answer_to("GET / HTTP/1.1\r\nHost: robot\r\n\r\n"), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(answer_to("GET /?token=wrong HTTP/1.1\r\nHost: robot\r\n\r\n"),
              StartsWith("HTTP/1.1 401"));
  const std::string answer = answer_to("GET /?token=" + token + " HTTP/1.1\r\nHost: robot\r\n\r\n");
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 303"));
  EXPECT_THAT(answer, HasSubstr("ladder_token=" + token + "; Path=/; HttpOnly; SameSite=Strict"));
  EXPECT_FALSE(RawClient(port_).open_messages());
  EXPECT_TRUE(RawClient(port_).open_messages("Cookie: ladder_token=" + token + "\r\n"));
}

// A session gets time, channel and the very bytes of the newest message; late ones get it too.
TEST_F(WebServerTest, Messages) {
  start();
  RawClient early(port_);
  ASSERT_TRUE(early.open_messages());
  post_rungs(7, 3);
  RawClient late(port_);
  ASSERT_TRUE(late.open_messages());
  for (RawClient* client : {&early, &late}) {
    const auto frame = client->read_message();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->payload,
              std::string("\x01\x02\x03\x04\x05\x06\x07\x08\x00\x09\x07\x07\x07", 13));
  }
}

// A page of another site is not let in.
TEST_F(WebServerTest, ForeignOrigin) {
  start();
  EXPECT_FALSE(RawClient(port_).open_messages("Origin: http://evil.example\r\n"));
  EXPECT_TRUE(RawClient(port_).open_messages("Origin: http://localhost\r\n"));
}

// A page that stops reading costs one message on its way, not a queue; when it reads again it gets
// the newest, and others never waited for it.
TEST_F(WebServerTest, SlowClient) {
  start();
  RawClient slow(port_, 4096);
  RawClient quick(port_);
  ASSERT_TRUE(slow.open_messages());
  ASSERT_TRUE(quick.open_messages());
  constexpr std::size_t kLarge = 4'000'000;  // more than the kernel takes for a reader that sleeps
  constexpr int kNumMessages = 12;
  for (int i = 1; i <= kNumMessages; ++i) {
    post_rungs(static_cast<std::uint8_t>(i), kLarge);
    const auto frame = quick.read_message();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->payload.back(), i);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));  // the stream's shortest period
  }
  int num_read = 0;
  char last = 0;
  there([&] { server_->send_newest(); });
  while (last != kNumMessages) {
    const auto frame = slow.read_message();
    ASSERT_TRUE(frame);
    last = frame->payload.back();
    ++num_read;
    there([&] { server_->send_newest(); });
  }
  EXPECT_LT(num_read, kNumMessages / 2);
}

// Live, whoever says anything but what the protocol itself needs is cut off.
TEST_F(WebServerTest, NobodySpeaksToALiveViewer) {
  start();
  for (const int opcode : {1, 2}) {
    for (const std::size_t size : {0, 1, 64, 65, 60'000}) {
      RawClient client(port_);
      ASSERT_TRUE(client.open_messages());
      client.send(client_frame(opcode, std::string(size, 'x')));
      EXPECT_TRUE(client.is_closed()) << opcode << " " << size;
    }
  }
  RawClient endless(port_);
  ASSERT_TRUE(endless.open_messages());
  endless.send(
      std::string("\x82\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14));  // 2^63 - 1 bytes
  EXPECT_TRUE(endless.is_closed());
  RawClient polite(port_);
  ASSERT_TRUE(polite.open_messages());
  polite.send(client_frame(9, "ping"));
  post_rungs(1);
  EXPECT_TRUE(polite.read_message());
}

// When a log is played, short texts are orders; anything else still cuts off.
TEST_F(WebServerTest, OrdersToALog) {
  start("", true);
  RawClient client(port_);
  ASSERT_TRUE(client.open_messages());
  client.send(client_frame(1, "pause") + client_frame(1, "seek 12.5") + client_frame(2, "bytes"));
  EXPECT_TRUE(client.is_closed());
  there([&] { EXPECT_THAT(orders_, ::testing::ElementsAre("pause", "seek 12.5")); });
}

// Connections are bounded, and slots come back: more pages than there may be are turned away,
// and when the others go somebody new is let in.
TEST_F(WebServerTest, ConnectionsAreBounded) {
  start();
  std::vector<std::unique_ptr<RawClient>> crowd;
  int num_open = 0;
  for (int i = 0; i < WebServer::kMaxWebSockets + 4; ++i) {
    crowd.push_back(std::make_unique<RawClient>(port_));
    num_open += crowd.back()->open_messages() ? 1 : 0;
  }
  EXPECT_EQ(num_open, WebServer::kMaxWebSockets);
  EXPECT_EQ(num_web_sockets(), WebServer::kMaxWebSockets);
  crowd.clear();
  bool is_open = false;
  for (int i = 0; i < 100 && !is_open; ++i) is_open = RawClient(port_).open_messages();
  EXPECT_TRUE(is_open);
}

// Random frames, random requests and connections that say nothing: the server stays, serves and
// shows.
TEST_F(WebServerTest, Nonsense) {
  start();
  base::Rng rng(3);
  std::vector<std::unique_ptr<RawClient>> silent;
  for (int i = 0; i < 40; ++i) silent.push_back(std::make_unique<RawClient>(port_));
  for (int i = 0; i < 60; ++i) {
    RawClient client(port_);
    const bool is_open = i % 2 == 0 && client.open_messages();
    std::string bytes(1 + rng.next() % 500, '\0');
    for (char& byte : bytes) byte = static_cast<char>(rng.next());
    client.send(bytes);
    if (is_open) client.send(bytes);
  }
  post_rungs(9);
  RawClient client(port_);
  ASSERT_TRUE(client.open_messages());
  const auto frame = client.read_message();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->payload.back(), 9);
}

}  // namespace
