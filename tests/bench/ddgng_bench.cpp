// SPDX-License-Identifier: BSD-3-Clause
// Speed of the growing part: signals per second of thread CPU time at a fixed number of nodes, all
// features on (strength, suspected sampling, utility, ageing, moments), half of the signals from
// one attention box. "linear" is the same with the search that looks at every node.
#include <array>
#include <cmath>
#include <map>
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
  params.utility_threshold = 1e9F;  // looked for as ever, hardly found: the number of nodes stands
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
    for (int frame = 0; frame < 100 && growing_.graph().num_nodes() < params.max_nodes; ++frame) {
      run_frame();
    }
  }

  int run_frame() {
    sampler_.start_frame(sequence_++);
    for (int i = 0; i < growing_.graph().num_slots(); ++i) {
      if (growing_.graph().alive(i)) growing_.set_inside(i, in_box(growing_.graph().position_m(i)));
    }
    const std::span<const Signal> signals = sampler_.draw(cloud_, box_);
    const int run = params_.utility_interval;  // divides the insertion interval
    std::array<Winners, 64> winners;
    for (std::size_t begin = 0; begin < signals.size(); begin += run) {
      growing_.signals(signals.subspan(begin), run, winners.data());
      moments_.add(signals.subspan(begin, run), winners.data());
      growing_.remove_useless();
      if ((begin + run) % params_.insertion_interval == 0) insert();
    }
    moments_.forget();
    return static_cast<int>(signals.size());
  }

  void search_linearly() { growing_.search_linearly(); }
  const Growing& growing() const { return growing_; }

 private:
  void insert() {
    const int slot = growing_.insert(Growing::Weighting::kErrorAndStrength);
    if (slot < 0) return;
    growing_.set_inside(slot, in_box(growing_.graph().position_m(slot)));
    moments_.clear(slot);
  }

  GrowingParams params_;
  Sampler sampler_;
  Growing growing_;
  Moments moments_;
  CloudView cloud_;
  std::vector<std::uint32_t> box_;
  std::uint64_t sequence_ = 0;
};

/// Grown once: Google Benchmark calls a benchmark several times.
const Loop& grown(int num_nodes) {
  static std::map<int, Loop> loops;
  return loops.try_emplace(num_nodes, bench_params(num_nodes)).first->second;
}

/// The same with the threshold of the paper's reference 7, at which nodes are removed and others
/// inserted for them all the time.
const Loop& grown_with_removals(int num_nodes) {
  static std::map<int, Loop> loops;
  GrowingParams params = bench_params(num_nodes);
  params.utility_threshold = GrowingParams{}.utility_threshold;
  return loops.try_emplace(num_nodes, params).first->second;
}

/// Mean squared distance of every 50th point to its nearest node.
double quantization_error_mm2(const Graph& graph) {
  const Room& points = room();
  double sum_m2 = 0.0;
  std::size_t num = 0;
  for (std::size_t i = 0; i < points.x_m.size(); i += 50, ++num) {
    sum_m2 += nearest_two_linear(graph, {points.x_m[i], points.y_m[i], points.z_m[i]}).first_m2;
  }
  return 1e6 * sum_m2 / static_cast<double>(num);
}

void each_number_of_nodes(benchmark::internal::Benchmark* benchmark) {
  for (const int num_nodes : {500, 1000, 2000, 5000, 20000}) benchmark->Arg(num_nodes);
}

void signals(benchmark::State& state, bool linear) {
  Loop loop = grown(static_cast<int>(state.range(0)));
  if (linear) loop.search_linearly();
  const WinnerSearch::Counts before = loop.growing().search_counts();
  std::int64_t num_signals = 0;
  for (auto _ : state) num_signals += loop.run_frame();
  state.counters["signals_per_second"] =
      benchmark::Counter(static_cast<double>(num_signals), benchmark::Counter::kIsRate);
  state.counters["nodes"] = loop.growing().graph().num_nodes();
  if (linear) return;
  const WinnerSearch::Counts& after = loop.growing().search_counts();
  state.counters["linear_share"] = static_cast<double>(after.linear - before.linear) /
                                   static_cast<double>(after.searches - before.searches);
}
BENCHMARK_CAPTURE(signals, ddgng, false)->Name("ddgng")->Apply(each_number_of_nodes);
BENCHMARK_CAPTURE(signals, linear, true)->Name("linear")->Apply(each_number_of_nodes);

void signals_with_removals(benchmark::State& state) {
  Loop loop = grown_with_removals(static_cast<int>(state.range(0)));
  const std::int64_t before = loop.growing().counts().removed_by_utility;
  std::int64_t num_signals = 0;
  for (auto _ : state) num_signals += loop.run_frame();
  state.counters["signals_per_second"] =
      benchmark::Counter(static_cast<double>(num_signals), benchmark::Counter::kIsRate);
  state.counters["nodes"] = loop.growing().graph().num_nodes();
  state.counters["removed_per_1000"] =
      1e3 * static_cast<double>(loop.growing().counts().removed_by_utility - before) /
      static_cast<double>(num_signals);
}
BENCHMARK(signals_with_removals)->Name("ddgng_with_removals")->Apply(each_number_of_nodes);

/// Quantization error after 100 000 equal signals, with cells and with the linear search.
void quantization(benchmark::State& state) {
  Loop cells = grown(static_cast<int>(state.range(0)));
  Loop linear = cells;
  linear.search_linearly();
  for (auto _ : state) {
    for (int frame = 0; frame < 10; ++frame) cells.run_frame();
  }
  for (int frame = 0; frame < 10; ++frame) linear.run_frame();
  const double error_mm2 = quantization_error_mm2(cells.growing().graph());
  state.counters["error_mm2"] = error_mm2;
  state.counters["error_to_linear"] = error_mm2 / quantization_error_mm2(linear.growing().graph());
}
BENCHMARK(quantization)->Name("quantization")->Apply(each_number_of_nodes)->Iterations(1);

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
