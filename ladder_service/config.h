// SPDX-License-Identifier: BSD-3-Clause
// [ladder] of the configuration as parameters of the library.
#pragma once

#include "ladder/params.h"
#include "runtime/config.h"

namespace ladder_service {

/// Starts from the defaults, or with mode = "paper" from the paper's constants. Throws
/// runtime::ConfigError.
ladder::LadderParams read_params(runtime::ConfigTable table);

}  // namespace ladder_service
