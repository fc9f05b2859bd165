// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/score/scorer.h"

#include <algorithm>
#include <cmath>

namespace simulator {
namespace {

using Eigen::Vector3d;
using ladder_msgs::topology_t;

constexpr double kNodeOnLadder_m = 0.05;
constexpr std::size_t kMaxArrivals = 256;

double distance_m(const Vector3d& point, const Bar& bar) {
  const Vector3d axis = bar.end1_m - bar.end0_m;
  const double along = (point - bar.end0_m).dot(axis) / std::max(axis.squaredNorm(), 1e-12);
  return (point - bar.end0_m - std::clamp(along, 0.0, 1.0) * axis).norm();
}

std::optional<double> share(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(whole);
}

double label_area_m2(const topology_t& topology, std::int8_t label_class) {
  double sum_m2 = 0.0;
  const std::size_t size = std::min(topology.label_class.size(), topology.label_area_m2.size());
  for (std::size_t i = 0; i < size; ++i) {
    if (topology.label_class[i] == label_class) sum_m2 += topology.label_area_m2[i];
  }
  return sum_m2;
}

}  // namespace

std::optional<double> quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(q * static_cast<double>(values.size())) - 1.0;
  return values[std::min(static_cast<std::size_t>(std::max(rank, 0.0)), values.size() - 1)];
}

void Scorer::add(const ladder_msgs::truth_t& message) {
  Truth truth;
  truth.utime_us = message.utime;
  truth.is_ladder = message.is_ladder == 1;
  truth.robot_m = Eigen::Map<const Vector3d>(message.p_odom_body_m);
  truth.rungs = rungs_of(message);
  truth.rails = rails_of(message);
  truths_.push_back(std::move(truth));
  scene_ = message.scene;
}

void Scorer::add(const ladder_msgs::ladder_t& message) {
  reports_.push_back({message.utime,
                      message.ladder_state == ladder_msgs::ladder_t::LADDER_CONFIRMED,
                      rungs_of(message), offers_of(message)});
}

void Scorer::depth_frame_received(std::int64_t utime_us, std::int64_t received_us) {
  depth_arrivals_.push_back({utime_us, received_us});
  if (depth_arrivals_.size() > kMaxArrivals) depth_arrivals_.pop_front();
}

void Scorer::rungs_received(std::int64_t utime_us, std::int64_t received_us) {
  const auto arrival =
      std::find_if(depth_arrivals_.rbegin(), depth_arrivals_.rend(),
                   [utime_us](const Arrival& depth) { return depth.utime_us == utime_us; });
  if (arrival == depth_arrivals_.rend()) return;
  latencies_ms_.push_back(1e-3 * static_cast<double>(received_us - arrival->received_us));
}

const Scorer::Truth* Scorer::truth_at(std::int64_t utime_us) const {
  const auto nearer = [utime_us](const Truth& a, const Truth& b) {
    return std::abs(a.utime_us - utime_us) < std::abs(b.utime_us - utime_us);
  };
  const auto nearest = std::min_element(truths_.begin(), truths_.end(), nearer);
  return nearest == truths_.end() ? nullptr : &*nearest;
}

Score Scorer::result() const {
  Score score;
  score.has_truth = !truths_.empty();
  score.scene = scene_;
  score.frames = static_cast<int>(reports_.size());
  for (const Report& report : reports_) score.ladders_confirmed += report.confirmed ? 1 : 0;
  if (score.has_truth) {
    score_frames(score);
    score_identities(score);
    const std::vector<Gone> gone = find_gone();
    score_offers(gone, score);
    score_removals(gone, score);
  }
  if (!reports_.empty()) score_last_frame(score);
  if (topology_) score_topology(score);
  score.bars_m = bar_heights();
  score.latency_ms_p50 = quantile(latencies_ms_, 0.50);
  score.latency_ms_p99 = quantile(latencies_ms_, 0.99);
  score.compute_ms = compute_ms_;
  score.compute_ms_p50 = quantile(compute_ms_, 0.50);
  score.compute_ms_p95 = quantile(compute_ms_, 0.95);
  return score;
}

void Scorer::score_frames(Score& score) const {
  std::int64_t countable_sum = 0, found_sum = 0, wrong_sum = 0;
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    const Truth& truth = *truth_at(reports_[i].utime_us);
    const FrameMatch frame = match(reports_[i].rungs, truth.rungs, truth.robot_m, params_);
    countable_sum += frame.countable;
    found_sum += frame.found;
    wrong_sum += frame.wrong;
    if (reports_[i].confirmed && frame.on_true_rung == 0) ++score.false_ladders;
    const int frame_number = static_cast<int>(i) + 1;
    if (!score.frames_to_first_rung && frame.found > 0) score.frames_to_first_rung = frame_number;
    const bool all = frame.countable > 0 && frame.found == frame.countable;
    if (!score.frames_to_all_rungs && all) score.frames_to_all_rungs = frame_number;
  }
  score.recall_all_frames = share(found_sum, countable_sum);
  score.precision_all_frames = share(found_sum, found_sum + wrong_sum);
}

void Scorer::score_offers(const std::vector<Gone>& gone, Score& score) const {
  for (const Report& report : reports_) {
    std::vector<TrueRung> rungs = truth_at(report.utime_us)->rungs;
    for (const Gone& one : gone) {
      const double passed_s = 1e-6 * static_cast<double>(report.utime_us - one.utime_us);
      if (passed_s >= 0.0 && passed_s <= offer_params_.reaction_s) rungs.push_back(one.rung);
    }
    score.grasps_offered += static_cast<int>(report.offers.size());
    for (const Offer& offer : report.offers) {
      score.unsafe_grasps += is_safe(offer, rungs, offer_params_) ? 0 : 1;
    }
  }
}

void Scorer::score_identities(Score& score) const {
  std::map<int, int> reported_of_true;
  for (const Report& report : reports_) {
    const Truth& truth = *truth_at(report.utime_us);
    for (const MatchedIds& ids : match(report.rungs, truth.rungs, truth.robot_m, params_).ids) {
      const auto [known, is_new] = reported_of_true.try_emplace(ids.truth, ids.reported);
      if (is_new || known->second == ids.reported) continue;
      known->second = ids.reported;
      ++score.identity_switches;
    }
  }
}

std::vector<Scorer::Gone> Scorer::find_gone() const {
  std::vector<Gone> gone;
  for (std::size_t i = 1; i < truths_.size(); ++i) {
    for (const TrueRung& rung : truths_[i - 1].rungs) {
      const auto same = [&rung](const TrueRung& other) { return other.id == rung.id; };
      const std::vector<TrueRung>& now = truths_[i].rungs;
      if (std::none_of(now.begin(), now.end(), same)) gone.push_back({rung, truths_[i].utime_us});
    }
  }
  return gone;
}

void Scorer::score_removals(const std::vector<Gone>& gone, Score& score) const {
  score.rungs_removed = static_cast<int>(gone.size());
  for (const Gone& one : gone) {
    const auto noticed = std::find_if(reports_.begin(), reports_.end(), [&](const Report& report) {
      return report.utime_us >= one.utime_us && !is_reported(report.rungs, one.rung, params_);
    });
    if (noticed == reports_.end()) continue;
    score.removals_noticed_s.push_back(1e-6 *
                                       static_cast<double>(noticed->utime_us - one.utime_us));
  }
}

void Scorer::score_last_frame(Score& score) const {
  const Report& report = reports_.back();
  for (const ReportedRung& rung : report.rungs) {
    ++(rung.trusted ? score.rungs_confirmed : score.rungs_candidates);
  }
  const Truth* truth = truth_at(report.utime_us);
  if (truth == nullptr) return;
  const FrameMatch frame = match(report.rungs, truth->rungs, truth->robot_m, params_);
  score.rungs_true = frame.countable;
  score.rungs_wrong = frame.wrong;
  score.recall = share(frame.found, frame.countable);
  score.precision = share(frame.found, frame.found + frame.wrong);
  for (const RungErrors& errors : frame.errors) {
    score.axis_errors_mm.push_back(errors.axis_mm);
    score.depth_errors_mm.push_back(errors.depth_mm);
    score.angle_errors_deg.push_back(errors.angle_deg);
    score.radius_errors.push_back(errors.radius_share);
    for (const std::optional<double>& end_mm : errors.end_mm) {
      if (end_mm) score.end_errors_mm.push_back(*end_mm);
    }
  }
  score.axis_error_mm_p50 = quantile(score.axis_errors_mm, 0.50);
  score.axis_error_mm_p95 = quantile(score.axis_errors_mm, 0.95);
  score.depth_error_mm_p50 = quantile(score.depth_errors_mm, 0.50);
  score.angle_error_deg_p50 = quantile(score.angle_errors_deg, 0.50);
  score.angle_error_deg_p95 = quantile(score.angle_errors_deg, 0.95);
  score.radius_error_p50 = quantile(score.radius_errors, 0.50);
  score.radius_error_p95 = quantile(score.radius_errors, 0.95);
  score.end_error_mm_p50 = quantile(score.end_errors_mm, 0.50);
  score.end_error_mm_p95 = quantile(score.end_errors_mm, 0.95);
}

void Scorer::score_topology(Score& score) const {
  const topology_t& topology = *topology_;
  const auto num_nodes = static_cast<int>(
      std::min({topology.node_x_m.size(), topology.node_y_m.size(), topology.node_z_m.size()}));
  score.nodes = num_nodes;
  score.edges = static_cast<int>(topology.edge_a.size());
  score.faces = static_cast<int>(topology.face_a.size());
  const auto num_of_class = [&topology](std::int8_t node_class) {
    return static_cast<int>(
        std::count(topology.node_class.begin(), topology.node_class.end(), node_class));
  };
  score.nodes_unknown = num_of_class(topology_t::CLASS_UNKNOWN);
  score.nodes_safe_ground = num_of_class(topology_t::CLASS_SAFE_GROUND);
  score.nodes_wall = num_of_class(topology_t::CLASS_WALL);
  score.nodes_obstacle = num_of_class(topology_t::CLASS_OBSTACLE);
  score.floor_area_m2 = label_area_m2(topology, topology_t::CLASS_SAFE_GROUND);
  score.wall_area_m2 = label_area_m2(topology, topology_t::CLASS_WALL);

  const Truth* truth = truth_at(topology.utime);
  if (truth == nullptr || !truth->is_ladder) return;
  std::vector<Bar> parts = truth->rails;
  for (const TrueRung& rung : truth->rungs) parts.push_back(rung.bar);
  int on_ladder = 0;
  for (int i = 0; i < num_nodes; ++i) {
    const Vector3d node(topology.node_x_m[i], topology.node_y_m[i], topology.node_z_m[i]);
    on_ladder += std::any_of(parts.begin(), parts.end(), [&node](const Bar& part) {
      return distance_m(node, part) <= kNodeOnLadder_m;
    });
  }
  score.nodes_on_ladder_share = share(on_ladder, num_nodes);
}

std::optional<std::vector<double>> Scorer::bar_heights() const {
  if (!topology_ || reports_.empty()) return std::nullopt;
  const topology_t& topology = *topology_;
  const std::size_t num_planes = std::min(
      {topology.plane_class.size(), topology.plane_offset_m.size(), topology.plane_normal_x.size(),
       topology.plane_normal_y.size(), topology.plane_normal_z.size()});
  if (std::count(topology.plane_class.begin(), topology.plane_class.end(),
                 topology_t::CLASS_SAFE_GROUND) == 0) {
    return std::nullopt;
  }
  std::vector<double> heights_m;
  for (const ReportedRung& rung : reports_.back().rungs) {
    if (!rung.bar.finite()) continue;
    // The lowest level surface is the floor; a tread or shelf board may be level, too.
    std::optional<double> height_m;
    for (std::size_t i = 0; i < num_planes; ++i) {
      if (topology.plane_class[i] != topology_t::CLASS_SAFE_GROUND) continue;
      const Vector3d normal(topology.plane_normal_x[i], topology.plane_normal_y[i],
                            topology.plane_normal_z[i]);
      const double above_m = normal.dot(rung.bar.middle_m()) - topology.plane_offset_m[i];
      height_m = std::max(height_m.value_or(above_m), above_m);
    }
    if (height_m) heights_m.push_back(*height_m);
  }
  std::sort(heights_m.begin(), heights_m.end());
  return heights_m;
}

}  // namespace simulator
