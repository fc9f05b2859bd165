// SPDX-License-Identifier: BSD-3-Clause
// Row 29 of the fault table: drives that lack an object, or keep another value, must never be armed
// for climbing, and the object must be named.
#pragma once

#include "robot_in_a_box/drill.h"

namespace robot_in_a_box {

/// Every axis in turn is the odd one.
RowScore drill_configuration(const DrillRow& row);
/// What is told about row 29.
const DrillRow& configuration_row();

}  // namespace robot_in_a_box
