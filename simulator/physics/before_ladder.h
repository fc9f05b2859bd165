// SPDX-License-Identifier: BSD-3-Clause
// The climbing robot before a scene's ladder: where it starts and what its claws may meet.
#pragma once

#include "simulator/plant/plant_params.h"
#include "simulator/scene.h"

namespace simulator {

/// `params` with the scene's rungs, docked (or gripping) before the lowest of them: rear claws at
/// the lowest rung that leaves the knees clear of the floor, front claws two spacings above. The
/// scene's ladder stands upright and is not turned; std::invalid_argument when it has no rungs
/// there.
PlantParams before_ladder(const Scene& scene, PlantParams params = {});

}  // namespace simulator
