// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/perception_inbox.h"

#include "runtime/semantic_checks.h"

namespace climb_controller {

using ladder_msgs::ladder_t;
using runtime::Reject;

void RungsSnapshot::reserve() {
  rungs.reserve(ladder_t::MAX_RUNGS);
  stretches.reserve(ladder_t::MAX_INTERVALS);
}

void to_snapshot(const ladder_t& m, RungsSnapshot& snapshot) {
  snapshot.confirmed = m.ladder_state == ladder_t::LADDER_CONFIRMED;
  snapshot.rungs.clear();
  for (std::int32_t i = 0; i < m.num_rungs; ++i) {
    climb::RungView rung;
    rung.id = m.rung_id[i];
    rung.trusted = m.rung_state[i] == ladder_t::RUNG_TRUSTED;
    rung.damaged = m.rung_flags[i] != 0;
    rung.confidence = m.rung_confidence[i];
    rung.end0_m = {m.rung_x0_m[i], m.rung_y0_m[i], m.rung_z0_m[i]};
    rung.end1_m = {m.rung_x1_m[i], m.rung_y1_m[i], m.rung_z1_m[i]};
    rung.radius_m = m.rung_radius_m[i];
    const double xx = m.rung_cov_xx_m2[i], xy = m.rung_cov_xy_m2[i], xz = m.rung_cov_xz_m2[i];
    const double yy = m.rung_cov_yy_m2[i], yz = m.rung_cov_yz_m2[i], zz = m.rung_cov_zz_m2[i];
    rung.covariance_m2 << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    snapshot.rungs.push_back(rung);
  }
  snapshot.stretches.clear();
  for (std::int32_t i = 0; i < m.num_intervals; ++i) {
    if (m.interval_reason[i] != ladder_t::REASON_NONE) continue;
    snapshot.stretches.push_back({m.interval_rung[i], m.interval_from_m[i], m.interval_to_m[i]});
  }
}

Reject RungsInbox::judge(const ladder_t& message, const base::Now& now) {
  if (const Reject verdict = runtime::check_values(message); verdict != Reject::kNone) {
    return verdict;
  }
  const Reject order = runtime::judge_order({message.utime, message.seq}, position_, counts_);
  if (order != Reject::kNone) return order;
  const std::int64_t age_us = now.utime_us - message.utime;
  const bool is_fresh = age_us <= params_.max_age_us && age_us >= -params_.max_ahead_us;
  return is_fresh ? Reject::kNone : Reject::kStale;
}

Reject RungsInbox::accept(const ladder_t& message, const base::Now& now, RungsSnapshot& snapshot) {
  const Reject verdict = judge(message, now);
  if (verdict != Reject::kNone) {
    ++num_refused_;
    return verdict;
  }
  to_snapshot(message, snapshot);
  snapshot.received_us = now.monotonic_us;
  return Reject::kNone;
}

bool ImuInbox::accept(const ladder_msgs::imu_t& message, std::int64_t now_us) {
  const double* a = message.accelerometer_m_s2;
  const double* w = message.gyroscope_rad_s;
  const climb::ImuSample sample{message.utime, {a[0], a[1], a[2]}, {w[0], w[1], w[2]}};
  if (!attitude_.add(sample) || !attitude_.is_known()) return false;
  newest_.reading = {attitude_.q_odom_body(), sample.accelerometer_m_s2.norm(), true};
  newest_.received_us = now_us;
  return true;
}

}  // namespace climb_controller
