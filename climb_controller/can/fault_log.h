// SPDX-License-Identifier: BSD-3-Clause
// Faults in the order seen, each (cause, axis) once, until cleared. Never allocates after
// construction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/check.h"
#include "can/fault.h"

namespace can {

class FaultLog {
 public:
  explicit FaultLog(int num_axes) : seen_(static_cast<std::size_t>(num_axes) + 1) {
    faults_.reserve(seen_.size() * kNumFaultCauses);
  }

  /// False if this cause is already noted for this axis.
  bool raise(const Fault& fault) {
    CHECK(fault.axis >= -1 && fault.axis + 1 < static_cast<int>(seen_.size()), "axis of this bus");
    std::uint32_t& seen = seen_[static_cast<std::size_t>(fault.axis + 1)];
    const std::uint32_t bit = 1U << static_cast<unsigned>(fault.cause);
    if ((seen & bit) != 0) return false;
    seen |= bit;
    faults_.push_back(fault);
    return true;
  }

  void clear() {
    faults_.clear();
    for (std::uint32_t& seen : seen_) seen = 0;
  }

  std::span<const Fault> all() const { return faults_; }

  /// Something more than a warning.
  bool forbids_enabling() const {
    for (const Fault& fault : faults_) {
      if (fault.cause != FaultCause::kWarning) return true;
    }
    return false;
  }

 private:
  std::vector<std::uint32_t> seen_;  ///< bits of FaultCause; [0] is the whole bus
  std::vector<Fault> faults_;
};

}  // namespace can
