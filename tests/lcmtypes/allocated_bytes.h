// SPDX-License-Identifier: BSD-3-Clause
// A program that links allocated_bytes.cpp counts what it allocates with new.
#pragma once

#include <cstddef>

namespace lcmtypes {

/// Sum of all sizes asked of operator new since the start.
std::size_t allocated_bytes();

}  // namespace lcmtypes
