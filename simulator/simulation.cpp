// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/simulation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "simulator/sensor_messages.h"

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

/// `ahead_body`: where head 0 looks, the body's own x when that head is silent.
Eigen::Isometry3d odom_from_world(const Eigen::Isometry3d& T_world_body,
                                  const Eigen::Vector3d& ahead_body) {
  Eigen::Vector3d ahead = T_world_body.linear() * ahead_body;
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
  if (!(params.stagger_hz > 0.0 && params.stagger_hz <= 1000.0)) {
    return "stagger_hz must be in (0, 1000]";
  }
  if (const std::string problem = check(params.motion); !problem.empty()) return problem;
  if (params.removal && !(params.removal->rung >= 0 && params.removal->after_s >= 0.0)) {
    return "removal needs a rung and a time of at least 0";
  }
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
  T_world_start_.translation().z() = params.body_height_m;
  const Eigen::Vector3d ahead_body = params.head_dead[0]
                                         ? Eigen::Vector3d(Eigen::Vector3d::UnitX())
                                         : heads_[0].T_body_head_nominal().linear().col(2);
  T_odom_world_ = odom_from_world(T_world_start_, ahead_body);
  if (params.removal && params.removal->rung >= static_cast<int>(world_.scene().rungs.size())) {
    throw std::invalid_argument("simulation: the scene has no such rung to remove");
  }
}

Eigen::Isometry3d Simulation::T_world_body(std::int64_t utime_us) const {
  return moved(params_.motion, T_world_start_,
               1e-6 * static_cast<double>(utime_us - params_.start_utime_us));
}

std::int64_t Simulation::head_utime_us() const {
  // The heads flash one after the other so that they do not blind each other.
  const double stagger_hz = std::max(params_.stagger_hz, kNumHeads * params_.rate_hz);
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
  if (head == 0) begin_round(utime);
  if (!params_.head_dead[static_cast<std::size_t>(head)]) {
    const Eigen::Isometry3d T_world_body_now = T_world_body(utime);
    heads_[head].render(world_.model(), world_.state(), T_world_body_now,
                        static_cast<std::uint64_t>(round_), images_[head]);
    visibility_.add({world_.scene(), world_.rung_of_geom()}, heads_[head], T_world_body_now,
                    images_[head]);
    due_.emplace_back(tof_frame(head, utime));
    newest_frame_utime_us_ = utime;
  }
  if (head == kNumHeads - 1) {
    due_.emplace_back(truth_message(newest_frame_utime_us_ != 0 ? newest_frame_utime_us_ : utime));
    ++round_;
  }
  next_head_ = (head + 1) % kNumHeads;
}

void Simulation::begin_round(std::int64_t utime) {
  const double passed_s = 1e-6 * static_cast<double>(utime - params_.start_utime_us);
  if (params_.removal && !is_removed_ && passed_s >= params_.removal->after_s) {
    world_ = World(without_rung(world_.scene(), params_.removal->rung));
    visibility_ = RungVisibility(world_.scene().rungs.size());
    is_removed_ = true;
  }
  visibility_.clear();
  newest_frame_utime_us_ = 0;
}

ladder_msgs::tof_frame_t Simulation::tof_frame(int head, std::int64_t utime) const {
  ladder_msgs::tof_frame_t frame = frame_message(heads_[head], params_.sensor, images_[head]);
  frame.utime = utime;
  frame.seq = round_;
  frame.head = static_cast<std::int8_t>(head);
  return frame;
}

ladder_msgs::imu_t Simulation::imu_message() const {
  const Eigen::Isometry3d T_world_body_now = T_world_body(imu_utime_us());
  ImuSample sample = imu_at_rest(params_.imu, T_world_body_now, ~params_.scene.seed,
                                 static_cast<std::uint64_t>(imu_index_));
  if (params_.motion.any()) {
    const double t_s = 1e-6 * static_cast<double>(imu_utime_us() - params_.start_utime_us);
    add_motion(motion_at(params_.motion, T_world_start_, t_s), T_world_body_now, sample);
  }
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
  ladder_msgs::truth_t truth =
      scene_truth(world_.scene(), visibility_, T_odom_world_, T_world_body(utime));
  truth.utime = utime;
  truth.seq = round_;
  return truth;
}

}  // namespace simulator
