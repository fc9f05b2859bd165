// SPDX-License-Identifier: BSD-3-Clause
#include "climb/step_order.h"

namespace climb {

Leg next_leg(Leg last, bool upwards) {
  int place = 0;
  while (kStepOrder[place] != last) ++place;
  return kStepOrder[(place + (upwards ? 1 : kNumLegs - 1)) % kNumLegs];
}

double body_shift_m(double rung_spacing_m, bool upwards) {
  return (upwards ? 0.25 : -0.25) * rung_spacing_m;
}

bool is_staggered(const PerLeg<int>& rung_ids) {
  for (int i = 0; i < kNumLegs; ++i) {
    for (int j = 0; j < i; ++j) {
      if (rung_ids[i] == rung_ids[j]) return false;
    }
  }
  return true;
}

}  // namespace climb
