// SPDX-License-Identifier: BSD-3-Clause
// What a fault of the servo bus means to the climbing controller: one table.
#pragma once

#include <span>

#include "can/fault.h"
#include "climb/failsafe.h"

namespace climb_controller {

climb::Fault meaning_of(can::FaultCause cause);

/// All of them as one set.
climb::FaultFlags flags_of(std::span<const can::Fault> faults);

}  // namespace climb_controller
