// SPDX-License-Identifier: BSD-3-Clause
// The plant's truth in one line, for people and for scripts that watch from outside: how many
// drives are enabled or hold after a quick stop, which rung each claw holds, how high the body is.
#pragma once

#include <string>

#include "simulator/plant/robot_plant.h"

namespace simulator {

/// "enabled 16  claws 3* 3* - 1*  z 0.842 m  docked  E-STOP  FALLEN"; '*' = the touch switch is
/// pressed; "stopped 16" behind the first number where drives stand after a quick stop.
std::string truth_line(const PlantTruth& truth);

}  // namespace simulator
