// SPDX-License-Identifier: BSD-3-Clause
// The metrics of a run from its messages: truth (if any), rungs, topology. Pure: no LCM, no clock.
//
// Which frames count: recall, precision, errors, candidates, bars and topology are of the LAST
// frame of LADDER_RUNGS; *_all_frames, false_ladders, ladders_confirmed and the frames_to_* are
// over ALL frames. Each frame is compared with the truth nearest in utime.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ladder_msgs/ladder_t.hpp"
#include "ladder_msgs/topology_t.hpp"
#include "ladder_msgs/truth_t.hpp"
#include "simulator/score/matching.h"

namespace simulator {

/// Nothing measured = nullopt, null in the JSON.
struct Score {
  bool has_truth = false;
  std::string scene;

  int frames = 0;  ///< messages of LADDER_RUNGS
  int rungs_true = 0;
  int rungs_confirmed = 0;
  int rungs_candidates = 0;
  int rungs_wrong = 0;
  std::optional<double> recall, precision;
  std::optional<double> recall_all_frames, precision_all_frames;
  int ladders_confirmed = 0;  ///< frames
  int false_ladders = 0;      ///< frames with a confirmed ladder and no trusted rung on a true one
  std::vector<double> axis_errors_mm, depth_errors_mm, angle_errors_deg, end_errors_mm;
  std::optional<double> axis_error_mm_p50, axis_error_mm_p95, depth_error_mm_p50;
  std::optional<double> angle_error_deg_p50, angle_error_deg_p95;
  std::optional<double> end_error_mm_p50, end_error_mm_p95;
  std::optional<int> frames_to_first_rung, frames_to_all_rungs;  ///< 1 = the first frame

  std::optional<int> nodes, edges, faces;
  std::optional<double> nodes_on_ladder_share;
  std::optional<int> nodes_safe_ground, nodes_wall, nodes_obstacle, nodes_unknown;
  std::optional<double> floor_area_m2, wall_area_m2;
  std::optional<std::vector<double>> bars_m;  ///< ascending; none: no floor plane was found

  std::optional<double> latency_ms_p50, latency_ms_p99;
  std::map<std::string, std::int64_t> messages, messages_lost;  ///< per channel
};

/// The smallest value that at least q (0..1) of them do not exceed; nullopt when there are none.
std::optional<double> quantile(std::vector<double> values, double q);

class Scorer {
 public:
  explicit Scorer(const MatchParams& params = {}) : params_(params) {}

  void add(const ladder_msgs::truth_t& truth);
  void add(const ladder_msgs::ladder_t& ladder);
  void add(const ladder_msgs::topology_t& topology) { topology_ = topology; }

  /// Live only: when messages came in, on one clock.
  void depth_frame_received(std::int64_t utime_us, std::int64_t received_us);
  void rungs_received(std::int64_t utime_us, std::int64_t received_us);

  /// The sums; messages and messages_lost are for the caller to fill in.
  Score result() const;

 private:
  struct Truth {
    std::int64_t utime_us = 0;
    bool is_ladder = false;
    Eigen::Vector3d robot_m = Eigen::Vector3d::Zero();
    std::vector<TrueRung> rungs;
    std::vector<Bar> rails;
  };
  struct Report {
    std::int64_t utime_us = 0;
    bool confirmed = false;
    std::vector<ReportedRung> rungs;
  };
  struct Arrival {
    std::int64_t utime_us = 0;
    std::int64_t received_us = 0;
  };

  const Truth* truth_at(std::int64_t utime_us) const;
  void score_frames(Score& score) const;
  void score_last_frame(Score& score) const;
  void score_topology(Score& score) const;
  std::optional<std::vector<double>> bar_heights() const;

  MatchParams params_;
  std::string scene_;
  std::vector<Truth> truths_;
  std::vector<Report> reports_;
  std::optional<ladder_msgs::topology_t> topology_;
  std::deque<Arrival> depth_arrivals_;  ///< the newest few
  std::vector<double> latencies_ms_;
};

}  // namespace simulator
