// SPDX-License-Identifier: BSD-3-Clause
// The library's front door: depth frames, inertial samples and poses in, clouds out. Filters a
// frame when it arrives, places its points when the cloud is due (poses that came meanwhile count).
// Output is a function of parameters and inputs in their order; no clock.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tof/cloud.h"
#include "tof/depth_frame.h"
#include "tof/filter.h"
#include "tof/gravity.h"
#include "tof/head_schedule.h"
#include "tof/limbs.h"
#include "tof/params.h"
#include "tof/pose_buffer.h"
#include "tof/projection.h"

namespace tof {

struct FusionCounters {
  std::int64_t frames_rejected = 0;  ///< not sound, see FrameResult::fault
  std::int64_t samples_rejected = 0;
  std::int64_t poses_rejected = 0;
  std::int64_t clouds = 0;
  std::int64_t clouds_suppressed = 0;  ///< nothing in it was newer than the last cloud
  std::int64_t recordings = 0;         ///< resets because time jumped
};

struct FrameResult {
  FrameFault fault = FrameFault::kNone;
  Arrival arrival = Arrival::kAccepted;  ///< meaningful without a fault
  /// None, one or two (a head's second frame closes one cloud and may complete the next). Valid
  /// until the next call.
  std::span<const Cloud> clouds;
};

class Fusion {
 public:
  /// params must pass check().
  explicit Fusion(const TofParams& params);

  FrameResult add_frame(const DepthFrame& frame);
  /// False: rejected and counted.
  bool add_imu(const ImuSample& sample);
  bool add_pose(std::int64_t utime_us, const Pose& T_odom_body);
  /// The robot's own joints; all must be known.
  bool add_joints(std::int64_t utime_us, const JointAngles& angles_rad);

  HeadState head_state(int head) const { return schedule_.state(head); }
  const HeadCounters& head_counters(int head) const { return schedule_.counters(head); }
  const FusionCounters& counters() const { return counters_; }

  /// Forgets the recording, not the counters. Called by itself when time goes back or jumps.
  void reset();

 private:
  /// What is kept of a head's newest frame until its cloud is due.
  struct HeadImage {
    DepthFrame frame;  ///< without its spans
    FilteredImage filtered;
    RayTable rays;
  };
  struct BodyPose {
    Pose T_odom_body;
    PoseSource source = PoseSource::kUnknown;
  };

  void follow_time(int stream, std::int64_t utime_us);
  void store(const DepthFrame& frame);
  void drop_own_limbs(HeadImage& image);
  void emit();
  void write_points(Cloud& cloud);
  BodyPose body_pose(std::int64_t utime_us);
  BodyPose last_known_pose() const;
  void fix_heading(const Eigen::Vector3d& up_body);

  TofParams params_;
  Filter filter_;
  HeadSchedule schedule_;
  PoseBuffer odometry_;
  TimeHistory<JointAngles> joints_;
  Gravity gravity_;
  GravityFrame gravity_frame_;
  CloudWriter writer_;
  std::array<HeadImage, kNumHeads> images_;
  std::array<Cloud, 2> clouds_;
  std::size_t num_clouds_ = 0;
  std::array<std::int64_t, kNumHeads + 3> stream_utime_us_{};  ///< of each input; 0 = none yet
  std::int64_t last_cloud_utime_us_ = 0;
  FusionCounters counters_;
};

}  // namespace tof
