// SPDX-License-Identifier: BSD-3-Clause
#include "tests/reference/rung_reference.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/rng.h"

namespace rung_reference {
namespace {

using Eigen::Vector3d;

/// ||(h_n1 - h_j) - ((h_n1 - h_j) . n) n||
double rho(const Vector3d& h_n1, const Vector3d& n, const Vector3d& h_j) {
  const Vector3d v = h_n1 - h_j;
  return (v - v.dot(n) * n).norm();
}

/// Lines 2-11: id_j = 0 not a member, 1 inlier, 2 outlier; sweeps until nothing changes.
std::vector<int> mark_members(const Graph& g, const Vector3d& h_n1, const Vector3d& n,
                              const std::set<int>& starts, const ladder::PaperParams& p) {
  std::vector<int> id(g.h.size(), 0);
  const auto classify = [&](int j) {
    const double distance = rho(h_n1, n, g.h[j]);
    return distance < p.inlier_m ? 1 : (distance < p.outlier_m ? 2 : 0);
  };
  for (const int j : starts) id[j] = classify(j);
  bool has_changed = true;
  while (has_changed) {
    has_changed = false;
    for (std::size_t i = 0; i < g.h.size(); ++i) {
      for (std::size_t j = 0; j < g.h.size(); ++j) {
        if (id[i] == 0 || id[j] != 0 || !g.c[i][j]) continue;
        id[j] = classify(static_cast<int>(j));
        has_changed = has_changed || id[j] != 0;
      }
    }
  }
  return id;
}

std::set<int> ids_of(const Graph& g, const std::vector<int>& id) {
  std::set<int> members;
  for (std::size_t j = 0; j < id.size(); ++j) {
    if (id[j] != 0) members.insert(g.id[j]);
  }
  return members;
}

/// Eq. (6), the length in decimetres.
double eq_6(int ci, int co, double length_m) {
  return ci / ((1.0 + co) * (length_m * 10.0));
}

bool is_same(const Rung& a, const Rung& b, const ladder::PaperParams& p) {
  const Vector3d n = (a.e2 - a.e1).normalized();
  const Vector3d m = (b.e2 - b.e1).normalized();
  const Vector3d middle = (b.e1 + b.e2) / 2.0;
  return std::abs(n.dot(m)) > p.merge_min_cos && rho(a.e1, n, middle) < p.merge_distance_m;
}

void merge(std::vector<Rung>& rungs, const ladder::PaperParams& p) {
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    for (std::size_t k = i + 1; k < rungs.size();) {
      if (!is_same(rungs[i], rungs[k], p)) {
        ++k;
        continue;
      }
      const int age = std::max(rungs[i].age, rungs[k].age);
      if (rungs[k].ci >= rungs[i].ci - 2 && rungs[k].r > rungs[i].r) rungs[i] = rungs[k];
      rungs[i].age = age;
      rungs.erase(rungs.begin() + k);
    }
  }
}

void age(std::vector<Rung>& rungs, const ladder::PaperParams& p) {
  for (Rung& rung : rungs) {
    const bool is_bad1 = rung.r <= p.xi_age;
    const bool is_bad2 = rung.ci - rung.co < p.min_surplus;
    if (is_bad1 || is_bad2) {
      rung.age -= is_bad1 && is_bad2 ? 2 : 1;
    } else {
      rung.age = std::min(rung.age + 1, p.age_max);
    }
  }
  std::erase_if(rungs, [](const Rung& rung) { return rung.age < 0; });
}

bool is_eligible(const ladder::NodeCloud& cloud, int i, const ladder::PaperParams& p) {
  if (cloud.node_class[i] == ladder::NodeClass::kSafeGround) return false;
  const Vector3d h = cloud.node_m(i);
  const Vector3d from_body = h - cloud.body_position_m.cast<double>();
  if (std::hypot(from_body.x(), from_body.y()) > p.workspace_m) return false;
  return std::any_of(cloud.suspected.begin(), cloud.suspected.end(), [&](const ladder::Box& box) {
    const Vector3d low = box.center_m.cast<double>() - box.size_m.cast<double>() / 2.0;
    const Vector3d high = box.center_m.cast<double>() + box.size_m.cast<double>() / 2.0;
    return ((h - low).array() > -p.box_margin_m).all() &&
           ((high - h).array() > -p.box_margin_m).all();
  });
}

bool is_gated(const ladder::NodeCloud& cloud, int n1, int n2, const ladder::PaperParams& p) {
  if (!p.pair_gate) return false;
  const Vector3d d = cloud.node_m(n1) - cloud.node_m(n2);
  Vector3d ahead = cloud.node_m(n1) - cloud.body_position_m.cast<double>();
  ahead.z() = 0.0;
  const Vector3d right = ahead.normalized().cross(Vector3d::UnitZ());
  return std::abs(d.dot(right)) > p.pair_gate_m && std::abs(d.z()) > p.pair_gate_m;
}

}  // namespace

Graph to_graph(const ladder::NodeCloud& cloud) {
  Graph g;
  g.id = cloud.id;
  const std::size_t n = cloud.id.size();
  for (std::size_t i = 0; i < n; ++i) g.h.push_back(cloud.node_m(static_cast<int>(i)));
  g.c.assign(n, std::vector<bool>(n, false));
  for (const ladder::Edge& e : cloud.edges) g.c[e.a][e.b] = g.c[e.b][e.a] = true;
  return g;
}

std::optional<Rung> algorithm_4(const Graph& g, int n1, int n2, const ladder::PaperParams& p) {
  const Vector3d n = (g.h[n1] - g.h[n2]) / (g.h[n1] - g.h[n2]).norm();  // 1
  const std::vector<int> id = mark_members(g, g.h[n1], n, {n1}, p);     // 2-11
  if (id[n2] == 0) return std::nullopt;                                 // c = 0
  int ci = 0, co = 0;
  for (const int x : id) {
    if (x == 1) ++ci;  // 12
    if (x == 2) ++co;  // 14
  }
  if (ci < p.min_inliers || ci <= p.inlier_ratio * co) return std::nullopt;  // 15
  Vector3d v1 = Vector3d::Zero();                                            // 16
  Vector3d v2 = g.h[n1] - g.h[n2];                                           // 17
  for (std::size_t j = 0; j < g.h.size(); ++j) {
    if (id[j] != 1) continue;
    const Vector3d v = (g.h[n1] - g.h[j]).dot(n) * n;  // 19
    if ((v - v1).norm() > (v2 - v1).norm()) {          // 20: beyond v2, seen from v1
      v2 = v;
    } else if ((v2 - v).norm() > (v2 - v1).norm()) {  // beyond v1, seen from v2
      v1 = v;
    }
  }
  Rung rung;
  rung.e1 = g.h[n1] - v1;
  rung.e2 = g.h[n1] - v2;
  rung.ci = ci;
  rung.co = co;
  if ((rung.e2 - rung.e1).norm() < p.min_length_m) return std::nullopt;
  rung.r = eq_6(ci, co, (rung.e2 - rung.e1).norm());
  if (rung.r < p.xi) return std::nullopt;  // Eq. (7)
  rung.members = ids_of(g, id);
  return rung;
}

bool correct_position(const Graph& g, const ladder::PaperParams& p, Rung& rung) {
  const Vector3d n = (rung.e2 - rung.e1).normalized();
  const Vector3d e1 = rung.e1;
  std::set<int> starts;
  for (std::size_t j = 0; j < g.h.size(); ++j) {
    if (rung.members.count(g.id[j]) > 0) starts.insert(static_cast<int>(j));
  }
  const std::vector<int> id = mark_members(g, e1, n, starts, p);
  rung.members = ids_of(g, id);
  if (rung.members.empty()) return false;
  rung.ci = static_cast<int>(std::count(id.begin(), id.end(), 1));
  rung.co = static_cast<int>(std::count(id.begin(), id.end(), 2));

  double low = 1e9, high = -1e9;
  for (std::size_t j = 0; j < g.h.size(); ++j) {
    if (id[j] == 0) continue;
    low = std::min(low, (g.h[j] - e1).dot(n));
    high = std::max(high, (g.h[j] - e1).dot(n));
  }
  const Vector3d b1 = e1 + low * n;
  const Vector3d b2 = e1 + high * n;
  const double l = (b1 - b2).norm();
  rung.r = l > 0.0 ? eq_6(rung.ci, rung.co, l) : 0.0;
  rung.e1 = b1;
  rung.e2 = b2;
  if (rung.ci == 0 || l == 0.0) return true;
  Vector3d err1 = Vector3d::Zero(), err2 = Vector3d::Zero();
  for (std::size_t j = 0; j < g.h.size(); ++j) {
    if (id[j] == 0) continue;
    const Vector3d off = (b1 - g.h[j]) - (b1 - g.h[j]).dot(n) * n;
    const double a = std::abs((b1 - g.h[j]).dot(n));
    const double b = std::abs((b2 - g.h[j]).dot(n));
    err1 += b / l * off;
    err2 += a / l * off;
  }
  rung.e1 = b1 - p.gamma * err1 / rung.ci;  // Eq. (8), (10)
  rung.e2 = b2 - p.gamma * err2 / rung.ci;  // Eq. (9), (11)
  return true;
}

void algorithm_3(const ladder::NodeCloud& cloud, const ladder::PaperParams& p, std::uint64_t seed,
                 std::vector<Rung>& rungs) {
  const Graph g = to_graph(cloud);
  std::vector<Rung> kept;
  for (Rung rung : rungs) {
    if (correct_position(g, p, rung)) kept.push_back(rung);
  }
  rungs = kept;
  merge(rungs, p);
  age(rungs, p);
  if (cloud.suspected.empty()) return;
  std::vector<int> eligible;
  for (int i = 0; i < cloud.num_nodes(); ++i) {
    if (is_eligible(cloud, i, p)) eligible.push_back(i);
  }
  const auto count = static_cast<std::uint32_t>(eligible.size());
  if (count < 2) return;
  base::Rng rng(seed, cloud.sequence);
  const int num_tries = p.tries / (static_cast<int>(rungs.size()) + 1);
  for (int t = 0; t < num_tries; ++t) {
    const int n1 = eligible[rng.below(count)];
    const int n2 = eligible[rng.below(count)];
    if (n1 == n2 || is_gated(cloud, n1, n2, p)) continue;
    std::optional<Rung> rung = algorithm_4(g, n1, n2, p);
    if (!rung) continue;
    const bool is_known = std::any_of(rungs.begin(), rungs.end(),
                                      [&](const Rung& known) { return is_same(known, *rung, p); });
    if (is_known) continue;
    rung->age = p.age_initial;
    rungs.push_back(*rung);
  }
}

}  // namespace rung_reference
