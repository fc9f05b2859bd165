// SPDX-License-Identifier: BSD-3-Clause
// The loops over columns are written without branches and in 16-bit lanes, so that compilers turn
// them into vector instructions for any CPU; the arithmetic is exact, so the bits agree.
#include "tof/filter.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"

namespace tof {
namespace {

constexpr int kMaxDepth_mm = 32767;

int to_mm(double metres) {
  return static_cast<int>(std::clamp(std::floor(metres * 1000.0 + 0.5), 0.0, 1.0 * kMaxDepth_mm));
}

struct Gates {
  std::int16_t min_mm = 1, max_mm = kMaxDepth_mm;
  int min_confidence = 0;
};

void gate_range(const std::int16_t* depth_mm, int width, const Gates& gates,
                std::int16_t* gated_mm) {
  const std::int16_t low = gates.min_mm;
  const std::int16_t high = gates.max_mm;
  for (int c = 0; c < width; ++c) {
    const std::int16_t d = depth_mm[c];
    gated_mm[c] = static_cast<std::int16_t>(d >= low && d <= high ? d : 0);
  }
}

void gate_confidence(const std::uint8_t* confidence, int width, int min_confidence,
                     std::int16_t* gated_mm) {
  for (int c = 0; c < width; ++c) {
    gated_mm[c] = static_cast<std::int16_t>(confidence[c] >= min_confidence ? gated_mm[c] : 0);
  }
}

/// A wrapped echo of the brightest surface has confidence <= 255 / (1 + ((r + wrap) / half)^2).
void gate_wrapped(const std::uint8_t* confidence, int width, float wrap_m, float half_m,
                  std::int16_t* gated_mm) {
  const float half_m2 = half_m * half_m;
  for (int c = 0; c < width; ++c) {
    const float far_m = static_cast<float>(gated_mm[c]) * 0.001F + wrap_m;
    const float needed = 255.0F * half_m2;
    const bool is_bright = static_cast<float>(confidence[c]) * (half_m2 + far_m * far_m) > needed;
    gated_mm[c] = static_cast<std::int16_t>(is_bright ? gated_mm[c] : 0);
  }
}

/// The step beyond which two neighbours are different surfaces.
struct Step {
  std::int16_t base_mm = 0;
  std::int16_t ratio_65536 = 0;  ///< of the depth, in 1/65536

  std::int16_t of(std::int16_t depth_mm) const {
    const auto grown = static_cast<std::int16_t>((depth_mm * ratio_65536) >> 16);
    return std::max(base_mm, grown);
  }
};

/// Three neighbouring rows of the gated image, each readable from column -1 to width.
struct Rows {
  const std::int16_t* above;
  const std::int16_t* here;
  const std::int16_t* below;
};

/// Depth of a neighbour, or `d` where there is no return: such a neighbour proves no step.
std::int16_t present(std::int16_t neighbor_mm, std::int16_t d) {
  return neighbor_mm != 0 ? neighbor_mm : d;
}

std::int16_t difference(std::int16_t a, std::int16_t b) {
  return static_cast<std::int16_t>(a - b);  // both 0..32767: fits
}

bool is_close(std::int16_t neighbor_mm, std::int16_t d, std::int16_t step) {
  const std::int16_t gap = difference(neighbor_mm, d);
  const auto size = static_cast<std::int16_t>(gap < 0 ? -gap : gap);
  return neighbor_mm != 0 && size <= step;
}

template <bool kDropIsolated>
int drop_edges_in_row(const Rows& rows, int width, Step step, std::int16_t* kept_mm) {
  int num_kept = 0;
  for (int c = 0; c < width; ++c) {
    const std::int16_t d = rows.here[c];
    const std::int16_t left = rows.here[c - 1];
    const std::int16_t right = rows.here[c + 1];
    const std::int16_t up = rows.above[c];
    const std::int16_t down = rows.below[c];
    const std::int16_t t = step.of(d);
    const std::int16_t nearest = std::min(std::min(present(left, d), present(right, d)),
                                          std::min(present(up, d), present(down, d)));
    const std::int16_t farthest = std::max(std::max(present(left, d), present(right, d)),
                                           std::max(present(up, d), present(down, d)));
    bool keep = difference(d, nearest) <= t || difference(farthest, d) <= t;
    if constexpr (kDropIsolated) {
      keep = keep && (is_close(left, d, t) || is_close(right, d, t) || is_close(up, d, t) ||
                      is_close(down, d, t));
    }
    kept_mm[c] = static_cast<std::int16_t>(keep ? d : 0);
  }
  for (int c = 0; c < width; ++c) num_kept += kept_mm[c] != 0;
  return num_kept;
}

}  // namespace

Filter::Filter(const FilterParams& params) : params_(params) {}

void Filter::apply(const DepthFrame& frame, FilteredImage& result) {
  CHECK(find_fault(frame) == FrameFault::kNone, "only sound frames are filtered");
  gate(frame);
  drop_edges(frame, result);
}

void Filter::gate(const DepthFrame& frame) {
  const int width = frame.width_px;
  const int height = frame.height_px;
  const int stride = width + 2;
  gated_mm_.resize(static_cast<std::size_t>(stride * (height + 2)));
  std::fill_n(gated_mm_.begin(), stride, std::int16_t{0});
  std::fill_n(gated_mm_.begin() + stride * (height + 1), stride, std::int16_t{0});

  const bool wraps = frame.wrap_range_m > 0.0;
  Gates gates;
  gates.min_mm = static_cast<std::int16_t>(std::max(1, to_mm(frame.range_min_m)));
  const int max_mm = to_mm(frame.range_max_m);
  gates.max_mm =
      static_cast<std::int16_t>(wraps ? std::min(max_mm, to_mm(frame.wrap_range_m) - 1) : max_mm);
  const bool tells_wrapped = wraps && params_.white_half_confidence_m > 0.0;

  for (int row = 0; row < height; ++row) {
    std::int16_t* gated = gated_mm_.data() + (row + 1) * stride + 1;
    gated[-1] = gated[width] = 0;
    gate_range(frame.depth_mm.data() + row * width, width, gates, gated);
    if (frame.confidence.empty()) continue;
    const std::uint8_t* confidence = frame.confidence.data() + row * width;
    gate_confidence(confidence, width, params_.min_confidence, gated);
    if (tells_wrapped) {
      gate_wrapped(confidence, width, static_cast<float>(frame.wrap_range_m),
                   static_cast<float>(params_.white_half_confidence_m), gated);
    }
  }
}

void Filter::drop_edges(const DepthFrame& frame, FilteredImage& result) const {
  const int width = frame.width_px;
  const int stride = width + 2;
  result.depth_mm.resize(frame.depth_mm.size());
  result.num_kept = 0;
  Step step;
  step.base_mm = static_cast<std::int16_t>(to_mm(params_.flying_step_m));
  step.ratio_65536 = static_cast<std::int16_t>(params_.flying_step_ratio * 65536.0 + 0.5);
  const auto drop = params_.drop_isolated ? drop_edges_in_row<true> : drop_edges_in_row<false>;
  for (int row = 0; row < frame.height_px; ++row) {
    const std::int16_t* here = gated_mm_.data() + (row + 1) * stride + 1;
    const Rows rows{here - stride, here, here + stride};
    result.num_kept += drop(rows, width, step, result.depth_mm.data() + row * width);
  }
}

}  // namespace tof
