// SPDX-License-Identifier: BSD-3-Clause
// Why an incoming message was not used. One counter of health_t (rejected_*) per cause.
#pragma once

#include <cstdint>
#include <string_view>

namespace runtime {

enum class Reject : std::uint8_t {
  kNone,         ///< not rejected
  kSize,         ///< empty, larger than the type's bound, or cut short
  kFingerprint,  ///< another type or version
  kCount,        ///< an array count negative, above its bound or beyond the message
  kString,       ///< a length below 1 or above its bound, no NUL at the end, or one inside
  kTrailing,     ///< bytes behind the end
  kDepth,        ///< nested too deep
  kValue,        ///< not finite, out of range, index out of range, counts that disagree
  kStale,        ///< seq or utime went backwards, or the same message twice
};

inline constexpr int kNumRejects = 9;  ///< kNone included

/// "size" for kSize: the part behind rejected_ in health_t; "none" for kNone.
constexpr std::string_view name(Reject reject) {
  constexpr std::string_view kNames[kNumRejects] = {
      "none", "size", "fingerprint", "count", "string", "trailing", "depth", "value", "stale"};
  return kNames[static_cast<std::uint8_t>(reject)];
}

}  // namespace runtime
