// SPDX-License-Identifier: BSD-3-Clause
// The metrics of a run from its messages: truth (if any), rungs, topology. Pure: no LCM, no clock.
//
// Which frames count: recall, precision, errors, candidates, bars and topology are of the LAST
// frame of LADDER_RUNGS; *_all_frames, false_ladders, ladders_confirmed, grasps, identities,
// removals and the frames_to_* are over ALL frames. Each frame is compared with the truth nearest
// in utime.
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
#include "simulator/score/offers.h"

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
  std::vector<double> radius_errors;  ///< |reported - true| / true radius
  std::optional<double> radius_error_p50, radius_error_p95;
  std::optional<int> frames_to_first_rung, frames_to_all_rungs;  ///< 1 = the first frame
  int grasps_offered = 0;     ///< feasible intervals and grasps, frame by frame
  int unsafe_grasps = 0;      ///< of these, not wholly on a sound rung or too near to its ends
  int identity_switches = 0;  ///< a true rung goes on under another id
  int rungs_removed = 0;      ///< taken away while in view of the truth
  std::vector<double> removals_noticed_s;  ///< until none is reported there any more

  std::optional<int> nodes, edges, faces;
  std::optional<double> nodes_on_ladder_share;
  std::optional<int> nodes_safe_ground, nodes_wall, nodes_obstacle, nodes_unknown;
  std::optional<double> floor_area_m2, wall_area_m2;
  std::optional<std::vector<double>> bars_m;  ///< ascending; none: no floor plane was found

  std::optional<double> latency_ms_p50, latency_ms_p99;
  std::vector<double> compute_ms;  ///< DD-GNG and rungs per cloud; offline runs only
  std::optional<double> compute_ms_p50, compute_ms_p95;
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

  /// Offline only: what DD-GNG and the rungs of one cloud took.
  void computed(double ms) { compute_ms_.push_back(ms); }

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
    std::vector<Offer> offers;
  };
  /// A rung that is no longer there, until the report says so as well.
  struct Gone {
    TrueRung rung;
    std::int64_t utime_us = 0;
  };
  struct Arrival {
    std::int64_t utime_us = 0;
    std::int64_t received_us = 0;
  };

  const Truth* truth_at(std::int64_t utime_us) const;
  void score_frames(Score& score) const;
  std::vector<Gone> find_gone() const;
  void score_offers(const std::vector<Gone>& gone, Score& score) const;
  void score_identities(Score& score) const;
  void score_removals(const std::vector<Gone>& gone, Score& score) const;
  void score_last_frame(Score& score) const;
  void score_topology(Score& score) const;
  std::optional<std::vector<double>> bar_heights() const;

  MatchParams params_;
  OfferParams offer_params_;
  std::string scene_;
  std::vector<Truth> truths_;
  std::vector<Report> reports_;
  std::optional<ladder_msgs::topology_t> topology_;
  std::deque<Arrival> depth_arrivals_;  ///< the newest few
  std::vector<double> latencies_ms_;
  std::vector<double> compute_ms_;
};

}  // namespace simulator
