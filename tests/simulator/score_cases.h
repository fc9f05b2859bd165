// SPDX-License-Identifier: BSD-3-Clause
// Truth and reports made by hand: a ladder of three rungs, and what says the right thing about it.
#pragma once

#include <vector>

#include "simulator/score/scorer.h"

namespace simulator {

inline void add_rung(ladder_msgs::truth_t& truth, const Bar& bar, std::int8_t kind, int hits,
                     float visible) {
  truth.rung_id.push_back(truth.num_rungs++);
  truth.rung_kind.push_back(static_cast<std::uint8_t>(kind));
  truth.rung_x0_m.push_back(static_cast<float>(bar.end0_m.x()));
  truth.rung_y0_m.push_back(static_cast<float>(bar.end0_m.y()));
  truth.rung_z0_m.push_back(static_cast<float>(bar.end0_m.z()));
  truth.rung_x1_m.push_back(static_cast<float>(bar.end1_m.x()));
  truth.rung_y1_m.push_back(static_cast<float>(bar.end1_m.y()));
  truth.rung_z1_m.push_back(static_cast<float>(bar.end1_m.z()));
  truth.rung_radius_m.push_back(0.014F);
  truth.rung_hits.push_back(hits);
  truth.rung_visible.push_back(visible);
}

inline Bar rung_at(double height_m) {
  return {{1.0, 0.2, height_m}, {1.0, -0.2, height_m}};
}

/// Rungs at 0.3, 0.6, 0.9 m, all in view, one metre ahead.
inline ladder_msgs::truth_t truth(std::int64_t utime = 100) {
  ladder_msgs::truth_t message{};
  message.utime = utime;
  message.scene = "plain 1";
  message.is_ladder = 1;
  message.q_odom_body[0] = 1.0;
  for (const double z : {0.3, 0.6, 0.9}) {
    add_rung(message, rung_at(z), ladder_msgs::truth_t::RUNG_SOUND, 500, 1.0F);
  }
  message.num_rails = 1;
  message.rail_x0_m = {1.0F};
  message.rail_y0_m = {0.205F};
  message.rail_z0_m = {0.0F};
  message.rail_x1_m = {1.0F};
  message.rail_y1_m = {0.205F};
  message.rail_z1_m = {2.0F};
  message.rail_half_width_m = {0.005F};
  return message;
}

inline ladder_msgs::ladder_t report(const std::vector<Bar>& bars, std::int64_t utime = 100) {
  ladder_msgs::ladder_t message{};
  message.utime = utime;
  message.ladder_state =
      bars.empty() ? ladder_msgs::ladder_t::LADDER_NONE : ladder_msgs::ladder_t::LADDER_CONFIRMED;
  for (const Bar& bar : bars) {
    message.rung_id.push_back(message.num_rungs + 1);
    message.rung_radius_m.push_back(0.014F);
    message.rung_state.push_back(ladder_msgs::ladder_t::RUNG_TRUSTED);
    message.rung_x0_m.push_back(static_cast<float>(bar.end0_m.x()));
    message.rung_y0_m.push_back(static_cast<float>(bar.end0_m.y()));
    message.rung_z0_m.push_back(static_cast<float>(bar.end0_m.z()));
    message.rung_x1_m.push_back(static_cast<float>(bar.end1_m.x()));
    message.rung_y1_m.push_back(static_cast<float>(bar.end1_m.y()));
    message.rung_z1_m.push_back(static_cast<float>(bar.end1_m.z()));
    ++message.num_rungs;
  }
  return message;
}

inline Bar moved(Bar bar, const Eigen::Vector3d& by_m) {
  bar.end0_m += by_m;
  bar.end1_m += by_m;
  return bar;
}

inline std::vector<Bar> perfect() {
  return {rung_at(0.3), rung_at(0.6), rung_at(0.9)};
}

inline Score score_of(const ladder_msgs::truth_t& truth_message,
                      const ladder_msgs::ladder_t& ladder) {
  Scorer scorer;
  scorer.add(truth_message);
  scorer.add(ladder);
  return scorer.result();
}

}  // namespace simulator
