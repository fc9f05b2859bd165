// SPDX-License-Identifier: BSD-3-Clause
// The result of one frame: rungs, rails and where they may be grasped. Mirrors the message ladder_t
// one to one, as structs instead of parallel arrays. Odom frame.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace ladder {

enum class LadderState : std::uint8_t { kUnknown = 0, kNone = 1, kConfirmed = 2 };

enum class RungState : std::uint8_t {
  kUnknown = 0,
  kCandidate = 1,  ///< a bar; not part of a confirmed ladder, or not seen often enough
  kTrusted = 2     ///< seen often enough, on a confirmed ladder
};

/// Bits of Rung::flags.
enum RungFlag : std::uint16_t {
  kFlagNone = 0,
  kFlagStub = 1,    ///< ends before a rail
  kFlagBent = 2,    ///< halves of different direction
  kFlagSagged = 4,  ///< the middle leaves the line between the ends
  kFlagTilted = 8   ///< not at a right angle to the rails
};

/// Why a stretch of a rung is refused; kNone = a gripper may close there.
enum class Reason : std::uint8_t {
  kNone = 0,
  kUnknown = 1,
  kNotTrusted = 2,
  kRailTooNear = 3,
  kOutlierTooNear = 4,  ///< something sticks out or is attached there
  kOtherRungTooNear = 5,
  kDamaged = 6,   ///< stub, bent, sagged
  kTooShort = 7,  ///< shorter than the gripper is wide
  kNotSeen = 8,   ///< no measurement supports this stretch
  kTooDeep = 9    ///< a tread: no claw closes round a board
};

struct Rung {
  int id = 0;  ///< stays with the rung for its life
  RungState state = RungState::kUnknown;
  int age = 0;              ///< default mode: evidence 0..12; paper mode: age 0..150
  double confidence = 0.0;  ///< 0..1
  double evaluation = 0.0;  ///< Eq. (6), nodes per decimetre
  int num_inliers = 0;
  int num_outliers = 0;
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();  ///< left end, seen along the approach
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;  ///< half the visible height
  double sag_m = 0.0;
  std::uint16_t flags = kFlagNone;
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Zero();  ///< of the axis' middle point
};

struct Rail {
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();  ///< lower end
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();
};

/// A stretch of a rung's axis, measured from end0.
struct Interval {
  int rung = 0;  ///< index into rungs
  double from_m = 0.0;
  double to_m = 0.0;
  Reason reason = Reason::kUnknown;
};

struct Grasp {
  int rung = 0;  ///< index into rungs
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d approach = Eigen::Vector3d::UnitX();  ///< unit, level, from robot to rung
  double confidence = 0.0;
};

struct LadderEstimate {
  std::uint64_t sequence = 0;  ///< of the cloud this was made from
  LadderState state = LadderState::kUnknown;
  double spacing_m = 0.0;  ///< mean distance of neighbouring rungs; 0 unless confirmed
  double spacing_sigma_m = 0.0;
  std::vector<Rung> rungs;  ///< ascending height of the middle point
  std::vector<Rail> rails;
  std::vector<Interval> intervals;  ///< ascending (rung, from)
  std::vector<Grasp> grasps;        ///< at most one per rung
};

}  // namespace ladder
