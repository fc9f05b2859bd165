// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/node_cloud.h"

#include <algorithm>
#include <cmath>

namespace ladder {

void NodeCloud::clear() {
  sequence = 0;
  id.clear();
  x_m.clear();
  y_m.clear();
  z_m.clear();
  node_class.clear();
  plane.clear();
  moments.clear();
  edges.clear();
  planes.clear();
  suspected.clear();
  head_valid.fill(false);
}

bool is_consistent(const NodeCloud& cloud) {
  const std::size_t n = cloud.id.size();
  if (cloud.x_m.size() != n || cloud.y_m.size() != n || cloud.z_m.size() != n) return false;
  if (cloud.node_class.size() != n || cloud.plane.size() != n) return false;
  if (!cloud.body_position_m.allFinite() || !std::isfinite(cloud.pixel_pitch_rad)) return false;
  for (int i = 0; i < kNumHeads; ++i) {
    if (cloud.head_valid[i] && !cloud.head_position_m[i].allFinite()) return false;
  }
  const auto in_cloud = [&](int node) { return node >= 0 && node < static_cast<int>(n); };
  const auto not_ascending = [](int a, int b) { return a >= b; };
  if (std::adjacent_find(cloud.id.begin(), cloud.id.end(), not_ascending) != cloud.id.end()) {
    return false;
  }
  int previous = -1;
  for (const HeadMoment& m : cloud.moments) {
    if (!in_cloud(m.node) || m.head < 0 || m.head >= kNumHeads) return false;
    const int order = m.node * kNumHeads + m.head;
    if (order <= previous) return false;
    previous = order;
  }
  return std::all_of(cloud.edges.begin(), cloud.edges.end(),
                     [&](const Edge& e) { return in_cloud(e.a) && in_cloud(e.b) && e.a != e.b; });
}

}  // namespace ladder
