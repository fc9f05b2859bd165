// SPDX-License-Identifier: BSD-3-Clause
// What lies above and below a level bar, across the view: nothing beside a rung, much beside a
// strip of a surface.
#pragma once

#include "ladder/bar.h"
#include "ladder/params.h"

namespace ladder {

struct Flanks {
  double own = 0.0;    ///< points within the half height
  double twice = 0.0;  ///< points within twice the half height
  double above = 0.0;  ///< points in the band next to it
  double below = 0.0;

  double larger() const { return above > below ? above : below; }
};

/// All zero when the bar is seen along its axis.
Flanks measure_flanks(const BarNodes& nodes, const Bar& bar, const BarParams& params);

}  // namespace ladder
