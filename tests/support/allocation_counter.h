// SPDX-License-Identifier: BSD-3-Clause
// A program that links `allocation_counter` counts what it takes from the heap: all that operator
// new is asked for, and, where the C library lets it (glibc without a sanitizer), malloc itself,
// which Eigen asks directly.
#pragma once

#include <cstddef>

namespace test_support {

std::size_t num_allocations();  ///< since the start
std::size_t allocated_bytes();  ///< sum of the sizes asked for

/// False under sanitizers: then only operator new is counted.
bool counts_malloc();

}  // namespace test_support
