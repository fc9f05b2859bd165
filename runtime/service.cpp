// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/service.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <CLI/CLI.hpp>
#include <poll.h>
#include <sys/signalfd.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include "ladder_msgs/config_t.hpp"
#include "runtime/clock.h"
#include "runtime/version.h"

namespace runtime {
namespace {

constexpr int kMaxWaitMs = 50;
constexpr std::int64_t kHealthPeriodUs = 500'000;
constexpr std::int64_t kConfigPeriodUs = 5'000'000;

struct Arguments {
  std::vector<std::string> config_files;
  std::vector<std::string> overrides;
  std::string url;
  bool check = false;
};

/// SIGTERM and SIGINT as a readable file descriptor; blocked before LCM starts its thread, which
/// inherits the mask.
int open_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  sigprocmask(SIG_BLOCK, &signals, nullptr);
  return signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
}

std::string lcm_url(const Arguments& arguments) {
  if (!arguments.url.empty()) return arguments.url;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  return from_environment != nullptr && *from_environment != '\0' ? from_environment
                                                                  : Bus::kDefaultUrl;
}

/// Publishes health twice a second and the configuration every five seconds.
class Reporter {
 public:
  Reporter(Bus& bus, Health& health, const ServiceDescription& description, const Config& config)
      : bus_(bus), health_(health) {
    config_.config_hash = config.hash();
    config_.service = description.number;
    config_.version = kVersion;
    config_.toml = config.resolved();
    config_.seq = -1;
  }

  void report(const base::Now& now) {
    if (now.monotonic_us >= next_health_us_) {
      next_health_us_ = now.monotonic_us + kHealthPeriodUs;
      bus_.publish(channels::kHealth, health_.snapshot(now.utime_us, bus_));
    }
    if (now.monotonic_us >= next_config_us_) {
      next_config_us_ = now.monotonic_us + kConfigPeriodUs;
      config_.utime = now.utime_us;
      ++config_.seq;
      bus_.publish(channels::kConfig, config_);
    }
  }

 private:
  Bus& bus_;
  Health& health_;
  ladder_msgs::config_t config_{};
  std::int64_t next_health_us_ = 0;
  std::int64_t next_config_us_ = 0;
};

/// Events go out on the bus as long as this lives: an error that ends the start is told when the
/// bus is gone already.
class PublishedJournal {
 public:
  PublishedJournal(Journal& journal, Bus& bus) : journal_(journal) {
    journal.publish_to(
        [&bus](const ladder_msgs::event_t& event) { bus.publish(channels::kEvent, event); });
  }
  ~PublishedJournal() { journal_.publish_to(nullptr); }
  PublishedJournal(const PublishedJournal&) = delete;
  PublishedJournal& operator=(const PublishedJournal&) = delete;

 private:
  Journal& journal_;
};

/// The service's exit code.
int work_until_stopped(Service& service, Bus& bus, Health& health, Reporter& reporter,
                       int stop_signals) {
  pollfd waiting[3] = {{bus.file_descriptor(), POLLIN, 0},
                       {stop_signals, POLLIN, 0},
                       {service.wake_up(), POLLIN, 0}};
  bool asked = false;
  while (true) {
    poll(waiting, 3, kMaxWaitMs);
    signalfd_siginfo signal{};
    if (read(stop_signals, &signal, sizeof signal) == sizeof signal) {
      if (asked) return kExitAsked;
      asked = true;
    }
    bus.drain();
    service.step(clock_now());
    health.count_step();
    if (service.is_healthy()) sd_notify(0, "WATCHDOG=1");
    reporter.report(clock_now());
    if (const std::optional<int> code = service.end_now(asked)) return *code;
  }
}

/// Everything that may throw; the caller turns exceptions into exit codes.
int run(const ServiceDescription& description, const Arguments& arguments, Journal& journal) {
  const Config config = Config::load(arguments.config_files, arguments.overrides);
  const int stop_signals = open_stop_signals();
  const std::string url = arguments.check ? "memq://" : lcm_url(arguments);
  Bus bus(url);
  Health health(description.number);
  const std::unique_ptr<Service> service =
      description.make({bus, config.table(description.name), health, journal});
  config.check_all_read({description.name}, known_config_tables());
  health.set_config_hash(config.hash());
  if (arguments.check) {
    std::printf("%s", config.resolved().c_str());
    return kExitAsked;
  }
  const PublishedJournal published(journal, bus);
  if (const std::string problem = socket_buffer_problem(url); !problem.empty()) {
    journal.warning(problem);
    health.set_flag(ladder_msgs::health_t::FLAG_SMALL_SOCKET_BUFFER, true);
  }
  service->start();
  journal.info("started, " + url);
  sd_notify(0, "READY=1");
  Reporter reporter(bus, health, description, config);
  const int code = work_until_stopped(*service, bus, health, reporter, stop_signals);
  sd_notify(0, "STOPPING=1");
  health.set_state(ladder_msgs::health_t::STATE_STOPPING);
  bus.publish(channels::kHealth, health.snapshot(clock_now().utime_us, bus));
  journal.info(code == kExitAsked ? "stopped as asked" : "stopped");
  close(stop_signals);
  return code;
}

}  // namespace

const std::vector<std::string>& known_config_tables() {
  static const std::vector<std::string> tables{"sensor", "gng",       "ladder",
                                               "climb",  "simulator", "viewer"};
  return tables;
}

int run_service(int argc, char** argv, const ServiceDescription& description) {
  CLI::App app{description.purpose};
  Arguments arguments;
  app.add_option("-c,--config", arguments.config_files,
                 "TOML file; later ones win (default: built-in values)");
  app.add_option("--set", arguments.overrides, "table.key=value, wins over the files")
      ->allow_extra_args(false);
  app.add_option("--url", arguments.url, "LCM URL (default: LCM_DEFAULT_URL, else the robot's)");
  app.add_flag("--check", arguments.check, "print the resolved configuration and stop");
  for (const Shorthand& shorthand : description.shorthands) {
    app.add_option_function<std::string>(
        shorthand.option,
        [&arguments, key = shorthand.key + "="](const std::string& value) {
          arguments.overrides.push_back(key + value);
        },
        shorthand.help);
  }
  app.set_version_flag("--version", std::string(kVersion));
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kExitAsked : kExitConfiguration;
  }
  Journal journal(description.number, description.name);
  try {
    return run(description, arguments, journal);
  } catch (const ConfigError& error) {
    journal.error(std::string("configuration: ") + error.what());
    return kExitConfiguration;
  } catch (const BusError& error) {
    journal.error(error.what());
    return kExitDevice;
  } catch (const DeviceError& error) {
    journal.error(error.what());
    return kExitDevice;
  } catch (const std::exception& error) {
    journal.error(std::string("internal error: ") + error.what());
    return kExitInternal;
  }
}

}  // namespace runtime
