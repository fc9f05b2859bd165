// SPDX-License-Identifier: BSD-3-Clause
// GNG with utility and strength exactly as the equations read: plain lists, every value touched at
// every signal, loops over everything. Slow on purpose; the oracle of ddgng::Growing.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "ddgng/params.h"

namespace reference {

struct Node {
  bool alive = false;
  Eigen::Vector3f h_m = Eigen::Vector3f::Zero();
  double error = 0.0;     ///< E
  double utility = 0.0;   ///< U
  double strength = 1.0;  ///< delta
};

struct Edge {
  int a = 0;
  int b = 0;
  int age = 0;
};

using InSuspectedBox = std::function<bool(const Eigen::Vector3f&)>;

class Gng {
 public:
  explicit Gng(const ddgng::GrowingParams& params) : p_(params) {}

  void start(const Eigen::Vector3f& h1_m, const Eigen::Vector3f& h2_m);
  void signal(const Eigen::Vector3f& v);                               // 4.1 - 4.4, 4.6
  int insert(double strength_exponent, const InSuspectedBox& inside);  // 4.5, -1 = none
  int remove_useless();                                                // 4.7, -1 = none
  void set_strengths(const InSuspectedBox& inside);                    // Algorithm 2

  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Edge>& edges() const { return edges_; }
  const Edge* edge(int a, int b) const;
  int degree(int i) const;
  int num_nodes() const;

  /// The smallest relative lead by which any choice since the last call was decided: below the
  /// rounding of float, another implementation may rightly choose otherwise.
  double take_narrowest_lead();

 private:
  int place(const Node& node);
  void remove(int i);
  void separate(int a, int b);
  void make_room(int i);
  void decided(double best, double other);
  double weighted_error(int i, double exponent) const;

  ddgng::GrowingParams p_;
  std::vector<Node> nodes_;
  std::vector<Edge> edges_;
  double narrowest_lead_ = 1.0;
};

}  // namespace reference
