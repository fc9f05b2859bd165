// SPDX-License-Identifier: BSD-3-Clause
// [sensor] of the configuration as parameters of the library and of the sources.
#pragma once

#include "runtime/config.h"
#include "sources/params.h"
#include "tof/params.h"

namespace sensor_service {

/// Throws runtime::ConfigError.
tof::TofParams read_params(runtime::ConfigTable table);

/// Throws runtime::ConfigError. All tables are read whatever the source is, so that one file serves
/// them all.
sources::SourceParams read_source_params(runtime::ConfigTable table);

}  // namespace sensor_service
