// SPDX-License-Identifier: BSD-3-Clause
#include "gng_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace reference {
namespace {

float squared_distance(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const Eigen::Vector3f d = a - b;
  return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
}

}  // namespace

void Gng::start(const Eigen::Vector3f& h1_m, const Eigen::Vector3f& h2_m) {
  for (const Eigen::Vector3f& h : {h1_m, h2_m}) {
    Node node;
    node.h_m = h;
    node.strength = p_.strength_outside;
    place(node);
  }
}

void Gng::signal(const Eigen::Vector3f& v) {
  // 4.1 Winners, ties to the lowest slot.
  const int num_slots = static_cast<int>(nodes_.size());
  int s1 = -1;
  for (int i = 0; i < num_slots; ++i) {
    if (!nodes_[i].alive) continue;
    if (s1 < 0 || squared_distance(v, nodes_[i].h_m) < squared_distance(v, nodes_[s1].h_m)) s1 = i;
  }
  int s2 = -1;
  for (int i = 0; i < num_slots; ++i) {
    if (!nodes_[i].alive || i == s1) continue;
    if (s2 < 0 || squared_distance(v, nodes_[i].h_m) < squared_distance(v, nodes_[s2].h_m)) s2 = i;
  }
  // 4.2 Edge.
  if (edge(s1, s2) == nullptr) {
    make_room(s1);
    make_room(s2);
    edges_.push_back({s1, s2, 0});
  }
  for (Edge& e : edges_) {
    if ((e.a == s1 && e.b == s2) || (e.a == s2 && e.b == s1)) e.age = 0;
  }
  // 4.3 Error and utility.
  const float d1 = squared_distance(v, nodes_[s1].h_m);
  const float d2 = squared_distance(v, nodes_[s2].h_m);
  nodes_[s1].error += d1;
  nodes_[s1].utility += d2 - d1;
  // 4.4 Move, rule A; ages.
  for (int i = 0; i < num_slots; ++i) {
    if (!nodes_[i].alive) continue;
    Eigen::Vector3f& h = nodes_[i].h_m;
    if (i == s1) h += p_.winner_rate * (v - h);
    if (i != s1 && edge(s1, i) != nullptr) h += p_.neighbour_rate * (v - h);
  }
  for (Edge& e : edges_) {
    const bool at_s1 = e.a == s1 || e.b == s1;
    const bool at_s2 = e.a == s2 || e.b == s2;
    if (at_s1 && !at_s2) e.age += 1;
  }
  std::vector<int> lost_an_edge;
  for (const Edge& e : edges_) {
    if (e.age > p_.max_edge_age) lost_an_edge.insert(lost_an_edge.end(), {e.a, e.b});
  }
  edges_.erase(std::remove_if(edges_.begin(), edges_.end(),
                              [&](const Edge& e) { return e.age > p_.max_edge_age; }),
               edges_.end());
  for (const int i : lost_an_edge) {
    if (nodes_[i].alive && degree(i) == 0) remove(i);
  }
  // 4.6 Decay.
  for (Node& node : nodes_) {
    const bool inside = node.strength > p_.strength_outside;
    node.error *= 1.0 - p_.error_decay;
    node.utility *= 1.0 - (inside ? p_.utility_decay_inside : p_.utility_decay_outside);
  }
}

int Gng::insert(double strength_exponent, const InSuspectedBox& inside) {
  if (num_nodes() >= p_.max_nodes) return -1;
  int u = -1;
  int f = -1;
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    if (!nodes_[i].alive || degree(i) == 0) continue;
    if (u >= 0) decided(weighted_error(u, strength_exponent), weighted_error(i, strength_exponent));
    if (u < 0 || weighted_error(i, strength_exponent) > weighted_error(u, strength_exponent)) u = i;
  }
  if (u < 0) return -1;
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    if (edge(u, i) == nullptr) continue;
    if (f >= 0) decided(weighted_error(f, strength_exponent), weighted_error(i, strength_exponent));
    if (f < 0 || weighted_error(i, strength_exponent) > weighted_error(f, strength_exponent)) f = i;
  }
  separate(u, f);
  for (const int parent : {u, f}) {
    nodes_[parent].error *= 1.0 - p_.error_cut;
    nodes_[parent].utility *= 1.0 - p_.error_cut;
  }
  Node node;
  node.h_m = 0.5F * (nodes_[u].h_m + nodes_[f].h_m);
  node.error = (nodes_[u].error + nodes_[f].error) / 2;
  node.utility = (nodes_[u].utility + nodes_[f].utility) / 2;
  node.strength = inside(node.h_m) ? p_.strength_inside : p_.strength_outside;
  const int r = place(node);
  edges_.push_back({u, r, 0});
  edges_.push_back({f, r, 0});
  return r;
}

int Gng::remove_useless() {
  if (num_nodes() <= p_.min_utility_nodes) return -1;
  int u = -1;
  int l = -1;
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    if (!nodes_[i].alive) continue;
    if (l >= 0) decided(nodes_[l].utility, nodes_[i].utility);
    if (u < 0 || nodes_[i].error > nodes_[u].error) u = i;
    if (l < 0 || nodes_[i].utility < nodes_[l].utility) l = i;
  }
  decided(nodes_[u].error, p_.utility_threshold * nodes_[l].utility);
  if (!(nodes_[u].error > p_.utility_threshold * nodes_[l].utility)) return -1;
  remove(l);
  return l;
}

void Gng::set_strengths(const InSuspectedBox& inside) {
  for (Node& node : nodes_) {
    if (node.alive) node.strength = inside(node.h_m) ? p_.strength_inside : p_.strength_outside;
  }
}

const Edge* Gng::edge(int a, int b) const {
  for (const Edge& e : edges_) {
    if ((e.a == a && e.b == b) || (e.a == b && e.b == a)) return &e;
  }
  return nullptr;
}

int Gng::degree(int i) const {
  int degree = 0;
  for (const Edge& e : edges_) degree += e.a == i || e.b == i ? 1 : 0;
  return degree;
}

int Gng::num_nodes() const {
  int num = 0;
  for (const Node& node : nodes_) num += node.alive ? 1 : 0;
  return num;
}

double Gng::take_narrowest_lead() {
  const double lead = narrowest_lead_;
  narrowest_lead_ = 1.0;
  return lead;
}

int Gng::place(const Node& node) {
  int slot = 0;
  while (slot < static_cast<int>(nodes_.size()) && nodes_[slot].alive) ++slot;
  if (slot == static_cast<int>(nodes_.size())) nodes_.emplace_back();
  nodes_[slot] = node;
  nodes_[slot].alive = true;
  return slot;
}

void Gng::remove(int i) {
  nodes_[i] = Node{};
  edges_.erase(std::remove_if(edges_.begin(), edges_.end(),
                              [i](const Edge& e) { return e.a == i || e.b == i; }),
               edges_.end());
}

void Gng::separate(int a, int b) {
  edges_.erase(std::remove_if(
                   edges_.begin(), edges_.end(),
                   [=](const Edge& e) { return (e.a == a && e.b == b) || (e.a == b && e.b == a); }),
               edges_.end());
}

// The bound of ours: a full node gives up its oldest edge, of equals the one to the lowest slot.
void Gng::make_room(int i) {
  if (degree(i) < p_.max_degree) return;
  int oldest = -1;
  for (int j = 0; j < static_cast<int>(nodes_.size()); ++j) {
    if (edge(i, j) == nullptr) continue;
    if (oldest < 0 || edge(i, j)->age > edge(i, oldest)->age) oldest = j;
  }
  separate(i, oldest);
}

void Gng::decided(double best, double other) {
  if (best == 0.0 && other == 0.0) return;  // exact in any arithmetic
  const double scale = std::max(std::abs(best), std::abs(other));
  narrowest_lead_ = std::min(narrowest_lead_, std::abs(best - other) / scale);
}

double Gng::weighted_error(int i, double exponent) const {
  return nodes_[i].error * std::pow(nodes_[i].strength, exponent);
}

}  // namespace reference
