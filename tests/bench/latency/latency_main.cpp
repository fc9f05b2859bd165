// SPDX-License-Identifier: BSD-3-Clause
// ladder_latency: how old perception's answers are. Plays four heads on LCM and listens.
//   default          the services run already: depth frame received -> rungs received, messages
//   lost
//   --slow_work_ms   nobody else runs: a consumer of head 0 that works so long on each frame; how
//   old
//                    its data is when work begins
// Exit codes: 0 measured, 1 nothing came, 2 wrong arguments, 3 LCM missing.
#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <poll.h>

#include "ladder_msgs/health_t.hpp"
#include "ladder_msgs/ladder_t.hpp"
#include "ladder_msgs/point_cloud_t.hpp"
#include "ladder_msgs/topology_t.hpp"
#include "runtime/bus.h"
#include "runtime/clock.h"
#include "tests/bench/latency/head_player.h"

namespace {

namespace channels = runtime::channels;

constexpr int kExitNothing = 1;
constexpr int kExitArguments = 2;
constexpr int kExitDevice = 3;

struct Arguments {
  double seconds = 10.0;
  double rate_hz = 15.0;
  std::optional<double> slow_work_ms;
  std::string url;
  std::string json_path;
};

/// Name and value of everything measured, in the order of a report.
using Figures = std::vector<std::pair<std::string, double>>;

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return -1.0;
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(q * static_cast<double>(values.size()));
  return values[std::min(rank, values.size() - 1)];
}

void add_quantiles(Figures& figures, const std::string& name, const std::vector<double>& values) {
  figures.emplace_back(name + "_p50_ms", quantile(values, 0.50));
  figures.emplace_back(name + "_p99_ms", quantile(values, 0.99));
  figures.emplace_back(name + "_max_ms", quantile(values, 1.0));
}

bool wait_readable(const runtime::Bus& bus) {
  pollfd readable{bus.file_descriptor(), POLLIN, 0};
  return poll(&readable, 1, 50) > 0;
}

double ms(std::int64_t us) {
  return 1e-3 * static_cast<double>(us);
}

/// Hears everything that perception hears and says.
class Observer {
 public:
  explicit Observer(const std::string& url)
      : bus_(url),
        clouds_(bus_.queue(channels::kCloud, 8)),
        topologies_(bus_.queue(channels::kTopology, 8)),
        rungs_(bus_.queue(channels::kRungs, 64)),
        health_(bus_.shared_queue(channels::kHealth, 64)) {
    for (std::size_t head = 0; head < frames_.size(); ++head) {
      frames_[head] = &bus_.queue(channels::kTof[head], 16);
    }
  }

  void receive() {
    if (!wait_readable(bus_)) return;
    bus_.drain();
    const std::int64_t now_us = runtime::clock_now().monotonic_us;
    for (auto* queue : frames_) {
      while (const auto* frame = queue->take(0)) received_.push_back({frame->utime, now_us});
    }
    while (received_.size() > kKept) received_.pop_front();
    while (clouds_.take(0) != nullptr) ++num_clouds_;
    while (topologies_.take(0) != nullptr) ++num_topologies_;
    while (const auto* rungs = rungs_.take(0)) match(rungs->utime, now_us);
    while (const auto* health = health_.take(0)) newest_health_[health->service] = *health;
  }

  Figures figures() const {
    Figures figures;
    add_quantiles(figures, "depth_to_rungs", latencies_ms_);
    figures.emplace_back("clouds", num_clouds_);
    figures.emplace_back("topologies", num_topologies_);
    figures.emplace_back("rungs", num_rungs_);
    figures.emplace_back("rungs_matched", static_cast<double>(latencies_ms_.size()));
    std::int64_t lost = 0;
    for (const auto& input : bus_.inputs()) lost += input->counts.lost;
    figures.emplace_back("lost_here", static_cast<double>(lost));
    std::int64_t lost_by_services = 0;
    std::int64_t overwritten = 0;
    for (const auto& [service, health] : newest_health_) {
      for (const std::int64_t count : health.input_lost) lost_by_services += count;
      for (const std::int64_t count : health.input_overwritten) overwritten += count;
    }
    figures.emplace_back("services_heard", static_cast<double>(newest_health_.size()));
    figures.emplace_back("lost_by_services", static_cast<double>(lost_by_services));
    figures.emplace_back("overwritten_in_services", static_cast<double>(overwritten));
    return figures;
  }

 private:
  static constexpr std::size_t kKept = 256;
  struct Received {
    std::int64_t utime_us, at_us;
  };

  void match(std::int64_t utime_us, std::int64_t now_us) {
    ++num_rungs_;
    const auto of_this_time = [utime_us](const Received& r) { return r.utime_us == utime_us; };
    const auto frame = std::find_if(received_.rbegin(), received_.rend(), of_this_time);
    if (frame != received_.rend()) latencies_ms_.push_back(ms(now_us - frame->at_us));
  }

  runtime::Bus bus_;
  std::array<runtime::Queue<ladder_msgs::tof_frame_t>*, bench::HeadPlayer::kNumHeads> frames_{};
  runtime::Queue<ladder_msgs::point_cloud_t>& clouds_;
  runtime::Queue<ladder_msgs::topology_t>& topologies_;
  runtime::Queue<ladder_msgs::ladder_t>& rungs_;
  runtime::Queue<ladder_msgs::health_t>& health_;
  std::deque<Received> received_;
  std::vector<double> latencies_ms_;
  std::map<int, ladder_msgs::health_t> newest_health_;
  int num_clouds_ = 0, num_topologies_ = 0, num_rungs_ = 0;
};

/// A service that works too long on each frame of head 0, in the loop of all services.
class SlowConsumer {
 public:
  SlowConsumer(const std::string& url, double work_ms)
      : bus_(url), frames_(bus_.newest(channels::kTof[0])), work_us_(std::int64_t(1e3 * work_ms)) {}

  void receive() {
    wait_readable(bus_);
    bus_.drain();
    const base::Now begin = runtime::clock_now();
    const auto* frame = frames_.take(begin.utime_us);
    if (frame == nullptr) return;
    ages_ms_.push_back(ms(begin.utime_us - frame->utime));
    while (runtime::clock_now().monotonic_us < begin.monotonic_us + work_us_) {
    }
  }

  Figures figures() const {
    Figures figures;
    add_quantiles(figures, "age_at_start", ages_ms_);
    const runtime::InputCounts& counts = bus_.inputs().front()->counts;
    figures.emplace_back("worked_on", static_cast<double>(ages_ms_.size()));
    figures.emplace_back("received", static_cast<double>(counts.received));
    figures.emplace_back("overwritten", static_cast<double>(counts.overwritten));
    figures.emplace_back("lost_here", static_cast<double>(counts.lost));
    return figures;
  }

 private:
  runtime::Bus bus_;
  runtime::Mailbox<ladder_msgs::tof_frame_t>& frames_;
  std::int64_t work_us_;
  std::vector<double> ages_ms_;
};

template <class Listener>
Figures measure(const Arguments& arguments, Listener& listener) {
  bench::HeadPlayer player(arguments.url, arguments.rate_hz);
  const std::int64_t end_us =
      runtime::clock_now().monotonic_us + static_cast<std::int64_t>(1e6 * arguments.seconds);
  player.start();
  while (runtime::clock_now().monotonic_us < end_us) listener.receive();
  player.stop();
  const std::int64_t drained_us = runtime::clock_now().monotonic_us + 1'500'000;  // health, too
  while (runtime::clock_now().monotonic_us < drained_us) listener.receive();
  Figures figures = listener.figures();
  figures.emplace_back("frames_sent", static_cast<double>(player.num_sent()));
  figures.emplace_back("frames_sent_late", static_cast<double>(player.num_late()));
  return figures;
}

int report(const Arguments& arguments, const Figures& figures) {
  std::ostringstream json;
  for (const auto& [name, value] : figures) {
    std::printf("%-26s %10.3f\n", name.c_str(), value);
    json << (json.tellp() == 0 ? "{\n" : ",\n") << "  \"" << name << "\": " << value;
  }
  json << "\n}\n";
  if (!arguments.json_path.empty() && !(std::ofstream(arguments.json_path) << json.str())) {
    std::fprintf(stderr, "ladder_latency: cannot write %s\n", arguments.json_path.c_str());
    return kExitArguments;
  }
  return figures.front().second < 0.0 ? kExitNothing : 0;
}

int run(const Arguments& arguments) {
  if (arguments.slow_work_ms) {
    SlowConsumer consumer(arguments.url, *arguments.slow_work_ms);
    return report(arguments, measure(arguments, consumer));
  }
  Observer observer(arguments.url);
  return report(arguments, measure(arguments, observer));
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app("Plays four heads on LCM and measures how old the answers are.", "ladder_latency");
  app.add_option("--seconds", arguments.seconds, "how long to play")->check(CLI::PositiveNumber);
  app.add_option("--rate_hz", arguments.rate_hz, "frames of each head")->check(CLI::Range(1, 60));
  app.add_option("--slow_work_ms", arguments.slow_work_ms, "be a slow consumer of head 0 instead")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--json", arguments.json_path, "write the figures to this file");
  app.add_option("--url", arguments.url, "LCM provider, default LCM_DEFAULT_URL");
  try {
    app.parse(argc, argv);
    return run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitArguments;
  } catch (const runtime::BusError& error) {
    std::fprintf(stderr, "ladder_latency: %s\n", error.what());
    return kExitDevice;
  }
}
