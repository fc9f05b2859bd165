// SPDX-License-Identifier: BSD-3-Clause
#include "sources/params.h"

#include "sources/serial_line.h"

namespace sources {
namespace {

bool is_within(int value, int low, int high) {
  return value >= low && value <= high;
}

std::string check(const CameraParams& params) {
  if (!(params.range_min_m >= 0.0 && params.range_min_m < params.range_max_m))
    return "camera.range_min_m must be >= 0 and below range_max_m";
  if (!(params.range_max_m <= 100.0)) return "camera.range_max_m must be <= 100";
  if (!(params.wrap_range_m >= 0.0)) return "camera.wrap_range_m must be >= 0";
  if (!is_within(params.frames_per_s, 1, 240)) return "camera.frames_per_s must be 1..240";
  return "";
}

std::string check(const V4l2Params& params) {
  if (!is_within(params.width_px, 1, tof::kMaxSide_px)) return "v4l2.width_px must be 1..1024";
  if (!is_within(params.height_px, 1, tof::kMaxSide_px)) return "v4l2.height_px must be 1..1024";
  if (!is_within(params.depth_unit_um, 1, 100'000)) return "v4l2.depth_unit_um must be 1..100000";
  if (!is_within(params.no_return, 0, 65'535)) return "v4l2.no_return must be 0..65535";
  return "";
}

std::string check(const A010Params& params) {
  if (params.binning != 1 && params.binning != 2 && params.binning != 4)
    return "a010.binning must be 1, 2 or 4";
  if (!is_within(params.unit_mm, 0, 10)) return "a010.unit_mm must be 0..10";
  if (!is_known_baud(params.baud)) {
    return "a010.baud must be 9600, 57600, 115200, 230400, 460800, 921600, 1000000, 2000000 or "
           "3000000";
  }
  if (!(params.silence_s >= 0.1 && params.silence_s <= 60.0))
    return "a010.silence_s must be 0.1..60";
  return "";
}

std::string check(const ImuParams& params) {
  if (!is_within(params.samples_per_s, 1, 4000)) return "imu.samples_per_s must be 1..4000";
  if (!tof::is_sound({.p_m = Eigen::Vector3d::Zero(), .q = params.q_body_imu}))
    return "imu.q_body_imu must be a unit quaternion w, x, y, z";
  return "";
}

/// Only of heads that exist.
std::string check(const HeadParams& params, const std::string& name) {
  if (!(params.intrinsics.fx_px >= 1.0 && params.intrinsics.fy_px >= 1.0))
    return name + ".fx_px and fy_px must be >= 1: calibrate the head that device names";
  if (!tof::is_sound(params.T_body_head))
    return name + ".q_body_head must be a unit quaternion w, x, y, z and p_body_head_m finite";
  return "";
}

}  // namespace

std::string check(const SourceParams& params) {
  for (const std::string& violation :
       {check(params.camera), check(params.v4l2), check(params.a010), check(params.imu)}) {
    if (!violation.empty()) return violation;
  }
  if (params.kind == Kind::kA010 && params.camera.frames_per_s > 19)
    return "camera.frames_per_s must be 1..19 with source \"a010\"";
  int num_heads = 0;
  for (std::size_t head = 0; head < params.heads.size(); ++head) {
    if (params.kind == Kind::kLcm || params.heads[head].device.empty()) continue;
    ++num_heads;
    std::string violation = check(params.heads[head], "head_" + std::to_string(head));
    if (!violation.empty()) return violation;
  }
  if (params.kind != Kind::kLcm && num_heads == 0)
    return "source needs a device: set head_0.device at least";
  return "";
}

tof::DepthFrame frame_of_head(const SourceParams& params, int head) {
  const HeadParams& own = params.heads[head];
  tof::DepthFrame frame;
  frame.head = head;
  frame.depth_kind = params.camera.depth_kind;
  frame.intrinsics = own.intrinsics;
  frame.range_min_m = params.camera.range_min_m;
  frame.range_max_m = params.camera.range_max_m;
  frame.wrap_range_m = params.camera.wrap_range_m;
  frame.T_body_head = own.T_body_head;
  return frame;
}

}  // namespace sources
