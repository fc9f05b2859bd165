// SPDX-License-Identifier: BSD-3-Clause
// Who moves next and how far the body goes before it. Order and shift were the best of those tried
// on the simulated robot: least peak torque and grip force.
#pragma once

#include "climb/leg.h"

namespace climb {

inline constexpr PerLeg<Leg> kStepOrder = {kRearRight, kFrontRight, kRearLeft, kFrontLeft};

/// The leg after `last`, on the way up or back down (then in reverse order).
Leg next_leg(Leg last, bool upwards);

/// Along the ladder, before each limb: a quarter of the rungs' distance; negative on the way down.
double body_shift_m(double rung_spacing_m, bool upwards);

/// Four claws on four rungs: the only stance to rest in, as any one rung may break.
bool is_staggered(const PerLeg<int>& rung_ids);

}  // namespace climb
