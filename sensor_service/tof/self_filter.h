// SPDX-License-Identifier: BSD-3-Clause
// Drops the pixels that hit the robot's own limbs. Looks only where a limb is in the image.
#pragma once

#include "tof/filter.h"
#include "tof/limbs.h"
#include "tof/projection.h"

namespace tof {

/// `rays` fit the frame. Returns how many pixels were dropped.
int drop_limbs(const DepthFrame& frame, const RayTable& rays, const Limbs& limbs,
               FilteredImage& image);

}  // namespace tof
