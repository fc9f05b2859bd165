// SPDX-License-Identifier: BSD-3-Clause
// [sensor] of the configuration as parameters of the library.
#pragma once

#include "runtime/config.h"
#include "tof/params.h"

namespace sensor_service {

/// Throws runtime::ConfigError.
tof::TofParams read_params(runtime::ConfigTable table);

}  // namespace sensor_service
