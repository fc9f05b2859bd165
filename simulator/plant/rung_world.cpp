// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/rung_world.h"

#include <algorithm>

#include "base/check.h"

namespace simulator {

std::vector<LadderRung> straight_ladder(const LadderParams& params) {
  std::vector<LadderRung> rungs;
  for (int i = 1; i <= params.num_rungs; ++i) {
    LadderRung rung;
    rung.end0_m = {0.0, -params.half_width_m, params.spacing_m * i};
    rung.end1_m = {0.0, params.half_width_m, params.spacing_m * i};
    rung.radius_m = params.rung_radius_m;
    rungs.push_back(rung);
  }
  return rungs;
}

NearestRung RungWorld::nearest(const Eigen::Vector3d& p_world_m) const {
  NearestRung best;
  for (int i = 0; i < num_rungs(); ++i) {
    const LadderRung& candidate = rung(i);
    if (candidate.broken) continue;
    const Eigen::Vector3d along = candidate.end1_m - candidate.end0_m;
    const double length_m2 = std::max(along.squaredNorm(), 1e-12);
    const double share =
        std::clamp((p_world_m - candidate.end0_m).dot(along) / length_m2, 0.0, 1.0);
    const Eigen::Vector3d point = candidate.end0_m + share * along;
    const double distance = (p_world_m - point).norm();
    if (distance < best.distance_m) best = {i, point, distance};
  }
  return best;
}

void RungWorld::update(std::int64_t now_us, std::span<const double> load_N,
                       std::span<const char> touched) {
  CHECK(load_N.size() == rungs_.size() && touched.size() == rungs_.size(), "one value per rung");
  for (std::size_t i = 0; i < rungs_.size(); ++i) {
    LadderRung& rung = rungs_[i];
    const bool breaks = now_us >= rung.break_at_us || load_N[i] > rung.break_load_N ||
                        (rung.break_on_touch && touched[i] != 0);
    if (breaks) rung.broken = true;
  }
}

}  // namespace simulator
