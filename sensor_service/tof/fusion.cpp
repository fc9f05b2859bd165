// SPDX-License-Identifier: BSD-3-Clause
#include "tof/fusion.h"

#include <algorithm>

#include "base/check.h"
#include "tof/self_filter.h"

namespace tof {
namespace {

constexpr int kImuStream = kNumHeads;
constexpr int kPoseStream = kNumHeads + 1;
constexpr int kJointStream = kNumHeads + 2;

double seconds(std::int64_t interval_us) {
  return static_cast<double>(interval_us) * 1e-6;
}

}  // namespace

Fusion::Fusion(const TofParams& params)
    : params_(params),
      filter_(params.filter),
      schedule_(params.heads),
      odometry_(params.poses),
      joints_(params.poses),
      gravity_(params.gravity, params.poses) {
  CHECK(check(params).empty(), "parameters are checked by whoever reads them");
  const auto max_points = static_cast<std::size_t>(params.max_points);
  for (Cloud& cloud : clouds_) {
    cloud.x_m.reserve(max_points);
    cloud.y_m.reserve(max_points);
    cloud.z_m.reserve(max_points);
    cloud.head.reserve(max_points);
  }
}

FrameResult Fusion::add_frame(const DepthFrame& frame) {
  num_clouds_ = 0;
  FrameResult result;
  result.fault = find_fault(frame);
  if (result.fault != FrameFault::kNone) {
    ++counters_.frames_rejected;
    return result;
  }
  follow_time(frame.head, frame.utime_us);
  result.arrival = schedule_.arrive(frame.head, frame.utime_us, frame.seq);
  if (result.arrival != Arrival::kAccepted) return result;
  if (schedule_.is_waiting(frame.head)) emit();  // a second frame
  store(frame);
  if (schedule_.is_complete()) emit();
  result.clouds = std::span<const Cloud>(clouds_).first(num_clouds_);
  return result;
}

bool Fusion::add_imu(const ImuSample& sample) {
  const bool is_stamped = sample.utime_us > 0;
  if (is_stamped) follow_time(kImuStream, sample.utime_us);
  const bool is_taken = is_stamped && gravity_.add(sample);
  counters_.samples_rejected += !is_taken;
  return is_taken;
}

bool Fusion::add_pose(std::int64_t utime_us, const Pose& T_odom_body) {
  const bool is_stamped = utime_us > 0;
  if (is_stamped) follow_time(kPoseStream, utime_us);
  const bool is_taken = is_stamped && odometry_.push(utime_us, T_odom_body);
  counters_.poses_rejected += !is_taken;
  return is_taken;
}

bool Fusion::add_joints(std::int64_t utime_us, const JointAngles& angles_rad) {
  constexpr double kLimit_rad = 4.0;  // of any joint; limbs_of() is exact within
  for (const double angle_rad : angles_rad) {
    if (!(angle_rad >= -kLimit_rad && angle_rad <= kLimit_rad)) return false;
  }
  if (utime_us <= 0) return false;
  follow_time(kJointStream, utime_us);
  return joints_.push(utime_us, angles_rad);
}

/// Back within one stream, or far ahead of all of them, is a new recording. (Back against another
/// stream is not: one head may lag.)
void Fusion::follow_time(int stream, std::int64_t utime_us) {
  const std::int64_t newest_us =
      *std::max_element(stream_utime_us_.begin(), stream_utime_us_.end());
  const bool goes_back =
      stream_utime_us_[stream] != 0 &&
      seconds(utime_us - stream_utime_us_[stream]) < -params_.heads.backward_reset_s;
  const bool jumps_ahead =
      newest_us != 0 && seconds(utime_us - newest_us) > params_.heads.forward_reset_s;
  if (goes_back || jumps_ahead) {
    reset();
    ++counters_.recordings;
  }
  stream_utime_us_[stream] = std::max(stream_utime_us_[stream], utime_us);
}

void Fusion::reset() {
  schedule_.reset();
  odometry_.clear();
  joints_.clear();
  gravity_.clear();
  gravity_frame_.clear();
  stream_utime_us_.fill(0);
  last_cloud_utime_us_ = 0;
}

void Fusion::store(const DepthFrame& frame) {
  HeadImage& image = images_[frame.head];
  filter_.apply(frame, image.filtered);
  image.rays.fit(frame);
  image.frame = frame;
  if (params_.limbs.drop) drop_own_limbs(image);
  image.frame.depth_mm = {};
  image.frame.confidence = {};
  schedule_.put(frame.head);
}

/// Angles of the frame's own time, from messages that come more seldom than frames.
void Fusion::drop_own_limbs(HeadImage& image) {
  const auto bracket = joints_.at(image.frame.utime_us);
  if (!bracket) return;
  JointAngles angles_rad;
  for (std::size_t i = 0; i < angles_rad.size(); ++i) {
    angles_rad[i] = (*bracket->a)[i] + bracket->fraction * ((*bracket->b)[i] - (*bracket->a)[i]);
  }
  drop_limbs(image.frame, image.rays, limbs_of(params_.limbs, angles_rad), image.filtered);
}

void Fusion::emit() {
  Cloud& cloud = clouds_[num_clouds_];
  cloud.utime_us = 0;
  for (int h = 0; h < kNumHeads; ++h) {
    cloud.head_utime_us[h] = schedule_.is_waiting(h) ? images_[h].frame.utime_us : 0;
    cloud.head_state[h] = schedule_.state(h);
    cloud.utime_us = std::max(cloud.utime_us, cloud.head_utime_us[h]);
  }
  if (cloud.utime_us > last_cloud_utime_us_) {
    const BodyPose body = body_pose(cloud.utime_us);
    cloud.T_odom_body = body.T_odom_body;
    cloud.pose_source = body.source;
    write_points(cloud);
    last_cloud_utime_us_ = cloud.utime_us;
    ++num_clouds_;
    ++counters_.clouds;
  } else {
    ++counters_.clouds_suppressed;
  }
  schedule_.take_all();
}

void Fusion::write_points(Cloud& cloud) {
  std::int64_t num_points = 0;
  for (int h = 0; h < kNumHeads; ++h) {
    if (cloud.head_utime_us[h] != 0) num_points += images_[h].filtered.num_kept;
  }
  const std::int64_t max_points = params_.max_points;
  RankThinning thinning(num_points, max_points);
  writer_.begin(cloud, static_cast<std::size_t>(std::min(num_points, max_points)));
  cloud.range_max_m = 0.0F;
  cloud.pixel_pitch_rad = 0.0F;
  for (int h = 0; h < kNumHeads; ++h) {
    cloud.head_position_m[h].setZero();
    if (cloud.head_utime_us[h] == 0) continue;
    const HeadImage& image = images_[h];
    const DepthFrame& frame = image.frame;
    const BodyPose body = body_pose(frame.utime_us);
    const Placement placement(body.T_odom_body * frame.T_body_head);
    cloud.pose_source = std::min(cloud.pose_source, body.source);
    cloud.head_position_m[h] = placement.position_m;
    cloud.range_max_m = std::max(cloud.range_max_m, static_cast<float>(frame.range_max_m));
    const double focal_length_px = std::min(frame.intrinsics.fx_px, frame.intrinsics.fy_px);
    cloud.pixel_pitch_rad =
        std::max(cloud.pixel_pitch_rad, static_cast<float>(1.0 / focal_length_px));
    writer_.write({h, frame.width_px, frame.height_px, image.filtered.depth_mm.data()}, image.rays,
                  placement, thinning);
  }
  CHECK(writer_.num_written() == cloud.size(), "thinning keeps what was announced");
}

Fusion::BodyPose Fusion::body_pose(std::int64_t utime_us) {
  if (const auto pose = odometry_.at(utime_us)) return {*pose, PoseSource::kOdometry};
  // Odometry that has fallen silent is not replaced by gravity: odom would jump to the body.
  if (odometry_.newest()) return last_known_pose();
  const auto up = gravity_.up_at(utime_us);
  if (!up) return last_known_pose();
  if (!gravity_frame_.is_fixed()) fix_heading(*up);
  Pose T_odom_body;
  T_odom_body.q = gravity_frame_.q_odom_body(*up);
  return {T_odom_body, PoseSource::kGravity};
}

Fusion::BodyPose Fusion::last_known_pose() const {
  if (const auto pose = odometry_.newest()) return {*pose, PoseSource::kUnknown};
  Pose T_odom_body;
  if (const auto up = gravity_.newest_up(); up && gravity_frame_.is_fixed()) {
    T_odom_body.q = gravity_frame_.q_odom_body(*up);
  }
  return {T_odom_body, PoseSource::kUnknown};
}

/// Ahead is where head 0 looks; the body's own x if head 0 is silent when the first cloud is due.
void Fusion::fix_heading(const Eigen::Vector3d& up_body) {
  if (schedule_.state(0) == HeadState::kUnknown) {
    gravity_frame_.fix(up_body, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ());
    return;
  }
  const DepthFrame& frame = images_[0].frame;
  const Eigen::Matrix3d R_body_head = frame.T_body_head.q.toRotationMatrix();
  const auto up_then = gravity_.up_at(frame.utime_us);
  gravity_frame_.fix(up_then ? *up_then : up_body, R_body_head.col(2), -R_body_head.col(1));
}

}  // namespace tof
