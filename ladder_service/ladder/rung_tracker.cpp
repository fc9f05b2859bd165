// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/rung_tracker.h"

#include <algorithm>
#include <cmath>

#include "base/rng.h"

namespace ladder {
namespace {

constexpr int kMaxMembers = 1024;  // node ids kept per rung

bool in_box(const Box& box, const Eigen::Vector3d& p, double margin_m) {
  const Eigen::Vector3d off = (p - box.center_m.cast<double>()).cwiseAbs();
  const Eigen::Vector3d half = 0.5 * box.size_m.cast<double>();
  return off.x() < half.x() + margin_m && off.y() < half.y() + margin_m &&
         off.z() < half.z() + margin_m;
}

}  // namespace

bool is_same_rung(const PaperRung& a, const PaperRung& b, const PaperParams& params) {
  const Axis axis = a.axis();
  if (std::abs(axis.direction.dot(b.axis().direction)) <= params.merge_min_cos) return false;
  return axis.distance(0.5 * (b.end1_m + b.end2_m)) < params.merge_distance_m;
}

RungTracker::RungTracker(const LadderParams& params)
    : params_(params),
      graph_(params.max_cloud_nodes, params.max_cloud_edges),
      correction_(params),
      evaluation_(params),
      rungs_(static_cast<std::size_t>(params.max_tracks) + 1) {
  for (PaperRung& rung : rungs_) {
    rung.member_id.reserve(kMaxMembers);
    rung.outlier_id.reserve(kMaxMembers);
  }
  eligible_.reserve(params.max_nodes);
}

void RungTracker::reset() {
  num_rungs_ = 0;
  next_id_ = 1;
}

void RungTracker::update(const NodeCloud& cloud) {
  graph_.build(cloud);
  // PAPER: corrects and ages only while an object is suspected; a rung would then outlive its view.
  // docs/EQUATIONS.md
  correct_all(cloud);
  merge_look_alikes();
  age_all();
  if (!cloud.suspected.empty()) draw_candidates(cloud);
}

void RungTracker::remove(int index) {
  std::rotate(rungs_.begin() + index, rungs_.begin() + index + 1, rungs_.begin() + num_rungs_);
  --num_rungs_;
}

void RungTracker::correct_all(const NodeCloud& cloud) {
  for (int i = 0; i < num_rungs_;) {
    if (correction_.correct(cloud, graph_, rungs_[i])) {
      ++i;
    } else {
      remove(i);
    }
  }
}

void RungTracker::merge_look_alikes() {
  for (int i = 0; i < num_rungs_; ++i) {
    for (int k = i + 1; k < num_rungs_;) {
      PaperRung& a = rungs_[i];
      PaperRung& b = rungs_[k];
      if (!is_same_rung(a, b, params_.paper)) {
        ++k;
        continue;
      }
      const int age = std::max(a.age, b.age);
      const int id = a.id;  // the older one's
      if (b.num_inliers >= a.num_inliers - 2 && b.evaluation > a.evaluation) std::swap(a, b);
      a.age = age;
      a.id = id;
      remove(k);
    }
  }
}

void RungTracker::age_all() {
  const PaperParams& p = params_.paper;
  for (int i = 0; i < num_rungs_;) {
    PaperRung& rung = rungs_[i];
    const int bad = (rung.evaluation <= p.xi_age ? 1 : 0) +
                    (rung.num_inliers - rung.num_outliers < p.min_surplus ? 1 : 0);
    rung.age = std::min(p.age_max, bad > 0 ? rung.age - bad : rung.age + 1);
    if (rung.age < 0) {
      remove(i);
    } else {
      ++i;
    }
  }
}

void RungTracker::draw_candidates(const NodeCloud& cloud) {
  collect_eligible(cloud);
  const auto num_eligible = static_cast<std::uint32_t>(eligible_.size());
  if (num_eligible < 2) return;
  base::Rng rng(params_.seed, cloud.sequence);
  const int num_tries = params_.paper.tries / (num_rungs_ + 1);
  for (int i = 0; i < num_tries; ++i) {
    const int n1 = eligible_[rng.below(num_eligible)];
    const int n2 = eligible_[rng.below(num_eligible)];
    if (n1 == n2 || (params_.paper.pair_gate && !passes_gate(cloud, n1, n2))) continue;
    try_pair(cloud, n1, n2);
  }
}

void RungTracker::try_pair(const NodeCloud& cloud, int n1, int n2) {
  if (num_rungs_ >= params_.max_tracks) return;
  // The slot behind the last rung is free: max_tracks + 1 of them exist.
  PaperRung& rung = rungs_[num_rungs_];
  if (!evaluation_.evaluate(cloud, graph_, n1, n2, rung)) return;
  const auto known = rungs();
  const bool is_known = std::any_of(known.begin(), known.end(), [&](const PaperRung& other) {
    return is_same_rung(other, rung, params_.paper);
  });
  if (is_known) return;
  rung.id = next_id_++;
  rung.age = params_.paper.age_initial;
  ++num_rungs_;
}

void RungTracker::collect_eligible(const NodeCloud& cloud) {
  const PaperParams& p = params_.paper;
  eligible_.clear();
  const int num_nodes = std::min(cloud.num_nodes(), params_.max_cloud_nodes);
  for (int i = 0; i < num_nodes && eligible_.size() < eligible_.capacity(); ++i) {
    if (cloud.node_class[i] == NodeClass::kSafeGround) continue;
    const Eigen::Vector3d h = cloud.node_m(i);
    if (!h.allFinite()) continue;
    Eigen::Vector3d ahead = h - cloud.body_position_m.cast<double>();
    ahead.z() = 0.0;
    if (ahead.squaredNorm() > p.workspace_m * p.workspace_m) continue;
    const bool suspected =
        std::any_of(cloud.suspected.begin(), cloud.suspected.end(),
                    [&](const Box& box) { return in_box(box, h, p.box_margin_m); });
    if (suspected) eligible_.push_back(i);
  }
}

bool RungTracker::passes_gate(const NodeCloud& cloud, int n1, int n2) const {
  const Eigen::Vector3d h1 = cloud.node_m(n1);
  const Eigen::Vector3d difference = h1 - cloud.node_m(n2);
  const Eigen::Vector3d ahead = level_direction(cloud.body_position_m.cast<double>(), h1);
  const double lateral_m = std::abs(difference.dot(ahead.cross(Eigen::Vector3d::UnitZ())));
  const double gate_m = params_.paper.pair_gate_m;
  return !(lateral_m > gate_m && std::abs(difference.z()) > gate_m);
}

}  // namespace ladder
