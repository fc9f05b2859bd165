// SPDX-License-Identifier: BSD-3-Clause
// climb_controller: rungs, inertial samples and orders in; servo frames, state and pose out. The
// control cycle runs in a thread of its own (control_thread.h); here is what talks LCM.
#pragma once

#include "runtime/service.h"

namespace climb_controller {

runtime::ServiceDescription description();

}  // namespace climb_controller
