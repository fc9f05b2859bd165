// SPDX-License-Identifier: BSD-3-Clause
// The parts that the fault table is written down in.
#pragma once

#include "robot_in_a_box/drill_case.h"

namespace robot_in_a_box {

std::span<const DrillRow> rows_of_grasps();   ///< 1..10
std::span<const DrillRow> rows_of_drives();   ///< 11..19
std::span<const DrillRow> rows_of_process();  ///< 20..32

}  // namespace robot_in_a_box
