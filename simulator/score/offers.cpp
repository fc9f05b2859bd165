// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/score/offers.h"

#include <algorithm>

namespace simulator {
namespace {

using Eigen::Vector3d;

bool is_on(const Vector3d& place_m, const TrueRung& rung, const OfferParams& params) {
  const Vector3d span = rung.bar.end1_m - rung.bar.end0_m;
  const double length_m = span.norm();
  if (!place_m.allFinite() || !(length_m > 0.0)) return false;
  const Vector3d offset = place_m - rung.bar.end0_m;
  const double along_m = offset.dot(span) / length_m;
  const double across_m = (offset - along_m / length_m * span).norm();
  return across_m <= params.max_axis_m && along_m >= params.claw_width_m &&
         along_m <= length_m - params.claw_width_m;
}

}  // namespace

std::vector<Offer> offers_of(const ladder_msgs::ladder_t& m) {
  std::vector<Offer> offers;
  const std::vector<ReportedRung> rungs = rungs_of(m);
  const std::size_t num_intervals = std::min({m.interval_rung.size(), m.interval_from_m.size(),
                                              m.interval_to_m.size(), m.interval_reason.size()});
  for (std::size_t i = 0; i < num_intervals; ++i) {
    const auto rung = static_cast<std::size_t>(m.interval_rung[i]);
    if (m.interval_reason[i] != ladder_msgs::ladder_t::REASON_NONE || rung >= rungs.size()) {
      continue;
    }
    const Bar& bar = rungs[rung].bar;
    const Vector3d direction = (bar.end1_m - bar.end0_m).normalized();
    offers.push_back({bar.end0_m + m.interval_from_m[i] * direction,
                      bar.end0_m + m.interval_to_m[i] * direction});
  }
  const std::size_t num_grasps =
      std::min({m.grasp_x_m.size(), m.grasp_y_m.size(), m.grasp_z_m.size()});
  for (std::size_t i = 0; i < num_grasps; ++i) {
    const Vector3d place_m(m.grasp_x_m[i], m.grasp_y_m[i], m.grasp_z_m[i]);
    offers.push_back({place_m, place_m});
  }
  return offers;
}

bool is_safe(const Offer& offer, std::span<const TrueRung> truth, const OfferParams& params) {
  return std::any_of(truth.begin(), truth.end(), [&](const TrueRung& rung) {
    return rung.of_ladder && rung.sound && is_on(offer.from_m, rung, params) &&
           is_on(offer.to_m, rung, params);
  });
}

}  // namespace simulator
