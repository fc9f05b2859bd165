// SPDX-License-Identifier: BSD-3-Clause
// ladder_score: metrics of a recorded log, or of the live messages for some seconds. Exit codes: 0
// scored, 1 nothing to score, 2 wrong arguments or no such file, 3 LCM missing.
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <lcm/lcm-cpp.hpp>
#include <poll.h>

#include "runtime/bus.h"
#include "runtime/channels.h"
#include "simulator/score/report.h"
#include "simulator/score/scorer.h"

namespace {

using simulator::Score;
using simulator::Scorer;

constexpr int kExitNothing = 1;
constexpr int kExitArguments = 2;
constexpr int kExitDevice = 3;

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) {
  stop_requested = 1;
}

struct Arguments {
  std::string log_path;
  bool live = false;
  std::optional<double> seconds;
  std::string json_path;
  std::string url;
};

std::int64_t monotonic_us() {
  using std::chrono::steady_clock;
  return std::chrono::duration_cast<std::chrono::microseconds>(
             steady_clock::now().time_since_epoch())
      .count();
}

/// Decodes a message of this type into the scorer, when the bytes are one.
template <class Msg>
void add_bytes(std::span<const std::uint8_t> bytes, Scorer& scorer) {
  Msg message;
  if (runtime::decode_guarded(bytes, message) == runtime::Reject::kNone) scorer.add(message);
}

/// Every type starts with fingerprint, utime and seq, eight bytes each, big-endian.
std::int64_t big_endian(std::span<const std::uint8_t> bytes, std::size_t offset) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) value = (value << 8) | bytes[offset + i];
  return static_cast<std::int64_t>(value);
}

bool has_one_sender(const std::string& channel) {
  const auto* known = runtime::find_channel(channel);
  return known != nullptr && channel != runtime::channels::kHealth.name &&
         channel != runtime::channels::kEvent.name && channel != runtime::channels::kConfig.name;
}

struct Stream {
  runtime::StreamPosition position;
  runtime::InputCounts counts;
};

/// False when the log cannot be read.
bool read_log(const std::string& path, Scorer& scorer, Score& counts) {
  lcm::LogFile log(path, "r");
  if (!log.good()) return false;
  std::map<std::string, Stream> streams;
  while (const lcm::LogEvent* event = log.readNextEvent()) {
    const std::span bytes(static_cast<const std::uint8_t*>(event->data),
                          static_cast<std::size_t>(event->datalen));
    if (bytes.size() < 24 || !has_one_sender(event->channel)) continue;
    Stream& stream = streams[event->channel];
    ++stream.counts.received;
    runtime::judge_order({big_endian(bytes, 8), big_endian(bytes, 16)}, stream.position,
                         stream.counts);
    if (event->channel == runtime::channels::kTruth.name) {
      add_bytes<ladder_msgs::truth_t>(bytes, scorer);
    } else if (event->channel == runtime::channels::kRungs.name) {
      add_bytes<ladder_msgs::ladder_t>(bytes, scorer);
    } else if (event->channel == runtime::channels::kTopology.name) {
      add_bytes<ladder_msgs::topology_t>(bytes, scorer);
    }
  }
  for (const auto& [channel, stream] : streams) {
    counts.messages[channel] = stream.counts.received;
    counts.messages_lost[channel] = stream.counts.lost;
  }
  return true;
}

/// One line every five seconds, so that a long run is seen to go on.
class Progress {
 public:
  void tell(std::int64_t passed_us, const Scorer& scorer) {
    if (passed_us < next_us_) return;
    next_us_ += kPeriodUs;
    const Score score = scorer.result();
    std::fprintf(stderr, "%4.0f s: %d frames, %d rungs trusted, %d bars besides\n",
                 static_cast<double>(passed_us) * 1e-6, score.frames, score.rungs_confirmed,
                 score.rungs_candidates);
  }

 private:
  static constexpr std::int64_t kPeriodUs = 5'000'000;
  std::int64_t next_us_ = kPeriodUs;
};

void listen(const Arguments& arguments, Scorer& scorer, Score& counts) {
  constexpr std::size_t kCapacity = 64;
  runtime::Bus bus(arguments.url);
  auto& truths = bus.queue(runtime::channels::kTruth, kCapacity);
  auto& ladders = bus.queue(runtime::channels::kRungs, kCapacity);
  auto& topologies = bus.newest(runtime::channels::kTopology);
  std::vector<runtime::Queue<ladder_msgs::tof_frame_t>*> depths;
  depths.reserve(runtime::channels::kTof.size());
  for (const auto& channel : runtime::channels::kTof) {
    depths.push_back(&bus.queue(channel, 16));
  }
  const std::int64_t start_us = monotonic_us();
  const auto over = [&arguments, start_us] {
    const auto passed_us = static_cast<double>(monotonic_us() - start_us);
    return stop_requested != 0 || (arguments.seconds && passed_us >= *arguments.seconds * 1e6);
  };
  Progress progress;
  while (!over()) {
    progress.tell(monotonic_us() - start_us, scorer);
    pollfd readable{bus.file_descriptor(), POLLIN, 0};
    poll(&readable, 1, 50);
    bus.drain();
    const std::int64_t now_us = monotonic_us();
    for (auto* queue : depths) {
      while (const auto* frame = queue->take(now_us)) {
        scorer.depth_frame_received(frame->utime, now_us);
      }
    }
    while (const auto* truth = truths.take(now_us)) scorer.add(*truth);
    while (const auto* ladder = ladders.take(now_us)) {
      scorer.rungs_received(ladder->utime, now_us);
      scorer.add(*ladder);
    }
    if (const auto* topology = topologies.take(now_us)) scorer.add(*topology);
  }
  for (const auto& input : bus.inputs()) {
    counts.messages[input->channel_name] = input->counts.received;
    counts.messages_lost[input->channel_name] = input->counts.lost;
  }
}

int run(const Arguments& arguments) {
  Scorer scorer;
  Score counts;
  if (arguments.live) {
    listen(arguments, scorer, counts);
  } else if (!read_log(arguments.log_path, scorer, counts)) {
    std::fprintf(stderr, "ladder_score: cannot read %s\n", arguments.log_path.c_str());
    return kExitArguments;
  }
  Score score = scorer.result();
  score.messages = counts.messages;
  score.messages_lost = counts.messages_lost;
  std::fputs(to_text(score).c_str(), stdout);
  if (!arguments.json_path.empty()) {
    std::ofstream file(arguments.json_path);
    file << to_json(score);
    if (!file.flush()) {
      std::fprintf(stderr, "ladder_score: cannot write %s\n", arguments.json_path.c_str());
      return kExitArguments;
    }
  }
  if (score.frames == 0) {
    std::fputs("ladder_score: no message on LADDER_RUNGS, nothing to score\n", stderr);
    return kExitNothing;
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGTERM, request_stop);
  std::signal(SIGINT, request_stop);
  Arguments arguments;
  CLI::App app("Compares LADDER_RUNGS with LADDER_TRUTH.", "ladder_score");
  auto* log = app.add_option("--log", arguments.log_path, "LCM log to read");
  auto* live = app.add_flag("--live", arguments.live, "listen instead");
  log->excludes(live);
  app.add_option("--seconds", arguments.seconds, "listen so long; default: until Ctrl-C")
      ->needs(live);
  app.add_option("--json", arguments.json_path, "write the metrics to this file");
  app.add_option("--url", arguments.url, "LCM provider, default LCM_DEFAULT_URL");
  try {
    app.parse(argc, argv);
    if (!arguments.live && arguments.log_path.empty()) {
      std::fputs("ladder_score: --log FILE or --live is needed\n", stderr);
      return kExitArguments;
    }
    return run(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitArguments;
  } catch (const runtime::BusError& error) {
    std::fprintf(stderr, "ladder_score: %s\n", error.what());
    return kExitDevice;
  }
}
