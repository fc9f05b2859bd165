// SPDX-License-Identifier: BSD-3-Clause
#include "tof/cloud.h"

#include <algorithm>

#include "base/check.h"

namespace tof {

void CloudWriter::begin(Cloud& cloud, std::size_t num_points) {
  cloud_ = &cloud;
  num_written_ = 0;
  cloud.x_m.resize(num_points);
  cloud.y_m.resize(num_points);
  cloud.z_m.resize(num_points);
  cloud.head.resize(num_points);
}

void CloudWriter::write(const Image& image, const RayTable& rays, const Placement& placement,
                        RankThinning& thinning) {
  const std::size_t first = num_written_;
  for (int row = 0; row < image.height_px; ++row) {
    const std::int16_t* depth_mm = image.depth_mm + row * image.width_px;
    int num_pixels = 0;
    for (int c = 0; c < image.width_px; ++c) {
      column_[num_pixels] = c;
      depth_mm_[num_pixels] = depth_mm[c];
      num_pixels += thinning.keep(depth_mm[c] != 0);
    }
    CHECK(num_written_ + num_pixels <= cloud_->size(), "thinning keeps what was announced");
    const PointsOut out{cloud_->x_m.data() + num_written_, cloud_->y_m.data() + num_written_,
                        cloud_->z_m.data() + num_written_};
    project_row({row, num_pixels, column_.data(), depth_mm_.data()}, rays, placement, out);
    num_written_ += num_pixels;
  }
  std::fill(cloud_->head.begin() + first, cloud_->head.begin() + num_written_,
            static_cast<std::uint8_t>(image.head));
}

}  // namespace tof
