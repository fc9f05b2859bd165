// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/simulation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace simulator {
namespace {

const SimulationParams& checked(const SimulationParams& params) {
  if (const std::string problem = check(params); !problem.empty()) {
    throw std::invalid_argument("simulation: " + problem);
  }
  return params;
}

/// Time of event `index` of a steady stream, relative to its start.
std::int64_t period_us(std::int64_t index, double rate_hz) {
  return static_cast<std::int64_t>(std::floor(static_cast<double>(index) * 1e6 / rate_hz + 0.5));
}

void copy(const Eigen::Isometry3d& pose, double (&position_m)[3], double (&quaternion)[4]) {
  const Eigen::Quaterniond q(pose.linear());
  for (int k = 0; k < 3; ++k) position_m[k] = pose.translation()[k];
  quaternion[0] = q.w();
  quaternion[1] = q.x();
  quaternion[2] = q.y();
  quaternion[3] = q.z();
}

Eigen::Isometry3d odom_from_world(const Eigen::Isometry3d& T_world_body,
                                  const Eigen::Isometry3d& T_body_head0) {
  Eigen::Vector3d ahead = (T_world_body * T_body_head0).linear().col(2);
  ahead.z() = 0.0;
  Eigen::Isometry3d T_world_odom = Eigen::Isometry3d::Identity();
  T_world_odom.translation() = T_world_body.translation();
  const Eigen::Vector3d x = ahead.normalized();
  T_world_odom.linear() << x, Eigen::Vector3d::UnitZ().cross(x), Eigen::Vector3d::UnitZ();
  return T_world_odom.inverse();
}

}  // namespace

std::string check(const SimulationParams& params) {
  if (const std::string problem = check(params.scene); !problem.empty()) return problem;
  if (const std::string problem = check(params.sensor); !problem.empty()) return problem;
  if (!(params.rate_hz > 0.0 && params.rate_hz <= 60.0)) return "rate_hz must be in (0, 60]";
  if (!(params.imu_rate_hz > 0.0 && params.imu_rate_hz <= 1000.0)) {
    return "imu_rate_hz must be in (0, 1000]";
  }
  if (!(params.body_height_m >= 0.0 && params.body_height_m <= 3.0)) {
    return "body_height_m must be in [0, 3]";
  }
  return "";
}

std::int64_t utime_us(const Message& message) {
  return std::visit([](const auto& value) { return value.utime; }, message);
}

Simulation::Simulation(const SimulationParams& params)
    : params_(checked(params)),
      world_(make_scene(params.scene)),
      visibility_(world_.scene().rungs.size()) {
  for (int i = 0; i < kNumHeads; ++i) {
    heads_.emplace_back(params.sensor, params.layout[static_cast<std::size_t>(i)], i,
                        params.scene.seed);
  }
  T_world_body_.translation().z() = params.body_height_m;
  T_odom_world_ = odom_from_world(T_world_body_, heads_[0].T_body_head_nominal());
}

std::int64_t Simulation::head_utime_us() const {
  // The heads flash one after the other so that they do not blind each other.
  constexpr double kStagger_hz = 60.0;
  const double stagger_hz = std::max(kStagger_hz, kNumHeads * params_.rate_hz);
  return params_.start_utime_us + period_us(round_, params_.rate_hz) +
         period_us(next_head_, stagger_hz);
}

std::int64_t Simulation::imu_utime_us() const {
  return params_.start_utime_us + period_us(imu_index_, params_.imu_rate_hz);
}

std::int64_t Simulation::next_utime_us() const {
  return std::min(head_utime_us(), imu_utime_us());
}

const std::vector<Message>& Simulation::advance_to(std::int64_t utime_us) {
  due_.clear();
  while (next_utime_us() <= utime_us) {
    if (imu_utime_us() <= head_utime_us()) {
      due_.emplace_back(imu_message());
      ++imu_index_;
    } else {
      advance_head();
    }
  }
  return due_;
}

void Simulation::advance_head() {
  const std::int64_t utime = head_utime_us();
  const int head = next_head_;
  if (head == 0) {
    visibility_.clear();
    newest_frame_utime_us_ = 0;
  }
  if (!params_.head_dead[static_cast<std::size_t>(head)]) {
    heads_[head].render(world_.model(), world_.state(), T_world_body_,
                        static_cast<std::uint64_t>(round_), images_[head]);
    visibility_.add(world_, heads_[head], T_world_body_, images_[head]);
    due_.emplace_back(tof_frame(head, utime));
    newest_frame_utime_us_ = utime;
  }
  if (head == kNumHeads - 1) {
    due_.emplace_back(truth_message(newest_frame_utime_us_ != 0 ? newest_frame_utime_us_ : utime));
    ++round_;
  }
  next_head_ = (head + 1) % kNumHeads;
}

ladder_msgs::tof_frame_t Simulation::tof_frame(int head, std::int64_t utime) const {
  using ladder_msgs::tof_frame_t;
  const Pinhole& pinhole = heads_[head].pinhole();
  const SensorParams& sensor = params_.sensor;
  tof_frame_t frame{};
  frame.utime = utime;
  frame.seq = round_;
  frame.head = static_cast<std::int8_t>(head);
  frame.depth_kind = sensor.radial ? tof_frame_t::DEPTH_RADIAL : tof_frame_t::DEPTH_Z;
  frame.width_px = static_cast<std::int16_t>(pinhole.width_px);
  frame.height_px = static_cast<std::int16_t>(pinhole.height_px);
  frame.fx_px = pinhole.fx_px;
  frame.fy_px = pinhole.fy_px;
  frame.cx_px = pinhole.cx_px;
  frame.cy_px = pinhole.cy_px;
  frame.range_min_m = sensor.range_min_m;
  frame.range_max_m = sensor.wrap_range_m > 0.0 ? std::min(sensor.wrap_range_m, sensor.range_max_m)
                                                : sensor.range_max_m;
  frame.wrap_range_m = sensor.wrap_range_m;
  copy(heads_[head].T_body_head_nominal(), frame.p_body_head_m, frame.q_body_head);
  frame.depth_mm = images_[head].depth_mm;
  frame.confidence = images_[head].confidence;
  frame.num_pixels = static_cast<std::int32_t>(frame.depth_mm.size());
  frame.num_confidence = static_cast<std::int32_t>(frame.confidence.size());
  return frame;
}

ladder_msgs::imu_t Simulation::imu_message() const {
  const ImuSample sample = imu_at_rest(params_.imu, T_world_body_, ~params_.scene.seed,
                                       static_cast<std::uint64_t>(imu_index_));
  ladder_msgs::imu_t message{};
  message.utime = imu_utime_us();
  message.seq = imu_index_;
  for (int axis = 0; axis < 3; ++axis) {
    message.accelerometer_m_s2[axis] = sample.accelerometer_m_s2[axis];
    message.gyroscope_rad_s[axis] = sample.gyroscope_rad_s[axis];
  }
  return message;
}

ladder_msgs::truth_t Simulation::truth_message(std::int64_t utime) const {
  const Scene& scene = world_.scene();
  ladder_msgs::truth_t truth{};
  truth.utime = utime;
  truth.seq = round_;
  truth.scene = std::string(to_string(scene.params.kind)) + " " + std::to_string(scene.params.seed);
  truth.is_ladder = is_ladder(scene.params.kind) ? 1 : 0;
  copy(T_odom_world_ * T_world_body_, truth.p_odom_body_m, truth.q_odom_body);
  for (std::size_t i = 0; i < scene.rungs.size(); ++i) {
    const Rung& rung = scene.rungs[i];
    const Eigen::Vector3f end0 = (T_odom_world_ * rung.end0_m).cast<float>();
    const Eigen::Vector3f end1 = (T_odom_world_ * rung.end1_m).cast<float>();
    truth.rung_id.push_back(rung.id);
    truth.rung_kind.push_back(static_cast<std::uint8_t>(rung.kind));
    truth.rung_x0_m.push_back(end0.x());
    truth.rung_y0_m.push_back(end0.y());
    truth.rung_z0_m.push_back(end0.z());
    truth.rung_x1_m.push_back(end1.x());
    truth.rung_y1_m.push_back(end1.y());
    truth.rung_z1_m.push_back(end1.z());
    truth.rung_radius_m.push_back(static_cast<float>(rung.radius_m));
    truth.rung_hits.push_back(visibility_.hits(i));
    truth.rung_visible.push_back(visibility_.visible_share(i));
  }
  truth.num_rungs = static_cast<std::int32_t>(scene.rungs.size());
  for (const Rail& rail : scene.rails) {
    const Eigen::Vector3f end0 = (T_odom_world_ * rail.end0_m).cast<float>();
    const Eigen::Vector3f end1 = (T_odom_world_ * rail.end1_m).cast<float>();
    truth.rail_x0_m.push_back(end0.x());
    truth.rail_y0_m.push_back(end0.y());
    truth.rail_z0_m.push_back(end0.z());
    truth.rail_x1_m.push_back(end1.x());
    truth.rail_y1_m.push_back(end1.y());
    truth.rail_z1_m.push_back(end1.z());
    truth.rail_half_width_m.push_back(static_cast<float>(rail.half_width_m));
  }
  truth.num_rails = static_cast<std::int32_t>(scene.rails.size());
  return truth;
}

}  // namespace simulator
