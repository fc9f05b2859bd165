// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/score/matching.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace simulator {
namespace {

using Eigen::Vector3d;

struct Pair {
  double axis_m = 0.0;
  std::size_t reported = 0;
  std::size_t truth = 0;

  bool operator<(const Pair& other) const {
    return std::tie(axis_m, reported, truth) < std::tie(other.axis_m, other.reported, other.truth);
  }
};

Vector3d direction(const Bar& bar) {
  return (bar.end1_m - bar.end0_m).normalized();
}

/// From the true axis to the reported middle, at a right angle to the axis.
Vector3d off_axis(const Bar& reported, const Bar& truth) {
  const Vector3d axis = direction(truth);
  const Vector3d offset = reported.middle_m() - truth.middle_m();
  return offset - offset.dot(axis) * axis;
}

bool admissible(const Bar& reported, const Bar& truth, const MatchParams& params) {
  const Vector3d axis = direction(truth);
  return off_axis(reported, truth).norm() <= params.max_axis_m &&
         std::abs(direction(reported).dot(axis)) >= params.min_cosine &&
         std::abs((reported.middle_m() - truth.middle_m()).dot(axis)) <= params.max_along_m;
}

std::vector<Pair> admissible_pairs(std::span<const ReportedRung> reported,
                                   std::span<const TrueRung> truth, const MatchParams& params) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < reported.size(); ++i) {
    if (!reported[i].trusted || !reported[i].bar.finite()) continue;
    for (std::size_t j = 0; j < truth.size(); ++j) {
      if (!truth[j].of_ladder || !admissible(reported[i].bar, truth[j].bar, params)) continue;
      pairs.push_back({off_axis(reported[i].bar, truth[j].bar).norm(), i, j});
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

RungErrors errors_of(const ReportedRung& reported, const TrueRung& truth, const Vector3d& robot_m,
                     const MatchParams& params) {
  RungErrors errors;
  const Vector3d axis = direction(truth.bar);
  const Vector3d offset = off_axis(reported.bar, truth.bar);
  Vector3d away = truth.bar.middle_m() - robot_m;
  away.z() = 0.0;
  errors.axis_mm = 1000.0 * offset.norm();
  errors.depth_mm = 1000.0 * offset.dot(away.normalized());
  if (truth.radius_m > 0.0) {
    errors.radius_share = std::abs(reported.radius_m - truth.radius_m) / truth.radius_m;
  }
  const Vector3d reported_axis = direction(reported.bar);
  errors.angle_deg =
      std::atan2(reported_axis.cross(axis).norm(), std::abs(reported_axis.dot(axis))) * 180.0 /
      std::numbers::pi;
  if (truth.visible < params.min_visible_end) return errors;
  const bool same_way = reported_axis.dot(axis) > 0.0;
  const Vector3d& first = same_way ? reported.bar.end0_m : reported.bar.end1_m;
  const Vector3d& second = same_way ? reported.bar.end1_m : reported.bar.end0_m;
  errors.end_mm[0] = 1000.0 * std::abs((first - truth.bar.end0_m).dot(axis));
  errors.end_mm[1] = 1000.0 * std::abs((second - truth.bar.end1_m).dot(axis));
  return errors;
}

/// Elements that every one of the arrays has.
template <class... Vectors>
std::size_t shortest(std::int32_t count, const Vectors&... vectors) {
  return std::min({static_cast<std::size_t>(std::max(count, 0)), vectors.size()...});
}

}  // namespace

bool countable(const TrueRung& rung, const MatchParams& params) {
  return rung.of_ladder && rung.hits >= params.min_hits && rung.visible >= params.min_visible;
}

FrameMatch match(std::span<const ReportedRung> reported, std::span<const TrueRung> truth,
                 const Vector3d& robot_m, const MatchParams& params) {
  FrameMatch result;
  std::vector<bool> reported_taken(reported.size()), truth_taken(truth.size());
  for (const Pair& pair : admissible_pairs(reported, truth, params)) {
    if (reported_taken[pair.reported] || truth_taken[pair.truth]) continue;
    reported_taken[pair.reported] = truth_taken[pair.truth] = true;
    ++result.on_true_rung;
    const TrueRung& rung = truth[pair.truth];
    result.ids.push_back({reported[pair.reported].id, rung.id});
    if (!countable(rung, params)) continue;
    ++result.found;
    if (rung.straight) {
      result.errors.push_back(errors_of(reported[pair.reported], rung, robot_m, params));
    }
  }
  for (const TrueRung& rung : truth) result.countable += countable(rung, params) ? 1 : 0;
  for (std::size_t i = 0; i < reported.size(); ++i) {
    if (reported[i].trusted && !reported_taken[i]) ++result.wrong;
  }
  return result;
}

bool is_reported(std::span<const ReportedRung> reported, const TrueRung& rung,
                 const MatchParams& params) {
  return std::any_of(reported.begin(), reported.end(), [&](const ReportedRung& one) {
    return one.trusted && one.bar.finite() && admissible(one.bar, rung.bar, params);
  });
}

std::vector<ReportedRung> rungs_of(const ladder_msgs::ladder_t& m) {
  std::vector<ReportedRung> rungs(shortest(m.num_rungs, m.rung_id, m.rung_state, m.rung_x0_m,
                                           m.rung_y0_m, m.rung_z0_m, m.rung_x1_m, m.rung_y1_m,
                                           m.rung_z1_m, m.rung_radius_m));
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    rungs[i].bar = {{m.rung_x0_m[i], m.rung_y0_m[i], m.rung_z0_m[i]},
                    {m.rung_x1_m[i], m.rung_y1_m[i], m.rung_z1_m[i]}};
    rungs[i].id = m.rung_id[i];
    rungs[i].radius_m = m.rung_radius_m[i];
    rungs[i].trusted = m.rung_state[i] == ladder_msgs::ladder_t::RUNG_TRUSTED;
  }
  return rungs;
}

std::vector<TrueRung> rungs_of(const ladder_msgs::truth_t& m) {
  using ladder_msgs::truth_t;
  std::vector<TrueRung> rungs(shortest(m.num_rungs, m.rung_id, m.rung_kind, m.rung_x0_m,
                                       m.rung_y0_m, m.rung_z0_m, m.rung_x1_m, m.rung_y1_m,
                                       m.rung_z1_m, m.rung_radius_m, m.rung_hits, m.rung_visible));
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    rungs[i].bar = {{m.rung_x0_m[i], m.rung_y0_m[i], m.rung_z0_m[i]},
                    {m.rung_x1_m[i], m.rung_y1_m[i], m.rung_z1_m[i]}};
    rungs[i].id = m.rung_id[i];
    rungs[i].radius_m = m.rung_radius_m[i];
    rungs[i].sound = m.rung_kind[i] == truth_t::RUNG_SOUND;
    rungs[i].of_ladder = m.is_ladder == 1 && m.rung_kind[i] != truth_t::RUNG_BAR;
    rungs[i].straight = m.rung_kind[i] != truth_t::RUNG_BENT;
    rungs[i].hits = m.rung_hits[i];
    rungs[i].visible = m.rung_visible[i];
  }
  return rungs;
}

std::vector<Bar> rails_of(const ladder_msgs::truth_t& m) {
  std::vector<Bar> rails(shortest(m.num_rails, m.rail_x0_m, m.rail_y0_m, m.rail_z0_m, m.rail_x1_m,
                                  m.rail_y1_m, m.rail_z1_m));
  for (std::size_t i = 0; i < rails.size(); ++i) {
    rails[i] = {{m.rail_x0_m[i], m.rail_y0_m[i], m.rail_z0_m[i]},
                {m.rail_x1_m[i], m.rail_y1_m[i], m.rail_z1_m[i]}};
  }
  return rails;
}

}  // namespace simulator
