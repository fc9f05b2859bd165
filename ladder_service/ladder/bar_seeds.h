// SPDX-License-Identifier: BSD-3-Clause
// Where a bar may begin: nodes whose neighbourhood is stretched out level or upright.
#pragma once

#include <cstdint>
#include <vector>

#include "ladder/axis.h"
#include "ladder/bar_nodes.h"
#include "ladder/params.h"

namespace ladder {

struct Seed {
  Axis axis;
  double linearity = 0.0;  ///< ratio of the first two variances
  int node = 0;            ///< index into the nodes
  bool upright = false;
};

struct SeedSearch {
  double neighborhood_m = 0.0;
  bool upright_too = true;
};

/// Replaces `seeds` by those of the nodes not marked in `taken` (as long as nodes), which are left
/// out of the neighbourhoods too. Most stretched first. Needs capacity for as many as nodes.
void find_seeds(const BarNodes& nodes, const BarParams& params, const SeedSearch& search,
                const std::vector<std::uint8_t>& taken, std::vector<Seed>& seeds);

}  // namespace ladder
