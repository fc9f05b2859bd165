// SPDX-License-Identifier: BSD-3-Clause
// What one cloud of four heads costs: filter, projection, fusion, bound. Budget: 1.5 ms
// (docs/BENCHMARKS.md).
#include <array>
#include <vector>

#include <benchmark/benchmark.h>

#include "base/rng.h"
#include "tests/bench/frame_times.h"
#include "tof/fusion.h"

namespace {

constexpr int kWidth = 224;
constexpr int kHeight = 171;
constexpr int kNumPixels = kWidth * kHeight;
constexpr std::int64_t kPeriod_us = 66667;

/// A wall 1.5 m away with rungs before it, noise 1 %, 3 % of the pixels without return.
struct Scene {
  Scene() {
    base::Rng rng(1);
    for (int i = 0; i < kNumPixels; ++i) {
      const double distance_mm = (i / kWidth) % 40 < 6 ? 1200.0 : 1500.0;
      const double noisy_mm = distance_mm * (1.0 + 0.01 * rng.gaussian());
      depth_mm[i] = static_cast<std::int16_t>(rng.uniform() < 0.03 ? 0.0 : noisy_mm);
    }
  }
  std::vector<std::int16_t> depth_mm = std::vector<std::int16_t>(kNumPixels);
  std::vector<std::uint8_t> confidence = std::vector<std::uint8_t>(kNumPixels, 200);
};

tof::DepthFrame frame_of(const Scene& scene, int head, tof::DepthKind kind, double wrap_range_m) {
  tof::DepthFrame frame;
  frame.head = head;
  frame.depth_kind = kind;
  frame.width_px = kWidth;
  frame.height_px = kHeight;
  frame.intrinsics = {186.4, 206.4, 111.5, 85.0};
  frame.range_min_m = 0.1;
  frame.range_max_m = 4.0;
  frame.wrap_range_m = wrap_range_m;
  frame.T_body_head.q = Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5);
  frame.depth_mm = scene.depth_mm;
  frame.confidence = scene.confidence;
  return frame;
}

void quad_frame(benchmark::State& state, tof::DepthKind kind, double wrap_range_m) {
  const Scene scene;
  tof::TofParams params;
  params.max_points = static_cast<int>(state.range(0));
  tof::Fusion fusion(params);
  std::int64_t utime_us = 1'000'000;
  std::int64_t seq = 0;
  std::size_t num_points = 0;
  bench::FrameTimes times;
  for (auto _ : state) {
    times.start();
    const tof::ImuSample imu{utime_us, {0.0, 0.0, 9.81}, {0.0, 0.0, 0.0}};
    benchmark::DoNotOptimize(fusion.add_imu(imu));
    for (int head = 0; head < tof::kNumHeads; ++head) {
      tof::DepthFrame frame = frame_of(scene, head, kind, wrap_range_m);
      frame.utime_us = utime_us + head * kPeriod_us / 4;
      frame.seq = seq;
      const auto result = fusion.add_frame(frame);
      if (!result.clouds.empty()) num_points = result.clouds.front().size();
    }
    times.stop();
    utime_us += kPeriod_us;
    ++seq;
  }
  times.report(state);
  state.counters["points"] = static_cast<double>(num_points);
  state.counters["pixels"] = tof::kNumHeads * kNumPixels;
}

void filter_alone(benchmark::State& state) {
  const Scene scene;
  tof::DepthFrame frame = frame_of(scene, 0, tof::DepthKind::kZ, 0.0);
  frame.utime_us = 1;
  tof::Filter filter{tof::FilterParams{}};
  tof::FilteredImage image;
  for (auto _ : state) {
    filter.apply(frame, image);
    benchmark::DoNotOptimize(image.num_kept);
  }
}

}  // namespace

BENCHMARK_CAPTURE(quad_frame, z, tof::DepthKind::kZ, 0.0)
    ->Name("stage/tof")
    ->Arg(60000)
    ->Arg(400000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(quad_frame, radial, tof::DepthKind::kRadial, 0.0)
    ->Name("stage/tof_radial")
    ->Arg(60000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(quad_frame, radial_wrap, tof::DepthKind::kRadial, 4.5)
    ->Name("stage/tof_wrap")
    ->Arg(60000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(filter_alone)->Name("stage/tof_filter")->Unit(benchmark::kMicrosecond);
