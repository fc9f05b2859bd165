// SPDX-License-Identifier: BSD-3-Clause
// One depth image of one head as the library sees it: a view of somebody else's pixels with all
// that is needed to place them. Mirrors tof_frame_t; holds no pixels itself.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "tof/pose.h"

namespace tof {

inline constexpr int kNumHeads = 4;
inline constexpr int kMaxSide_px = 1024;

enum class DepthKind : std::uint8_t {
  kUnknown = 0,
  kZ = 1,       ///< distance along the optical axis
  kRadial = 2,  ///< distance along the pixel's ray
};

/// Pinhole model, pixel centres at integers.
struct Intrinsics {
  double fx_px = 0.0, fy_px = 0.0, cx_px = 0.0, cy_px = 0.0;
  bool operator==(const Intrinsics&) const = default;
};

/// depth_mm has width x height elements, row by row from the upper left, 0 = no return;
/// confidence has as many or none, 0 = worthless .. 255 = certain.
struct DepthFrame {
  std::int64_t utime_us = 0;  ///< since the epoch, time of measurement of this head
  std::int64_t seq = 0;       ///< +1 per frame of this head
  int head = 0;               ///< 0..3
  DepthKind depth_kind = DepthKind::kUnknown;
  int width_px = 0, height_px = 0;
  Intrinsics intrinsics;
  double range_min_m = 0.0, range_max_m = 0.0;
  double wrap_range_m = 0.0;  ///< unambiguous range; 0 = distances never repeat
  Pose T_body_head;           ///< head: x right, y down, z forward
  std::span<const std::int16_t> depth_mm;
  std::span<const std::uint8_t> confidence;
};

enum class FrameFault : std::uint8_t {
  kNone,
  kStamp,       ///< utime not positive or seq negative
  kHead,        ///< not 0..3
  kKind,        ///< depth kind unknown
  kSize,        ///< a side outside 1..1024 px
  kPixelCount,  ///< depth or confidence does not have width x height elements
  kIntrinsics,  ///< not finite, or a focal length below 1 px
  kRanges,      ///< not finite, negative, or minimum not below maximum
  kExtrinsics,  ///< not finite, farther than 10 km, or not a rotation
};

/// The first rule that this frame breaks.
FrameFault find_fault(const DepthFrame& frame);

/// The fault in a word, for a log.
const char* name_of(FrameFault fault);

}  // namespace tof
