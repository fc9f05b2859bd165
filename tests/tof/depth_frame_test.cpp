// SPDX-License-Identifier: BSD-3-Clause
// What is not a frame is refused with the right word, and never reaches the pixels.
#include "tof/depth_frame.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "tests/tof/frame_builder.h"

namespace {

using tof::FrameFault;
using tof_test::FrameBuilder;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Case {
  const char* name;
  FrameFault expected;
  std::function<void(tof::DepthFrame&)> spoil;
};

const Case kCases[] = {
    {"time zero", FrameFault::kStamp, [](auto& f) { f.utime_us = 0; }},
    {"time negative", FrameFault::kStamp, [](auto& f) { f.utime_us = -5; }},
    {"seq negative", FrameFault::kStamp, [](auto& f) { f.seq = -1; }},
    {"head below", FrameFault::kHead, [](auto& f) { f.head = -1; }},
    {"head above", FrameFault::kHead, [](auto& f) { f.head = 4; }},
    {"kind unknown", FrameFault::kKind, [](auto& f) { f.depth_kind = tof::DepthKind::kUnknown; }},
    {"kind from nowhere", FrameFault::kKind, [](auto& f) { f.depth_kind = tof::DepthKind{9}; }},
    {"zero width", FrameFault::kSize, [](auto& f) { f.width_px = 0; }},
    {"negative height", FrameFault::kSize, [](auto& f) { f.height_px = -3; }},
    {"too wide", FrameFault::kSize, [](auto& f) { f.width_px = 1025; }},
    {"zero-sized", FrameFault::kSize,
     [](auto& f) {
       f.width_px = f.height_px = 0;
       f.depth_mm = {};
     }},
    {"one pixel short", FrameFault::kPixelCount,
     [](auto& f) { f.depth_mm = f.depth_mm.first(f.depth_mm.size() - 1); }},
    {"no pixels", FrameFault::kPixelCount, [](auto& f) { f.depth_mm = {}; }},
    {"sides swapped in size", FrameFault::kPixelCount, [](auto& f) { f.height_px += 1; }},
    {"fx NaN", FrameFault::kIntrinsics, [](auto& f) { f.intrinsics.fx_px = kNaN; }},
    {"fy zero", FrameFault::kIntrinsics, [](auto& f) { f.intrinsics.fy_px = 0.0; }},
    {"cx infinite", FrameFault::kIntrinsics, [](auto& f) { f.intrinsics.cx_px = kInfinity; }},
    {"cy NaN", FrameFault::kIntrinsics, [](auto& f) { f.intrinsics.cy_px = kNaN; }},
    {"range NaN", FrameFault::kRanges, [](auto& f) { f.range_max_m = kNaN; }},
    {"range negative", FrameFault::kRanges, [](auto& f) { f.range_min_m = -0.1; }},
    {"range reversed", FrameFault::kRanges, [](auto& f) { f.range_min_m = 5.0; }},
    {"wrap infinite", FrameFault::kRanges, [](auto& f) { f.wrap_range_m = kInfinity; }},
    {"position NaN", FrameFault::kExtrinsics, [](auto& f) { f.T_body_head.p_m.y() = kNaN; }},
    {"position far", FrameFault::kExtrinsics, [](auto& f) { f.T_body_head.p_m.x() = 1e5; }},
    {"no rotation", FrameFault::kExtrinsics,
     [](auto& f) { f.T_body_head.q = Eigen::Quaterniond(0, 0, 0, 0); }},
    {"rotation NaN", FrameFault::kExtrinsics, [](auto& f) { f.T_body_head.q.w() = kNaN; }},
};

// Every kind of unsound frame is named as what it is.
TEST(DepthFrame, FaultsAreFound) {
  for (const Case& c : kCases) {
    FrameBuilder builder;
    tof::DepthFrame frame = builder.view();
    ASSERT_EQ(tof::find_fault(frame), FrameFault::kNone);
    c.spoil(frame);
    EXPECT_EQ(tof::find_fault(frame), c.expected) << c.name;
    EXPECT_STRNE(tof::name_of(c.expected), "?") << c.name;
  }
}

// Confidence is for every pixel or for none.
TEST(DepthFrame, ConfidenceIsAllOrNothing) {
  FrameBuilder builder;
  EXPECT_EQ(tof::find_fault(builder.view()), FrameFault::kNone);
  builder.confidence.assign(builder.depth_mm.size(), 9);
  EXPECT_EQ(tof::find_fault(builder.view()), FrameFault::kNone);
  builder.confidence.pop_back();
  EXPECT_EQ(tof::find_fault(builder.view()), FrameFault::kPixelCount);
}

// One pixel and the largest image are frames.
TEST(DepthFrame, ExtremeSizesAreSound) {
  EXPECT_EQ(tof::find_fault(FrameBuilder(1, 1, 500).view()), FrameFault::kNone);
  EXPECT_EQ(tof::find_fault(FrameBuilder(1024, 1024, 0).view()), FrameFault::kNone);
}

}  // namespace
