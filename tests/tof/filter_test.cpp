// SPDX-License-Identifier: BSD-3-Clause
// The filter against its own definition, pixel by pixel in double precision, and against scenes
// whose answer is known.
#include "tof/filter.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "tests/tof/frame_builder.h"

namespace {

using tof_test::FrameBuilder;

/// The definition in filter.h, read literally.
class LiteralFilter {
 public:
  LiteralFilter(const tof::DepthFrame& frame, const tof::FilterParams& params)
      : frame_(frame), params_(params) {}

  int kept(int row, int column) const {
    const int d = gated(row, column);
    if (d == 0) return 0;
    const int step = std::max(static_cast<int>(std::lround(params_.flying_step_m * 1000.0)),
                              d * static_cast<int>(params_.flying_step_ratio * 65536 + .5) / 65536);
    bool is_nearer = false;
    bool is_farther = false;
    bool is_close = false;
    const int offsets[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    for (const auto& offset : offsets) {
      const int n = gated(row + offset[0], column + offset[1]);
      if (n == 0) continue;
      is_nearer |= n < d - step;
      is_farther |= n > d + step;
      is_close |= std::abs(n - d) <= step;
    }
    if (is_nearer && is_farther) return 0;
    return is_close || !params_.drop_isolated ? d : 0;
  }

 private:
  int gated(int row, int column) const {
    if (row < 0 || column < 0 || row >= frame_.height_px || column >= frame_.width_px) return 0;
    const int i = row * frame_.width_px + column;
    const int d = frame_.depth_mm[i];
    if (d < 1 || d < std::lround(frame_.range_min_m * 1000.0)) return 0;
    if (d > std::lround(frame_.range_max_m * 1000.0)) return 0;
    const bool wraps = frame_.wrap_range_m > 0.0;
    if (wraps && d >= std::lround(frame_.wrap_range_m * 1000.0)) return 0;
    if (frame_.confidence.empty()) return d;
    if (frame_.confidence[i] < params_.min_confidence) return 0;
    if (!wraps || params_.white_half_confidence_m == 0.0) return d;
    const float far_m = static_cast<float>(d) * 0.001F + static_cast<float>(frame_.wrap_range_m);
    const float half_m = static_cast<float>(params_.white_half_confidence_m);
    const float half_m2 = half_m * half_m;
    const float strength = static_cast<float>(frame_.confidence[i]) * (half_m2 + far_m * far_m);
    return strength <= 255.0F * half_m2 ? 0 : d;
  }

  const tof::DepthFrame& frame_;
  tof::FilterParams params_;
};

void expect_literal(FrameBuilder& builder, const tof::FilterParams& params, tof::Filter& filter) {
  const tof::DepthFrame frame = builder.view();
  tof::FilteredImage image;
  filter.apply(frame, image);
  const LiteralFilter literal(frame, params);
  int num_kept = 0;
  ASSERT_EQ(image.depth_mm.size(), frame.depth_mm.size());
  for (int row = 0; row < frame.height_px; ++row) {
    for (int column = 0; column < frame.width_px; ++column) {
      const int expected = literal.kept(row, column);
      num_kept += expected != 0;
      ASSERT_EQ(image.depth_mm[row * frame.width_px + column], expected)
          << row << ' ' << column << " of " << frame.width_px << 'x' << frame.height_px;
    }
  }
  EXPECT_EQ(image.num_kept, num_kept);
}

/// Surfaces at random depths with noise, holes and extremes, in sizes that leave odd remainders.
FrameBuilder random_frame(base::Rng& rng, bool has_confidence) {
  FrameBuilder builder(1 + static_cast<int>(rng.below(70)), 1 + static_cast<int>(rng.below(9)), 0);
  const int base_mm = 100 + static_cast<int>(rng.below(5000));
  for (auto& d : builder.depth_mm) {
    const int surface_mm = base_mm + 60 * static_cast<int>(rng.below(4));
    d = static_cast<std::int16_t>(surface_mm + static_cast<int>(rng.below(20)));
    const auto odd = rng.below(40);
    if (odd < 6) d = 0;
    if (odd == 6) d = 32767;
    if (odd == 7) d = -1;
    if (odd == 8) d = -32768;
    if (odd == 9) d = 1;
  }
  if (has_confidence) {
    builder.confidence.resize(builder.depth_mm.size());
    for (auto& c : builder.confidence) c = static_cast<std::uint8_t>(rng.below(256));
  }
  return builder;
}

// Any image, with and without confidence and wrapping, gives what the definition gives; the filter
// carries nothing over from one image to the next.
TEST(Filter, AgreesWithItsDefinition) {
  base::Rng rng(7);
  tof::FilterParams variants[4];
  variants[1].min_confidence = 100;
  variants[2].drop_isolated = false;
  variants[2].flying_step_ratio = 0.0;
  variants[3].flying_step_m = 0.001;
  variants[3].flying_step_ratio = 0.49;
  variants[3].white_half_confidence_m = 0.0;
  for (const auto& params : variants) {
    tof::Filter filter(params);
    for (int i = 0; i < 300; ++i) {
      FrameBuilder builder = random_frame(rng, i % 2 == 0);
      builder.frame.wrap_range_m = i % 3 == 0 ? 2.49 : 0.0;
      builder.frame.range_min_m = i % 5 == 0 ? 0.0 : 0.1;
      builder.frame.range_max_m = i % 7 == 0 ? 60.0 : 4.0;
      expect_literal(builder, params, filter);
    }
  }
}

int num_kept(FrameBuilder& builder, const tof::FilterParams& params = {}) {
  tof::Filter filter(params);
  tof::FilteredImage image;
  filter.apply(builder.view(), image);
  return image.num_kept;
}

// Nothing returned: nothing kept.
TEST(Filter, EmptyImage) {
  FrameBuilder builder(224, 171, 0);
  EXPECT_EQ(num_kept(builder), 0);
}

// All at the largest number: beyond the range, all dropped; within it (a 40 m head) all kept.
TEST(Filter, SaturatedImage) {
  FrameBuilder builder(20, 10, 32767);
  EXPECT_EQ(num_kept(builder), 0);
  builder.frame.range_max_m = 40.0;
  EXPECT_EQ(num_kept(builder), 200);
}

// A lone pixel has no neighbour that agrees with it.
TEST(Filter, OnePixel) {
  FrameBuilder builder(1, 1, 1000);
  EXPECT_EQ(num_kept(builder), 0);
  tof::FilterParams params;
  params.drop_isolated = false;
  EXPECT_EQ(num_kept(builder, params), 1);
}

// Both ends of the range belong to it.
TEST(Filter, RangeIsInclusive) {
  const std::pair<int, int> expected[] = {{99, 0}, {100, 12}, {4000, 12}, {4001, 0}};
  for (const auto& [depth_mm, count] : expected) {
    FrameBuilder builder(4, 3, static_cast<std::int16_t>(depth_mm));
    EXPECT_EQ(num_kept(builder), count) << depth_mm;
  }
}

// A pixel half way between a rung and the wall behind it is flying; rung and wall stay.
TEST(Filter, FlyingPixelsGo) {
  FrameBuilder builder(3, 9, 1500);
  for (int column = 0; column < 3; ++column) {
    builder.at(3, column) = 1350;
    builder.at(4, column) = builder.at(5, column) = 1200;
  }
  EXPECT_EQ(num_kept(builder), 24);
}

// A plain edge, however high, loses nothing: one side of each pixel is its own surface.
TEST(Filter, EdgesStay) {
  FrameBuilder builder(6, 6, 1500);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 6; ++column) builder.at(row, column) = 700;
  }
  EXPECT_EQ(num_kept(builder), 36);
}

// The step grows with distance: 120 mm between rows is a slope at 3.5 m and flying at 1 m.
TEST(Filter, StepScalesWithDistance) {
  for (const int base_mm : {1000, 3500}) {
    FrameBuilder builder(5, 5, 0);
    for (int row = 0; row < 5; ++row) {
      for (int column = 0; column < 5; ++column) {
        builder.at(row, column) = static_cast<std::int16_t>(base_mm + 120 * row);
      }
    }
    EXPECT_EQ(num_kept(builder), base_mm == 1000 ? 10 : 25) << base_mm;
  }
}

/// What a head reports of a surface of this reflectance (white = 1).
std::uint8_t confidence_of(double reflectance, double distance_m) {
  const double half_m = tof::FilterParams{}.white_half_confidence_m;
  const double fading = distance_m * distance_m / (half_m * half_m);
  return static_cast<std::uint8_t>(255.0 * reflectance / (reflectance + fading));
}

// A wall one wrap farther looks near but is dim, however bright it is; a dark rung at that distance
// is brighter. Without confidence it cannot be told and is believed.
TEST(Filter, WrappedWallIsDimmerThanATrueRung) {
  const double wrap_m = 2.49;
  for (const double shown_m : {0.3, 0.7, 1.0, 1.4}) {
    FrameBuilder builder(6, 6, static_cast<std::int16_t>(1000.0 * shown_m));
    builder.frame.wrap_range_m = wrap_m;
    builder.confidence.assign(36, confidence_of(1.0, shown_m + wrap_m));
    EXPECT_EQ(num_kept(builder), 0) << shown_m;
    builder.confidence.assign(36, confidence_of(0.2, shown_m));
    EXPECT_EQ(num_kept(builder), 36) << shown_m;
    builder.confidence.clear();
    EXPECT_EQ(num_kept(builder), 36) << shown_m;
  }
}

// A single-frequency mode never shows a distance beyond its wrap range.
TEST(Filter, BeyondTheWrapRangeIsNoise) {
  FrameBuilder builder(6, 6, 2490);
  builder.frame.wrap_range_m = 2.49;
  EXPECT_EQ(num_kept(builder), 0);
}

}  // namespace
