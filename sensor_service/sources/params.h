// SPDX-License-Identifier: BSD-3-Clause
// Which devices deliver depth frames and inertial samples, and what a device cannot say of itself:
// where it sits, how it projects, what a count means.
#pragma once

#include <array>
#include <string>

#include "tof/depth_frame.h"
#include "tof/pose.h"

namespace sources {

enum class Kind {
  kLcm,   ///< LADDER_TOF_i and LADDER_IMU from another process
  kV4l2,  ///< 16-bit depth cameras of the kernel
  kA010,  ///< Sipeed MaixSense A010 on serial lines
};

/// What the heads have in common.
struct CameraParams {
  tof::DepthKind depth_kind = tof::DepthKind::kZ;  ///< along the axis, or along each pixel's ray
  double range_min_m = 0.1;                        ///< nearer is not measured (pmd pico flexx)
  double range_max_m = 4.0;                        ///< farther is not measured (pmd pico flexx)
  double wrap_range_m = 0.0;                       ///< distances repeat from here; 0 = never
  int frames_per_s = 15;                           ///< asked of the device, 1..240
};

enum class PixelFormat { kZ16, kY16 };

struct V4l2Params {
  PixelFormat format = PixelFormat::kZ16;
  int width_px = 224, height_px = 171;  ///< 1..1024
  int depth_unit_um = 1000;             ///< micrometres per count, 1..100000; the driver's secret
  int no_return = 0;                    ///< count that means "nothing measured", besides 0
};

struct A010Params {
  int binning = 1;         ///< 1, 2 or 4: 100, 50 or 25 pixels a side
  int unit_mm = 0;         ///< millimetres per count, 1..10; 0 = (count / 5.1)^2, finer when near
  int baud = 115200;       ///< of the serial line; without meaning on USB
  bool over_usb = true;    ///< where the unit shall send its images: USB, or else its UART
  double silence_s = 4.0;  ///< without a frame: start anew (a new binning takes it 2 s)
};

struct ImuParams {
  std::string device;       ///< "iio:device0" or "name:mpu6050"; "" = none
  std::string trigger;      ///< name of the trigger to use; "" = the device's own
  int samples_per_s = 200;  ///< asked of the device, 1..4000
  Eigen::Quaterniond q_body_imu = Eigen::Quaterniond::Identity();  ///< rotates imu into body
  std::string sysfs = "/sys/bus/iio/devices";
  std::string dev = "/dev";
};

/// One head. Without a device it does not exist.
struct HeadParams {
  std::string device;  ///< "/dev/...", for V4L2 also "name:CARD" or "bus:BUS_INFO"; "" = none
  tof::Intrinsics intrinsics;  ///< of the image as delivered; 0 = not calibrated
  tof::Pose T_body_head{.p_m = Eigen::Vector3d::Zero(),
                        .q = {0.5, -0.5, 0.5, -0.5}};  ///< head: x right, y down, z ahead
};

struct SourceParams {
  Kind kind = Kind::kLcm;
  CameraParams camera;
  V4l2Params v4l2;
  A010Params a010;
  ImuParams imu;
  std::array<HeadParams, tof::kNumHeads> heads;
};

/// "" or the violated relation in words, naming the field.
std::string check(const SourceParams& params);

/// All of a head's frame but time, number and pixels.
tof::DepthFrame frame_of_head(const SourceParams& params, int head);

}  // namespace sources
