// SPDX-License-Identifier: BSD-3-Clause
// What one frame costs behind the cloud: messages encoded and decoded, DD-GNG, ladder search.
// Budgets: docs/BENCHMARKS.md. tof_bench.cpp has the stage before.
#include <vector>

#include <benchmark/benchmark.h>

#include "base/check.h"
#include "ddgng/ddgng.h"
#include "gng_service/convert.h"
#include "ladder/ladder.h"
#include "ladder_service/convert.h"
#include "tests/bench/frame_times.h"
#include "tests/ddgng/room.h"

namespace {

using ladder_msgs::point_cloud_t;
using ladder_msgs::topology_t;

constexpr int kNumPoints = 60000;
constexpr int kWarmUpFrames = 10;

const ddgng::Room& room() {
  static const ddgng::Room kRoom = ddgng::RoomBuilder(1).build(kNumPoints);
  return kRoom;
}

point_cloud_t cloud_message() {
  const ddgng::CloudView view = room().view(0);
  point_cloud_t message{};
  message.num_points = kNumPoints;
  message.x_m = room().x_m;
  message.y_m = room().y_m;
  message.z_m = room().z_m;
  message.head = room().head;
  message.range_max_m = 4.0F;
  message.pixel_pitch_rad = 0.005F;
  for (int head = 0; head < ddgng::kNumHeads; ++head) {
    message.head_state[head] = point_cloud_t::HEAD_LIVE;
    message.head_x_m[head] = view.head_position_m[head].x();
    message.head_y_m[head] = view.head_position_m[head].y();
    message.head_z_m[head] = view.head_position_m[head].z();
  }
  return message;
}

topology_t topology_message() {
  ddgng::DynamicDensityGng gng{ddgng::DdgngParams{}};
  for (int i = 0; i < kWarmUpFrames; ++i) gng.update(room().view(i));
  topology_t message{};
  gng_service::to_message(gng.topology(), cloud_message(), message);
  return message;
}

void ddgng_stage(benchmark::State& state) {
  ddgng::DdgngParams params;
  params.growing.attention_signals =
      static_cast<int>(state.range(0)) - params.growing.uniform_signals;
  ddgng::DynamicDensityGng gng(params);
  std::uint64_t sequence = 0;
  for (int i = 0; i < kWarmUpFrames; ++i) gng.update(room().view(sequence++));
  bench::FrameTimes times;
  for (auto _ : state) {
    times.start();
    gng.update(room().view(sequence++));
    times.stop();
  }
  times.report(state);
  state.counters["nodes"] = gng.topology().num_nodes();
}

template <class Message>
void codec_stage(benchmark::State& state, const Message& message) {
  const int num_bytes = message.getEncodedSize();
  std::vector<std::uint8_t> bytes(num_bytes);
  Message decoded;
  bench::FrameTimes times;
  for (auto _ : state) {
    times.start();
    CHECK(message.encode(bytes.data(), 0, num_bytes) == num_bytes, "encodes");
    CHECK(decoded.decode(bytes.data(), 0, num_bytes) == num_bytes, "decodes");
    benchmark::DoNotOptimize(decoded);
    times.stop();
  }
  times.report(state);
  state.counters["bytes"] = num_bytes;
}

void ladder_stage(benchmark::State& state, ladder::Mode mode) {
  ladder::LadderParams params;
  params.mode = mode;
  ladder::LadderTracker tracker(params);
  ladder::NodeCloud cloud;
  ladder_service::to_node_cloud(topology_message(), cloud);
  for (int i = 0; i < kWarmUpFrames; ++i) {
    ++cloud.sequence;
    tracker.update(cloud);
  }
  bench::FrameTimes times;
  std::size_t num_rungs = 0;
  for (auto _ : state) {
    ++cloud.sequence;
    times.start();
    num_rungs = tracker.update(cloud).rungs.size();
    times.stop();
  }
  times.report(state);
  state.counters["rungs"] = static_cast<double>(num_rungs);
}

void cloud_codec(benchmark::State& state) {
  codec_stage(state, cloud_message());
}
void topology_codec(benchmark::State& state) {
  codec_stage(state, topology_message());
}

BENCHMARK(cloud_codec)->Name("stage/cloud_codec")->Unit(benchmark::kMillisecond);
BENCHMARK(ddgng_stage)->Name("stage/ddgng")->Arg(5000)->Arg(20000)->Unit(benchmark::kMillisecond);
BENCHMARK(topology_codec)->Name("stage/topology_codec")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ladder_stage, default, ladder::Mode::kDefault)
    ->Name("stage/ladder")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ladder_stage, paper, ladder::Mode::kPaper)
    ->Name("stage/ladder_paper")
    ->Unit(benchmark::kMillisecond);

}  // namespace
