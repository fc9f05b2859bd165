// SPDX-License-Identifier: BSD-3-Clause
// The only place that asks the operating system for the time.
#pragma once

#include <cstdint>

#include "base/clock.h"

namespace runtime {

/// CLOCK_MONOTONIC and CLOCK_REALTIME.
base::Now clock_now();

}  // namespace runtime
