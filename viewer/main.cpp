// SPDX-License-Identifier: BSD-3-Clause
// ladder_viewer: shows in a browser what is on LCM, or what a log holds. It subscribes and never
// publishes, and nothing that a browser sends leads to LCM. Exit codes as in runtime/service.h.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <systemd/sd-daemon.h>

#include "runtime/bus.h"
#include "runtime/clock.h"
#include "runtime/service.h"
#include "runtime/token.h"
#include "viewer/log_player.h"
#include "viewer/web_server.h"

namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using namespace std::chrono_literals;

constexpr auto kTick = 20ms;

struct Arguments {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8088;
  std::string token_file, page_folder, log, url;
};

/// The page lies where scripts/viewer and the package put it, seen from the program.
std::string page_beside_program() {
  return (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "../share/ladder/viewer")
      .lexically_normal()
      .string();
}

/// Everything the page draws; clouds and inertial samples stay where they are.
std::vector<const runtime::ChannelInfo*> shown_channels() {
  std::vector<const runtime::ChannelInfo*> channels;
  for (const runtime::ChannelInfo& channel : runtime::kChannels) {
    using Health = ladder_msgs::health_t;
    const bool is_shown = channel.number != Health::CHANNEL_CLOUD &&
                          channel.number != Health::CHANNEL_IMU &&
                          channel.number != Health::CHANNEL_CONFIG;
    if (is_shown) channels.push_back(&channel);
  }
  return channels;
}

/// The board and what feeds it: LCM or a log.
class Source {
 public:
  Source(asio::io_context& io, const Arguments& arguments) : lcm_readable_(io) {
    if (!arguments.log.empty()) {
      player_.emplace(arguments.log, board_);
      return;
    }
    const char* from_environment = std::getenv("LCM_DEFAULT_URL");
    std::string url = arguments.url;
    if (url.empty()) url = from_environment != nullptr ? from_environment : "";
    if (url.empty()) url = runtime::Bus::kDefaultUrl;
    tap_.emplace(runtime::open_lcm(url), shown_channels(), [this](const runtime::Heard& heard) {
      board_.post(heard, runtime::clock_now().utime_us);
    });
    if (const std::string problem = runtime::socket_buffer_problem(url); !problem.empty()) {
      std::fprintf(stderr, "viewer: %s\n", problem.c_str());
    }
    lcm_readable_.assign(tap_->file_descriptor());
  }
  ~Source() {
    if (tap_) lcm_readable_.release();  // LCM's own
  }
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Calls `then` after whatever arrived.
  void listen(const std::function<void()>& then) {
    if (!tap_) return;
    lcm_readable_.async_wait(asio::posix::stream_descriptor::wait_read,
                             [this, then](boost::system::error_code error) {
                               if (error) return;
                               tap_->drain();
                               then();
                               listen(then);
                             });
  }

  void tick() {
    if (player_) player_->step(runtime::clock_now().monotonic_us);
  }

  viewer::ServerContext context(const Arguments& arguments) {
    viewer::ServerContext context{
        viewer::Page::load(arguments.page_folder),
        arguments.token_file.empty() ? "" : runtime::read_token(arguments.token_file), board_,
        [this](std::int64_t num_missed) { return status(num_missed); }, nullptr};
    if (player_) context.on_order = [this](std::string_view order) { player_->obey(order); };
    return context;
  }

 private:
  std::string status(std::int64_t num_missed) const {
    return R"({"missed":)" + std::to_string(num_missed) + "," +
           (player_ ? player_->status()
                    : R"("received":)" + std::to_string(tap_->received()) + R"(,"rejected":)" +
                          std::to_string(tap_->rejected())) +
           "}";
  }

  runtime::MessageBoard board_;
  std::optional<runtime::Tap> tap_;
  std::optional<viewer::LogPlayer> player_;
  asio::posix::stream_descriptor lcm_readable_;
};

void tick(asio::steady_timer& timer, Source& source, viewer::WebServer& server) {
  source.tick();
  server.send_newest();
  sd_notify(0, "WATCHDOG=1");
  timer.expires_after(kTick);
  timer.async_wait([&](boost::system::error_code error) {
    if (!error) tick(timer, source, server);
  });
}

int run(const Arguments& arguments) {
  boost::system::error_code error;
  const auto address = asio::ip::make_address(arguments.address, error);
  if (error) throw std::runtime_error("'" + arguments.address + "' is not an IP address");
  if (!address.is_loopback() && arguments.token_file.empty()) {
    throw std::runtime_error("at " + arguments.address +
                             " everybody on the network could look: --token-file is needed there");
  }
  asio::io_context io;
  Source source(io, arguments);
  viewer::WebServer server(io, {address, arguments.port}, source.context(arguments));
  asio::signal_set stop_signals(io, SIGTERM, SIGINT);
  stop_signals.async_wait([&](boost::system::error_code, int) { io.stop(); });
  source.listen([&] { server.send_newest(); });
  asio::steady_timer timer(io);
  tick(timer, source, server);
  sd_notify(0, "READY=1");
  std::fprintf(stderr, "viewer: http://%s:%u/%s\n", arguments.address.c_str(), server.port(),
               arguments.token_file.empty() ? "" : "?token=...");
  io.run();
  return runtime::kExitAsked;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Shows in a browser what is on LCM, or what a log holds. It only ever listens."};
  Arguments arguments;
  arguments.page_folder = page_beside_program();
  app.add_option("--address", arguments.address, "address to serve at")->capture_default_str();
  app.add_option("--port", arguments.port, "TCP port; 0 = any")->capture_default_str();
  app.add_option("--token-file", arguments.token_file,
                 "its first line is asked of every visitor; needed for any but a loopback address");
  app.add_option("--page", arguments.page_folder, "folder of the built page")
      ->capture_default_str();
  app.add_option("--log", arguments.log, "play this LCM log instead of listening");
  app.add_option("--url", arguments.url, "LCM URL (default: LCM_DEFAULT_URL, else the robot's)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? runtime::kExitAsked : runtime::kExitConfiguration;
  }
  try {
    return run(arguments);
  } catch (const boost::system::system_error& error) {
    std::fprintf(stderr, "viewer: %s port %u: %s\n", arguments.address.c_str(), arguments.port,
                 error.what());
    return runtime::kExitDevice;
  } catch (const runtime::BusError& error) {
    std::fprintf(stderr, "viewer: %s\n", error.what());
    return runtime::kExitDevice;
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "viewer: %s\n", error.what());
    return runtime::kExitConfiguration;
  }
}
