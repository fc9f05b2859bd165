// SPDX-License-Identifier: BSD-3-Clause
// ladder_relay: carries chosen channels over TCP between the robot and a ground station, so that
// the robot's multicast never leaves it. --serve on the robot, --connect on the ground. Exit codes
// as in runtime/service.h.
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/signal_set.hpp>
#include <systemd/sd-daemon.h>

#include "relay/client.h"
#include "relay/server.h"
#include "runtime/bus.h"
#include "runtime/service.h"
#include "runtime/token.h"

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

constexpr std::chrono::seconds kTick{1};

struct Arguments {
  std::string serve, connect;  ///< "ADDRESS:PORT", one of the two
  std::optional<std::string> send, receive;
  std::string token_file, url;
};

/// "host:port" or "[host]:port".
struct Peer {
  std::string host, port;

  explicit Peer(const std::string& text) {
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos || colon == 0 || colon + 1 == text.size()) {
      throw std::runtime_error("'" + text + "' is not ADDRESS:PORT");
    }
    host = text.substr(0, colon);
    port = text.substr(colon + 1);
    if (host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  }

  tcp::endpoint to_serve() const {
    boost::system::error_code error;
    const auto address = asio::ip::make_address(host, error);
    std::uint16_t number = 0;
    const auto [rest, wrong] = std::from_chars(port.data(), port.data() + port.size(), number);
    if (error || wrong != std::errc() || rest != port.data() + port.size()) {
      throw std::runtime_error("'" + host + ":" + port + "' is not an IP address and a port");
    }
    return {address, number};
  }
};

std::string lcm_url(const Arguments& arguments) {
  if (!arguments.url.empty()) return arguments.url;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment != nullptr && *from_environment != '\0' ? from_environment
                                                                  : runtime::Bus::kDefaultUrl;
}

/// The serving or the connecting end; `io` runs it.
class Relay {
 public:
  Relay(asio::io_context& io, const Arguments& arguments)
      : endpoint_(runtime::open_lcm(lcm_url(arguments)),
                  relay::channels_of(
                      arguments.send.value_or(is_serving(arguments) ? relay::kTelemetry : "")),
                  relay::channels_of(
                      arguments.receive.value_or(is_serving(arguments) ? "" : relay::kTelemetry))),
        lcm_readable_(io, endpoint_.file_descriptor()),
        tick_(io) {
    const std::string token =
        arguments.token_file.empty() ? "" : runtime::read_token(arguments.token_file);
    const Peer peer(is_serving(arguments) ? arguments.serve : arguments.connect);
    if (is_serving(arguments)) {
      const tcp::endpoint address = peer.to_serve();
      if (!address.address().is_loopback() && token.empty()) {
        throw std::runtime_error("at " + peer.host + " everybody on the network could connect: " +
                                 "--token-file is needed there");
      }
      server_.emplace(io, address, token, endpoint_);
    } else {
      client_.emplace(io, peer.host, peer.port, token, endpoint_);
    }
    listen();
    tick();
  }
  ~Relay() { lcm_readable_.release(); }  // LCM's own
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

 private:
  static bool is_serving(const Arguments& arguments) { return !arguments.serve.empty(); }

  void listen() {
    lcm_readable_.async_wait(asio::posix::stream_descriptor::wait_read,
                             [this](boost::system::error_code error) {
                               if (error) return;
                               endpoint_.drain();
                               if (server_) server_->send_newest();
                               if (client_) client_->send_newest();
                               listen();
                             });
  }

  /// Tells the supervisor that it lives, and a person when a connection comes and goes.
  void tick() {
    sd_notify(0, "WATCHDOG=1");
    const int num_connections = server_                   ? server_->num_connections()
                                : client_->is_connected() ? 1
                                                          : 0;
    if (num_connections != num_told_) {
      std::fprintf(stderr, "relay: %d %s; %lld messages from there so far, %lld refused\n",
                   num_connections, num_connections == 1 ? "connection" : "connections",
                   static_cast<long long>(endpoint_.num_published()),
                   static_cast<long long>(endpoint_.num_rejected()));
      num_told_ = num_connections;
    }
    tick_.expires_after(kTick);
    tick_.async_wait([this](boost::system::error_code error) {
      if (!error) tick();
    });
  }

  relay::Endpoint endpoint_;
  asio::posix::stream_descriptor lcm_readable_;
  asio::steady_timer tick_;
  std::optional<relay::Server> server_;
  std::optional<relay::Client> client_;
  int num_told_ = -1;
};

int run(const Arguments& arguments) {
  asio::io_context io;
  Relay relay(io, arguments);
  asio::signal_set stop_signals(io, SIGTERM, SIGINT);
  stop_signals.async_wait([&](boost::system::error_code, int) { io.stop(); });
  sd_notify(0, "READY=1");
  io.run();
  return runtime::kExitAsked;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Carries chosen LCM channels over TCP between the robot (--serve) and a ground station "
      "(--connect)."};
  Arguments arguments;
  auto* serve = app.add_option("--serve", arguments.serve, "ADDRESS:PORT to wait at");
  auto* connect = app.add_option("--connect", arguments.connect, "HOST:PORT of the serving end");
  serve->excludes(connect);
  app.add_option("--send", arguments.send,
                 "channels for the other end (default: --serve telemetry, --connect none)");
  app.add_option("--receive", arguments.receive,
                 "channels taken from the other end (default: --serve none, --connect telemetry)");
  app.add_option(
      "--token-file", arguments.token_file,
      "its first line is the word both ends know; needed for any but a loopback address");
  app.add_option("--url", arguments.url, "LCM URL (default: LCM_DEFAULT_URL, else the robot's)");
  try {
    app.parse(argc, argv);
    if (arguments.serve.empty() == arguments.connect.empty()) {
      throw CLI::RequiredError("one of --serve and --connect");
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? runtime::kExitAsked : runtime::kExitConfiguration;
  }
  try {
    return run(arguments);
  } catch (const runtime::BusError& error) {
    std::fprintf(stderr, "relay: %s\n", error.what());
    return runtime::kExitDevice;
  } catch (const boost::system::system_error& error) {
    std::fprintf(stderr, "relay: %s: %s\n", arguments.serve.c_str(), error.what());
    return runtime::kExitDevice;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "relay: %s\n", error.what());
    return runtime::kExitConfiguration;
  }
}
