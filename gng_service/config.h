// SPDX-License-Identifier: BSD-3-Clause
// [gng] of the configuration as parameters of the library.
#pragma once

#include "ddgng/ddgng.h"
#include "runtime/config.h"

namespace gng_service {

/// Starts from the defaults, or with mode = "paper" from the paper's constants. Throws
/// runtime::ConfigError.
ddgng::DdgngParams read_params(runtime::ConfigTable table);

}  // namespace gng_service
