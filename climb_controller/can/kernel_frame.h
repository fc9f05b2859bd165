// SPDX-License-Identifier: BSD-3-Clause
// CanFrame <-> the kernel's struct can_frame, as it crosses a raw CAN socket and the unix: line.
#pragma once

#include <linux/can.h>

#include "can/can_frame.h"

namespace can {

::can_frame to_kernel(const CanFrame& frame);

/// A dlc above 8 (the kernel never delivers one, a unix: peer may) becomes fd = true: not classic.
CanFrame from_kernel(const ::can_frame& kernel);

}  // namespace can
