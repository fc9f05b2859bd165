// SPDX-License-Identifier: BSD-3-Clause
// Algorithms 3 and 4 and Eq. (6)-(11) as the paper writes them (misprints resolved as in
// docs/EQUATIONS.md): whole matrices, repeated sweeps, no attention to time. The oracle of the
// library's paper mode.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include <Eigen/Core>

#include "ladder/node_cloud.h"
#include "ladder/params.h"

namespace rung_reference {

struct Graph {
  std::vector<int> id;
  std::vector<Eigen::Vector3d> h;    ///< node positions
  std::vector<std::vector<bool>> c;  ///< edges
};

struct Rung {
  Eigen::Vector3d e1, e2;
  std::set<int> members;  ///< node ids
  int ci = 0, co = 0;
  double r = 0.0;
  int age = 0;
};

Graph to_graph(const ladder::NodeCloud& cloud);

/// Algorithm 4 with Eq. (6) and (7).
std::optional<Rung> algorithm_4(const Graph& graph, int n1, int n2,
                                const ladder::PaperParams& params);

/// Eq. (8)-(11). False: no member left.
bool correct_position(const Graph& graph, const ladder::PaperParams& params, Rung& rung);

/// Algorithm 3: one frame.
void algorithm_3(const ladder::NodeCloud& cloud, const ladder::PaperParams& params,
                 std::uint64_t seed, std::vector<Rung>& rungs);

}  // namespace rung_reference
