// SPDX-License-Identifier: BSD-3-Clause
// Speed of the growing part: signals per second of thread CPU time at a fixed number of nodes, all
// features on (strength, suspected sampling, utility, ageing, moments), half of the signals from
// one attention box. And the stages of a whole frame.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "ddgng/ddgng.h"
#include "tests/ddgng/room.h"

namespace ddgng {
namespace {

const Room& room() {
  static const Room kRoom = RoomBuilder(1).build(150000);
  return kRoom;
}

bool in_box(const Eigen::Vector3f& p) {
  return std::abs(p.x() - 1.2F) < 0.1F && std::abs(p.y()) < 0.4F && p.z() > 0.1F;
}

std::vector<std::uint32_t> points_in_box(const CloudView& cloud) {
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (in_box({cloud.x_m[i], cloud.y_m[i], cloud.z_m[i]})) indices.push_back(i);
  }
  return indices;
}

/// Rates as in the published comparisons of GNG programs, so that numbers can be set side by side.
GrowingParams bench_params(int num_nodes) {
  GrowingParams params;
  params.uniform_signals = 5000;
  params.attention_signals = 5000;
  params.max_nodes = num_nodes;
  params.max_plane_nodes = num_nodes;
  params.max_boot_nodes = num_nodes;
  params.insertion_interval = 20;
  params.winner_rate = 0.05F;
  params.neighbour_rate = 0.0006F;
  params.max_edge_age = 200;
  params.error_decay = 0.5F / static_cast<float>(num_nodes);  // the memory grows with the graph
  params.utility_decay_outside = params.utility_decay_inside = 0.1F / static_cast<float>(num_nodes);
  return params;
}

/// The loop of Algorithm 1 with a fixed suspected area.
class Loop {
 public:
  explicit Loop(const GrowingParams& params)
      : params_(params),
        sampler_(params),
        growing_(params),
        moments_(params, growing_.graph().padded_slots()),
        cloud_(room().view(0)),
        box_(points_in_box(cloud_)) {
    const std::span<const Signal> two = sampler_.draw_uniform(cloud_, 2);
    growing_.start(two[0].position_m, two[1].position_m);
    for (int frame = 0; frame < 1000 && growing_.graph().num_nodes() < params.max_nodes; ++frame) {
      run_frame();
    }
  }

  int run_frame() {
    sampler_.start_frame(sequence_++);
    for (int i = 0; i < growing_.graph().num_slots(); ++i) {
      if (growing_.graph().alive(i)) growing_.set_inside(i, in_box(growing_.graph().position_m(i)));
    }
    const std::span<const Signal> signals = sampler_.draw(cloud_, box_);
    int num_signals = 0;
    for (const Signal& signal : signals) {
      const Winners winners = growing_.signal(signal.position_m);
      moments_.add(winners.first, signal.head, signal.position_m, winners.first_m2);
      ++num_signals;
      if (num_signals % params_.utility_interval == 0) growing_.remove_useless();
      if (num_signals % params_.insertion_interval == 0) {
        const int slot = growing_.insert(Growing::Weighting::kErrorAndStrength);
        if (slot < 0) continue;
        growing_.set_inside(slot, in_box(growing_.graph().position_m(slot)));
        moments_.clear(slot);
      }
    }
    moments_.forget();
    return num_signals;
  }

  const Growing& growing() const { return growing_; }

 private:
  GrowingParams params_;
  Sampler sampler_;
  Growing growing_;
  Moments moments_;
  CloudView cloud_;
  std::vector<std::uint32_t> box_;
  std::uint64_t sequence_ = 0;
};

void signals(benchmark::State& state) {
  Loop loop(bench_params(static_cast<int>(state.range(0))));
  std::int64_t num_signals = 0;
  for (auto _ : state) num_signals += loop.run_frame();
  state.counters["signals_per_second"] =
      benchmark::Counter(static_cast<double>(num_signals), benchmark::Counter::kIsRate);
  state.counters["nodes"] = loop.growing().graph().num_nodes();
  const WinnerSearch::Counts& counts = loop.growing().search_counts();
  state.counters["linear_share"] =
      static_cast<double>(counts.linear) / static_cast<double>(counts.searches);
}
BENCHMARK(signals)->Name("ddgng")->Arg(500)->Arg(1000)->Arg(2000)->Arg(5000)->Arg(20000);

void frame(benchmark::State& state) {
  DdgngParams params;
  params.growing.attention_signals = static_cast<int>(state.range(0)) - 1000;
  const Room cloud = RoomBuilder(1).build(60000);
  DynamicDensityGng gng(params);
  std::uint64_t sequence = 0;
  for (int i = 0; i < 10; ++i) gng.update(cloud.view(sequence++));
  for (auto _ : state) gng.update(cloud.view(sequence++));
  state.counters["nodes"] = gng.topology().num_nodes();
}
BENCHMARK(frame)->Name("stage/ddgng_update")->Arg(5000)->Arg(20000)->Unit(benchmark::kMillisecond);

void winner_search(benchmark::State& state) {
  Loop loop(bench_params(static_cast<int>(state.range(0))));
  const Graph& graph = loop.growing().graph();
  const Room& points = room();
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        nearest_two_linear(graph, {points.x_m[i], points.y_m[i], points.z_m[i]}));
    i = (i + 1) % points.x_m.size();
  }
}
BENCHMARK(winner_search)->Name("stage/nearest_two_linear")->Arg(500)->Arg(1000)->Arg(5000);

}  // namespace
}  // namespace ddgng
