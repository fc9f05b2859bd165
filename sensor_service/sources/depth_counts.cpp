// SPDX-License-Identifier: BSD-3-Clause
#include "sources/depth_counts.h"

#include <cstddef>
#include <limits>

namespace sources {

bool to_depth_mm(const CountImage& image, const CountScale& scale,
                 std::span<std::int16_t> depth_mm) {
  if (image.width_px < 1 || image.height_px < 1 || image.stride_bytes < 2 * image.width_px)
    return false;
  const auto width = static_cast<std::size_t>(image.width_px);
  const auto height = static_cast<std::size_t>(image.height_px);
  const auto stride = static_cast<std::size_t>(image.stride_bytes);
  if (image.bytes.size() < stride * (height - 1) + 2 * width) return false;
  if (depth_mm.size() != width * height) return false;

  constexpr std::uint64_t kFarthest_mm = std::numeric_limits<std::int16_t>::max();
  const auto unit_um = static_cast<std::uint64_t>(scale.unit_um);
  for (std::size_t row = 0; row < height; ++row) {
    const std::uint8_t* in = image.bytes.data() + row * stride;
    std::int16_t* out = depth_mm.data() + row * width;
    for (std::size_t column = 0; column < width; ++column) {
      const int count = in[2 * column] | (in[2 * column + 1] << 8);
      const std::uint64_t distance_mm = (static_cast<std::uint64_t>(count) * unit_um + 500) / 1000;
      const bool is_measured = count != scale.no_return && distance_mm <= kFarthest_mm;
      out[column] = is_measured ? static_cast<std::int16_t>(distance_mm) : std::int16_t{0};
    }
  }
  return true;
}

}  // namespace sources
