// SPDX-License-Identifier: BSD-3-Clause
#include "tof/params.h"

#include "base/within.h"
#include "tof/depth_frame.h"

namespace tof {
namespace {

std::string check_filter(const FilterParams& p) {
  if (!base::within(p.min_confidence, 0, 255)) return "filter.min_confidence must be 0..255";
  if (!base::within(p.flying_step_m, 0.001, 10.0)) return "filter.flying_step_m must be 0.001..10";
  if (!base::within(p.flying_step_ratio, 0.0, 0.49))
    return "filter.flying_step_ratio must be 0..0.49";
  if (!base::within(p.white_half_confidence_m, 0.0, 1000.0)) {
    return "filter.white_half_confidence_m must be 0..1000";
  }
  return "";
}

std::string check_heads(const HeadParams& p) {
  if (!base::within(p.period_s, 0.005, 1.0)) return "heads.period_s must be 0.005..1";
  if (!base::within(p.awaited_at_start, 1.0, kNumHeads))
    return "heads.awaited_at_start must be 1..4";
  if (!base::within(p.dead_periods, 1.5, 100.0)) return "heads.dead_periods must be 1.5..100";
  if (!base::within(p.backward_reset_s, 0.0, 3600.0))
    return "heads.backward_reset_s must be 0..3600";
  if (!base::within(p.forward_reset_s, 0.1, 1e6)) return "heads.forward_reset_s must be 0.1..1e6";
  return "";
}

std::string check_gravity(const GravityParams& p) {
  if (!base::within(p.time_constant_s, 0.01, 100.0))
    return "gravity.time_constant_s must be 0.01..100";
  if (!base::within(p.gravity_m_s2, 1.0, 20.0)) return "gravity.gravity_m_s2 must be 1..20";
  if (!(p.trust_m_s2 > 0.0 && p.trust_m_s2 < p.gravity_m_s2)) {
    return "gravity.trust_m_s2 must be above 0 and below gravity.gravity_m_s2";
  }
  if (!base::within(p.max_gap_s, 0.01, 10.0)) return "gravity.max_gap_s must be 0.01..10";
  return "";
}

std::string check_poses(const PoseParams& p) {
  if (!base::within(p.capacity, 2, 100000)) return "poses.capacity must be 2..100000";
  if (!base::within(p.max_gap_s, 0.001, 10.0)) return "poses.max_gap_s must be 0.001..10";
  if (!base::within(p.max_extrapolation_s, 0.0, 10.0))
    return "poses.max_extrapolation_s must be 0..10";
  return "";
}

std::string check_limbs(const LimbParams& p) {
  for (const double length_m : {p.hip_x_m, p.hip_y_m, p.abduction_m, p.thigh_m, p.shank_m}) {
    if (!base::within(length_m, 0.0, 2.0)) return "limbs: every length must be 0..2 m";
  }
  for (const double radius_m : {p.thigh_radius_m, p.shank_radius_m, p.margin_m}) {
    if (!base::within(radius_m, 0.0, 0.3)) return "limbs: radii and margin_m must be 0..0.3";
  }
  if (!base::within(p.wrist_rad, -1.6, 1.6)) return "limbs.wrist_rad must be -1.6..1.6";
  return "";
}

}  // namespace

std::string check(const TofParams& params) {
  const std::string faults[] = {check_filter(params.filter), check_heads(params.heads),
                                check_gravity(params.gravity), check_poses(params.poses),
                                check_limbs(params.limbs)};
  for (const std::string& fault : faults) {
    if (!fault.empty()) return fault;
  }
  if (!base::within(params.max_points, 1, 400000)) return "max_points must be 1..400000";
  return "";
}

}  // namespace tof
