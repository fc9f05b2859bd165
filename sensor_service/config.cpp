// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_service/config.h"

namespace sensor_service {
namespace {

using runtime::ConfigTable;

void read(ConfigTable table, tof::FilterParams& params) {
  table.read("min_confidence", params.min_confidence);
  table.read("flying_step_m", params.flying_step_m);
  table.read("flying_step_ratio", params.flying_step_ratio);
  table.read("drop_isolated", params.drop_isolated);
  table.read("white_half_confidence_m", params.white_half_confidence_m);
}

void read(ConfigTable table, tof::HeadParams& params) {
  table.read("period_s", params.period_s);
  table.read("dead_periods", params.dead_periods);
  table.read("backward_reset_s", params.backward_reset_s);
  table.read("forward_reset_s", params.forward_reset_s);
}

void read(ConfigTable table, tof::GravityParams& params) {
  table.read("time_constant_s", params.time_constant_s);
  table.read("gravity_m_s2", params.gravity_m_s2);
  table.read("trust_m_s2", params.trust_m_s2);
  table.read("max_gap_s", params.max_gap_s);
}

void read(ConfigTable table, tof::PoseParams& params) {
  table.read("capacity", params.capacity);
  table.read("max_gap_s", params.max_gap_s);
  table.read("max_extrapolation_s", params.max_extrapolation_s);
}

}  // namespace

tof::TofParams read_params(ConfigTable table) {
  tof::TofParams params;
  table.read("max_points", params.max_points);
  read(table.table("filter"), params.filter);
  read(table.table("heads"), params.heads);
  read(table.table("gravity"), params.gravity);
  read(table.table("poses"), params.poses);
  table.require(check(params));
  return params;
}

}  // namespace sensor_service
