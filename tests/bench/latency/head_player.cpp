// SPDX-License-Identifier: BSD-3-Clause
#include "tests/bench/latency/head_player.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <variant>

#include "runtime/clock.h"
#include "simulator/simulation.h"

namespace bench {
namespace {

constexpr int kNumRounds = 15;

std::vector<HeadPlayer::Round> render(ladder_msgs::imu_t& imu) {
  simulator::SimulationParams params;
  params.start_utime_us = 1;
  simulator::Simulation simulation(params);
  std::vector<HeadPlayer::Round> rounds;
  std::size_t num_frames = 0;
  while (num_frames < kNumRounds * HeadPlayer::kNumHeads) {
    for (const simulator::Message& message : simulation.advance_to(simulation.next_utime_us())) {
      if (const auto* frame = std::get_if<ladder_msgs::tof_frame_t>(&message)) {
        if (num_frames % HeadPlayer::kNumHeads == 0) rounds.emplace_back();
        rounds.back()[static_cast<std::size_t>(frame->head)] = *frame;
        ++num_frames;
      } else if (const auto* sample = std::get_if<ladder_msgs::imu_t>(&message)) {
        imu = *sample;
      }
    }
  }
  return rounds;
}

}  // namespace

HeadPlayer::HeadPlayer(const std::string& url, double rate_hz)
    : bus_(url),
      head_interval_us_(std::lround(1e6 / (rate_hz * static_cast<double>(kNumHeads)))),
      rounds_(render(imu_)) {}

void HeadPlayer::start() {
  thread_ = std::thread([this] { play(); });
}

void HeadPlayer::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

void HeadPlayer::play() {
  const std::int64_t start_us = runtime::clock_now().monotonic_us;
  for (std::int64_t index = 0; !stopping_; ++index) {
    const std::int64_t due_us = start_us + index * head_interval_us_;
    const std::int64_t wait_us = due_us - runtime::clock_now().monotonic_us;
    if (wait_us > 0) std::this_thread::sleep_for(std::chrono::microseconds(wait_us));
    if (wait_us < -2 * head_interval_us_) ++num_late_;
    send(index);
  }
}

void HeadPlayer::send(std::int64_t index) {
  const std::int64_t now_us = runtime::clock_now().utime_us;
  const auto head = static_cast<std::size_t>(index) % kNumHeads;
  const std::int64_t round = index / static_cast<std::int64_t>(kNumHeads);
  imu_.utime = now_us;
  imu_.seq = index;
  bus_.publish(runtime::channels::kImu, imu_);
  auto& frame = rounds_[static_cast<std::size_t>(round) % rounds_.size()][head];
  frame.utime = now_us;
  frame.seq = round;
  bus_.publish(runtime::channels::kTof[head], frame);
  ++num_sent_;
}

}  // namespace bench
