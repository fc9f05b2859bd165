// SPDX-License-Identifier: BSD-3-Clause
// Publishes a sample on every channel: for the jar's test (into a log) and to try scripts/spy.
//   lcmtypes_publish_samples 'file:///tmp/samples.log?mode=w'
//   lcmtypes_publish_samples 'udpm://239.255.76.67:7777?ttl=0' 900 15     rounds, rounds per second
//   ... 900 15 100     the same with 1000 nodes in each topology
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include <lcm/lcm-cpp.hpp>

#include "runtime/channels.h"
#include "tests/lcmtypes/sample_messages.h"

namespace {

using ladder_msgs::tof_frame_t;

constexpr int kWidth_px = 224;
constexpr int kHeight_px = 171;

/// A ladder before a wall, climbed slowly: so that a viewer shows something that can be recognised.
void draw_ladder(tof_frame_t& frame, int round) {
  frame.width_px = kWidth_px;
  frame.height_px = kHeight_px;
  frame.num_pixels = kWidth_px * kHeight_px;
  frame.depth_mm.assign(static_cast<std::size_t>(frame.num_pixels), 2500);
  frame.num_confidence = 0;
  frame.confidence.clear();
  for (int y = 0; y < kHeight_px; ++y) {
    for (int x = 0; x < kWidth_px; ++x) {
      const bool is_rail = (x > 50 && x < 60) || (x > 164 && x < 174);
      const bool is_rung = (y + round) % 50 < 6 && x >= 60 && x <= 164;
      const bool is_shadow = x >= 174 && x < 180;
      std::int16_t& depth_mm = frame.depth_mm[y * kWidth_px + x];
      if (is_rail || is_rung) depth_mm = 900;
      if (is_shadow) depth_mm = 0;
    }
  }
}

struct Round {
  int number = 0;
  int size = 8;  ///< as in sample_messages.h
};

template <class Msg>
bool publish(lcm::LCM& bus, const runtime::Channel<Msg>& channel, const Round& round) {
  Msg message = lcmtypes::sample<Msg>(round.size, static_cast<std::uint64_t>(round.number));
  message.seq = round.number;
  if constexpr (std::is_same_v<Msg, tof_frame_t>) draw_ladder(message, round.number);
  return bus.publish(channel.name, &message) == 0;
}

bool publish_small(lcm::LCM& bus, const Round& round) {
  namespace channels = runtime::channels;
  return publish(bus, channels::kImu, round) && publish(bus, channels::kPose, round) &&
         publish(bus, channels::kCloud, round) && publish(bus, channels::kTopology, round) &&
         publish(bus, channels::kRungs, round) && publish(bus, channels::kHealth, round) &&
         publish(bus, channels::kEvent, round) && publish(bus, channels::kConfig, round) &&
         publish(bus, channels::kCommand, round) && publish(bus, channels::kClimb, round) &&
         publish(bus, channels::kTruth, round);
}

/// One round: the heads a quarter of the period apart, as on the robot.
bool publish_round(lcm::LCM& bus, const Round& round,
                   std::chrono::duration<double> quarter_period) {
  if (!publish_small(bus, round)) return false;
  for (const auto& channel : runtime::channels::kTof) {
    if (!publish(bus, channel, round)) return false;
    std::this_thread::sleep_for(quarter_period);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: %s LCM_URL [rounds] [rounds per second] [size]\n", argv[0]);
    return 2;
  }
  lcm::LCM bus(argv[1]);
  if (!bus.good()) return 3;
  const int rounds = argc > 2 ? std::stoi(argv[2]) : 1;
  const double rate_hz = argc > 3 ? std::stod(argv[3]) : 0.0;
  const std::chrono::duration<double> quarter_period(rate_hz > 0.0 ? 0.25 / rate_hz : 0.0);
  Round round;
  if (argc > 4) round.size = std::stoi(argv[4]);
  for (; round.number < rounds; ++round.number) {
    if (!publish_round(bus, round, quarter_period)) return 1;
  }
  return 0;
}
