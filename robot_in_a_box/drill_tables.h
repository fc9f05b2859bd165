// SPDX-License-Identifier: BSD-3-Clause
// The parts that the fault table is written down in.
#pragma once

#include "robot_in_a_box/drill_case.h"

namespace robot_in_a_box {

std::span<const DrillRow> rows_of_messages();  ///< 1..3, 28, 31
std::span<const DrillRow> rows_of_grasps();    ///< 4..10
std::span<const DrillRow> rows_of_drives();    ///< 11..19
std::span<const DrillRow> rows_of_process();   ///< 20..26, 32
std::span<const DrillRow> rows_of_senses();    ///< 27, 30

}  // namespace robot_in_a_box
