// SPDX-License-Identifier: BSD-3-Clause
// Algorithm 2: how much a node's place deserves nodes.
#pragma once

#include "ddgng/params.h"

namespace ddgng {

/// delta of a node inside or outside the suspected area (Alg. 2; set, not added per object).
// PAPER: the line that raises delta is cut in the text; docs/EQUATIONS.md
inline float strength(const GrowingParams& params, bool inside) {
  return inside ? params.strength_inside : params.strength_outside;
}

/// delta^p relative to the outside: the weight of an error at insertion.
inline float insertion_weight(const GrowingParams& params, bool inside) {
  const float ratio = strength(params, inside) / params.strength_outside;
  float weight = 1.0F;
  for (int i = 0; i < params.strength_exponent; ++i) weight *= ratio;
  return weight;
}

}  // namespace ddgng
