// SPDX-License-Identifier: BSD-3-Clause
#include "tof/depth_frame.h"

#include "base/within.h"

namespace tof {
namespace {

constexpr double kMaxFocalLength_px = 1e5;
constexpr double kMaxRange_m = 1e4;

bool are_sound(const Intrinsics& k) {
  return base::within(k.fx_px, 1.0, kMaxFocalLength_px) &&
         base::within(k.fy_px, 1.0, kMaxFocalLength_px) &&
         base::within(k.cx_px, -kMaxFocalLength_px, kMaxFocalLength_px) &&
         base::within(k.cy_px, -kMaxFocalLength_px, kMaxFocalLength_px);
}

bool are_ranges_sound(const DepthFrame& frame) {
  return base::within(frame.range_min_m, 0.0, kMaxRange_m) &&
         base::within(frame.range_max_m, 0.0, kMaxRange_m) &&
         frame.range_min_m < frame.range_max_m &&
         base::within(frame.wrap_range_m, 0.0, kMaxRange_m);
}

}  // namespace

FrameFault find_fault(const DepthFrame& frame) {
  if (frame.utime_us <= 0 || frame.seq < 0) return FrameFault::kStamp;
  if (frame.head < 0 || frame.head >= kNumHeads) return FrameFault::kHead;
  if (frame.depth_kind != DepthKind::kZ && frame.depth_kind != DepthKind::kRadial) {
    return FrameFault::kKind;
  }
  if (frame.width_px < 1 || frame.width_px > kMaxSide_px || frame.height_px < 1 ||
      frame.height_px > kMaxSide_px) {
    return FrameFault::kSize;
  }
  const auto num_pixels = static_cast<std::size_t>(frame.width_px * frame.height_px);
  if (frame.depth_mm.size() != num_pixels) return FrameFault::kPixelCount;
  if (!frame.confidence.empty() && frame.confidence.size() != num_pixels) {
    return FrameFault::kPixelCount;
  }
  if (!are_sound(frame.intrinsics)) return FrameFault::kIntrinsics;
  if (!are_ranges_sound(frame)) return FrameFault::kRanges;
  if (!is_sound(frame.T_body_head)) return FrameFault::kExtrinsics;
  return FrameFault::kNone;
}

const char* name_of(FrameFault fault) {
  switch (fault) {
    case FrameFault::kNone:
      return "none";
    case FrameFault::kStamp:
      return "stamp";
    case FrameFault::kHead:
      return "head";
    case FrameFault::kKind:
      return "depth kind";
    case FrameFault::kSize:
      return "size";
    case FrameFault::kPixelCount:
      return "pixel count";
    case FrameFault::kIntrinsics:
      return "intrinsics";
    case FrameFault::kRanges:
      return "ranges";
    case FrameFault::kExtrinsics:
      return "extrinsics";
  }
  return "?";
}

}  // namespace tof
