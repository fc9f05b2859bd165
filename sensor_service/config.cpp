// SPDX-License-Identifier: BSD-3-Clause
#include "sensor_service/config.h"

#include <array>
#include <string>

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
  table.read("awaited_at_start", params.awaited_at_start);
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

void read(ConfigTable table, tof::LimbParams& params) {
  table.read("drop", params.drop);
  table.read("hip_x_m", params.hip_x_m);
  table.read("hip_y_m", params.hip_y_m);
  table.read("abduction_m", params.abduction_m);
  table.read("thigh_m", params.thigh_m);
  table.read("shank_m", params.shank_m);
  table.read("wrist_rad", params.wrist_rad);
  table.read("thigh_radius_m", params.thigh_radius_m);
  table.read("shank_radius_m", params.shank_radius_m);
  table.read("margin_m", params.margin_m);
}

void read(ConfigTable table, sources::CameraParams& params) {
  table.read("depth_kind", params.depth_kind,
             {{"z", tof::DepthKind::kZ}, {"radial", tof::DepthKind::kRadial}});
  table.read("range_min_m", params.range_min_m);
  table.read("range_max_m", params.range_max_m);
  table.read("wrap_range_m", params.wrap_range_m);
  table.read("frames_per_s", params.frames_per_s);
}

void read(ConfigTable table, sources::V4l2Params& params) {
  using sources::PixelFormat;
  table.read("format", params.format, {{"z16", PixelFormat::kZ16}, {"y16", PixelFormat::kY16}});
  table.read("width_px", params.width_px);
  table.read("height_px", params.height_px);
  table.read("depth_unit_um", params.depth_unit_um);
  table.read("no_return", params.no_return);
}

void read(ConfigTable table, sources::A010Params& params) {
  table.read("binning", params.binning);
  table.read("unit_mm", params.unit_mm);
  table.read("baud", params.baud);
  table.read("output", params.over_usb, {{"usb", true}, {"uart", false}});
  table.read("silence_s", params.silence_s);
}

/// w, x, y, z
void read(ConfigTable table, std::string_view key, Eigen::Quaterniond& q) {
  std::array<double, 4> wxyz{q.w(), q.x(), q.y(), q.z()};
  table.read(key, wxyz);
  q = {wxyz[0], wxyz[1], wxyz[2], wxyz[3]};
}

void read(ConfigTable table, sources::ImuParams& params) {
  table.read("device", params.device);
  table.read("trigger", params.trigger);
  table.read("samples_per_s", params.samples_per_s);
  read(table, "q_body_imu", params.q_body_imu);
  table.read("sysfs", params.sysfs);
  table.read("dev", params.dev);
}

void read(ConfigTable table, sources::HeadParams& params) {
  table.read("device", params.device);
  table.read("fx_px", params.intrinsics.fx_px);
  table.read("fy_px", params.intrinsics.fy_px);
  table.read("cx_px", params.intrinsics.cx_px);
  table.read("cy_px", params.intrinsics.cy_px);
  Eigen::Vector3d& p_m = params.T_body_head.p_m;
  std::array<double, 3> xyz_m{p_m.x(), p_m.y(), p_m.z()};
  table.read("p_body_head_m", xyz_m);
  p_m = {xyz_m[0], xyz_m[1], xyz_m[2]};
  read(table, "q_body_head", params.T_body_head.q);
}

}  // namespace

tof::TofParams read_params(ConfigTable table) {
  tof::TofParams params;
  table.read("max_points", params.max_points);
  read(table.table("filter"), params.filter);
  read(table.table("heads"), params.heads);
  read(table.table("gravity"), params.gravity);
  read(table.table("poses"), params.poses);
  read(table.table("limbs"), params.limbs);
  table.require(check(params));
  return params;
}

sources::SourceParams read_source_params(ConfigTable table) {
  using sources::Kind;
  sources::SourceParams params;
  table.read("source", params.kind,
             {{"lcm", Kind::kLcm}, {"v4l2", Kind::kV4l2}, {"a010", Kind::kA010}});
  read(table.table("camera"), params.camera);
  read(table.table("v4l2"), params.v4l2);
  read(table.table("a010"), params.a010);
  read(table.table("imu"), params.imu);
  for (std::size_t head = 0; head < params.heads.size(); ++head)
    read(table.table("head_" + std::to_string(head)), params.heads[head]);
  table.require(check(params));
  return params;
}

}  // namespace sensor_service
