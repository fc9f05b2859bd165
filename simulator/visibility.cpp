// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/visibility.h"

#include <cmath>

namespace simulator {

void RungVisibility::clear() {
  rungs_.assign(rungs_.size(), Seen{});
}

void RungVisibility::add(const LabelledRungs& rungs, const HeadRenderer& head,
                         const Eigen::Isometry3d& T_world_body, const HeadImage& image) {
  const Eigen::Isometry3d T_world_head = T_world_body * head.T_body_head_true();
  for (std::size_t i = 0; i < image.clean_geom.size(); ++i) {
    const int geom = image.clean_geom[i];
    if (geom < 0 || rungs.rung_of_geom[static_cast<std::size_t>(geom)] < 0) continue;
    const int index = rungs.rung_of_geom[static_cast<std::size_t>(geom)];
    const Rung& rung = rungs.scene.rungs[static_cast<std::size_t>(index)];
    ++rungs_[index].hits;
    // A pixel at the rim may hit with its extra rays only; its neighbours stand for the place.
    if (!std::isfinite(image.true_range_m[i])) continue;
    const Eigen::Vector3d hit = T_world_head * (image.true_range_m[i] * head.ray(i)).cast<double>();
    const Eigen::Vector3d axis = rung.end1_m - rung.end0_m;
    const double along = (hit - rung.end0_m).dot(axis) / axis.squaredNorm();
    const auto stretch = static_cast<int>(std::floor(along * kNumStretches));
    if (stretch >= 0 && stretch < kNumStretches) rungs_[index].seen.set(stretch);
  }
}

}  // namespace simulator
