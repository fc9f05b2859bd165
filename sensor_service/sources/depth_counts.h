// SPDX-License-Identifier: BSD-3-Clause
// From the counts of a depth image to millimetres.
#pragma once

#include <cstdint>
#include <span>

namespace sources {

/// Rows of 16-bit little-endian counts, each `stride_bytes` long.
struct CountImage {
  std::span<const std::uint8_t> bytes;
  int width_px = 0, height_px = 0;
  int stride_bytes = 0;
};

/// What a count means.
struct CountScale {
  int unit_um = 1000;  ///< micrometres per count
  int no_return = 0;   ///< means "nothing measured", as 0 does
};

/// Rounded to the nearest millimetre; 0 where nothing was measured or it is beyond 32.767 m.
/// False, and nothing written, when the image holds fewer bytes than its rows need or depth_mm
/// has not width x height elements.
bool to_depth_mm(const CountImage& image, const CountScale& scale,
                 std::span<std::int16_t> depth_mm);

}  // namespace sources
