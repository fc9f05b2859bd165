// SPDX-License-Identifier: BSD-3-Clause
// Which reported rung is which true rung of one frame, and how far off it is. Knows truth and
// report, nothing of the detector.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "ladder_msgs/ladder_t.hpp"
#include "ladder_msgs/truth_t.hpp"

namespace simulator {

struct Bar {
  Eigen::Vector3d end0_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d end1_m = Eigen::Vector3d::Zero();

  Eigen::Vector3d middle_m() const { return 0.5 * (end0_m + end1_m); }
  bool finite() const { return end0_m.allFinite() && end1_m.allFinite(); }
};

struct ReportedRung {
  int id = 0;
  Bar bar;
  double radius_m = 0.0;
  bool trusted = false;  ///< RUNG_TRUSTED; else a candidate
};

struct TrueRung {
  int id = 0;
  Bar bar;
  double radius_m = 0.0;
  bool of_ladder = false;  ///< false: a bar that belongs to no ladder
  bool sound = true;       ///< neither bent nor broken: it may be grasped
  bool straight = true;    ///< not bent: its axis says where the rung is
  int hits = 0;            ///< clean pixels
  double visible = 0.0;    ///< 0..1, share of its length
};

struct MatchParams {
  double max_axis_m = 0.05;             ///< reported middle to true axis
  double min_cosine = 0.9659258262891;  ///< of the angle between the axes: 15 deg
  double max_along_m = 0.2;             ///< between the middles, along the true axis
  int min_hits = 40;                    ///< a true rung counts from here on ...
  double min_visible = 0.6;             ///< ... when this share of it is seen
  double min_visible_end = 0.95;        ///< its ends are judged from here on
};

/// Errors of one matched, straight rung.
struct RungErrors {
  double axis_mm = 0.0;                  ///< reported middle to true axis, at a right angle to it
  double depth_mm = 0.0;                 ///< its part away from the robot, horizontal, signed
  double angle_deg = 0.0;                ///< between the axes
  double radius_share = 0.0;             ///< |reported - true| / true radius
  std::optional<double> end_mm[2] = {};  ///< along the true axis; none where the ends are not seen
};

/// A trusted rung and the true one that it is: their ids.
struct MatchedIds {
  int reported = 0;
  int truth = 0;
};

struct FrameMatch {
  int countable = 0;     ///< true rungs of a ladder that could be seen
  int found = 0;         ///< of these, matched by a trusted rung
  int wrong = 0;         ///< trusted rungs that are none: no rung there, twice, not finite
  int on_true_rung = 0;  ///< trusted rungs on a true rung, countable or not
  std::vector<RungErrors> errors;
  std::vector<MatchedIds> ids;
};

/// Whether the truth counts this rung.
bool countable(const TrueRung& rung, const MatchParams& params);

/// One to one, the nearest pairs first. A rung reported where a real one is that could not be seen
/// is neither found nor wrong. robot_m: where the robot stands, for the sign of depth.
FrameMatch match(std::span<const ReportedRung> reported, std::span<const TrueRung> truth,
                 const Eigen::Vector3d& robot_m, const MatchParams& params);

/// Whether a trusted rung is reported where this one is (or was).
bool is_reported(std::span<const ReportedRung> reported, const TrueRung& rung,
                 const MatchParams& params);

/// Arrays that are shorter than num_rungs says end the list.
std::vector<ReportedRung> rungs_of(const ladder_msgs::ladder_t& message);
std::vector<TrueRung> rungs_of(const ladder_msgs::truth_t& message);
std::vector<Bar> rails_of(const ladder_msgs::truth_t& message);

}  // namespace simulator
