// SPDX-License-Identifier: BSD-3-Clause
// A score as JSON for programs and as a table for people.
#pragma once

#include <string>

#include "simulator/score/scorer.h"

namespace simulator {

/// One object; a metric that was not measured is null. Without truth the keys that need it are left
/// out.
std::string to_json(const Score& score);
std::string to_text(const Score& score);

}  // namespace simulator
