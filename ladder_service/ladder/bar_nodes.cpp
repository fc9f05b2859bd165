// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/bar_nodes.h"

#include <algorithm>
#include <cmath>

namespace ladder {
namespace {

bool is_finite(const HeadMoment& m) {
  return m.weight > 0.0F && std::isfinite(m.weight) && m.mean_m.allFinite() &&
         std::isfinite(m.xx_m2 + m.xy_m2 + m.xz_m2 + m.yy_m2 + m.yz_m2 + m.zz_m2);
}

}  // namespace

MomentSum to_sum(const HeadMoment& m) {
  Eigen::Matrix3d covariance;
  covariance << m.xx_m2, m.xy_m2, m.xz_m2, m.xy_m2, m.yy_m2, m.yz_m2, m.xz_m2, m.yz_m2, m.zz_m2;
  MomentSum sum;
  sum.add(m.weight, m.mean_m.cast<double>(), covariance);
  return sum;
}

BarNodes::BarNodes(const LadderParams& params)
    : max_nodes_(params.max_nodes),
      min_weight_(params.bar.min_node_weight),
      weight_without_moments_(params.bar.weight_without_moments) {
  unordered_.reserve(params.max_cloud_nodes);
  order_.reserve(params.max_cloud_nodes);
  nodes_.reserve(max_nodes_);
  position_m_.reserve(max_nodes_);
  sum_.reserve(max_nodes_);
  height_m_.reserve(max_nodes_);
}

bool BarNodes::pool(const NodeCloud& cloud, int node, int first_moment, BarNode& out) const {
  out = BarNode{};
  out.node = node;
  out.first_moment = first_moment;
  const Eigen::Vector3d body = cloud.body_position_m.cast<double>();
  if (cloud.moments.empty()) {
    const Eigen::Vector3d position = cloud.node_m(node);
    if (!position.allFinite()) return false;
    out.sum.add(weight_without_moments_, position, Eigen::Matrix3d::Zero());
    out.eye_sum_m = weight_without_moments_ * body;
  }
  for (int i = first_moment; i < static_cast<int>(cloud.moments.size()); ++i) {
    const HeadMoment& m = cloud.moments[i];
    if (m.node != node) break;
    ++out.num_moments;
    if (!is_finite(m)) continue;
    out.sum.add(to_sum(m));
    const bool seen = cloud.head_valid[m.head];
    out.eye_sum_m += m.weight * (seen ? cloud.head_position_m[m.head].cast<double>() : body);
  }
  if (out.sum.weight < min_weight_) return false;
  out.position_m = out.sum.mean();
  return true;
}

void BarNodes::gather(const NodeCloud& cloud) {
  unordered_.clear();
  const int num_nodes = std::min<int>(cloud.num_nodes(), static_cast<int>(unordered_.capacity()));
  const int num_moments = static_cast<int>(cloud.moments.size());
  int moment = 0;
  for (int node = 0; node < num_nodes; ++node) {
    while (moment < num_moments && cloud.moments[moment].node < node) ++moment;
    BarNode pooled;
    if (cloud.plane[node] < 0 && pool(cloud, node, moment, pooled)) unordered_.push_back(pooled);
  }
  order_.clear();
  for (int i = 0; i < static_cast<int>(unordered_.size()); ++i) order_.push_back(i);
  const auto heavier = [this](int a, int b) {
    const double wa = unordered_[a].sum.weight;
    const double wb = unordered_[b].sum.weight;
    return wa > wb || (wa == wb && a < b);
  };
  const auto lower = [this](int a, int b) {
    const double za = unordered_[a].position_m.z();
    const double zb = unordered_[b].position_m.z();
    return za < zb || (za == zb && a < b);
  };
  if (static_cast<int>(order_.size()) > max_nodes_) {
    std::nth_element(order_.begin(), order_.begin() + max_nodes_, order_.end(), heavier);
    order_.resize(max_nodes_);
  }
  std::sort(order_.begin(), order_.end(), lower);
  nodes_.clear();
  position_m_.clear();
  sum_.clear();
  height_m_.clear();
  for (const int i : order_) {
    nodes_.push_back(unordered_[i]);
    position_m_.push_back(unordered_[i].position_m);
    sum_.push_back(unordered_[i].sum);
    height_m_.push_back(unordered_[i].position_m.z());
  }
}

BarNodes::Range BarNodes::between(double from_m, double to_m) const {
  const auto begin = std::lower_bound(height_m_.begin(), height_m_.end(), from_m);
  const auto end = std::upper_bound(begin, height_m_.end(), to_m);
  return {static_cast<int>(begin - height_m_.begin()), static_cast<int>(end - height_m_.begin())};
}

}  // namespace ladder
