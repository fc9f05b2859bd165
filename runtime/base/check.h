// SPDX-License-Identifier: BSD-3-Clause
// CHECK(condition, "message"): a broken invariant of our own is reported and ends the process, in
// every build. Not for bad input: that is a value (see docs/ARCHITECTURE.md, "Errors").
#pragma once

#include <cstdio>
#include <cstdlib>

namespace base {

[[noreturn]] inline void check_failed(const char* condition, const char* message, const char* file,
                                      int line) {
  std::fprintf(stderr, "%s:%d: broken invariant: %s (%s)\n", file, line, message, condition);
  std::abort();
}

}  // namespace base

#define CHECK(condition, message)     \
  ((condition) ? static_cast<void>(0) \
               : ::base::check_failed(#condition, message, __FILE__, __LINE__))
