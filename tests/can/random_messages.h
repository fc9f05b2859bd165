// SPDX-License-Identifier: BSD-3-Clause
// Random messages over the whole range of their fields.
#pragma once

#include <bit>
#include <cmath>

#include "base/rng.h"
#include "can/cia402.h"
#include "can/odrive.h"

namespace can {

template <class Integer>
Integer any(base::Rng& rng) {
  return static_cast<Integer>(rng.next() >> 16);
}

inline std::uint8_t any_node(base::Rng& rng, std::uint32_t last) {
  return static_cast<std::uint8_t>(1 + rng.below(last));
}

inline cia402::Rpdo1 random_rpdo1(base::Rng& rng, bool has_torque) {
  cia402::Rpdo1 pdo{any_node(rng, 127), any<std::uint16_t>(rng), any<std::int32_t>(rng), {}};
  if (has_torque) pdo.max_torque_permille = any<std::uint16_t>(rng);
  return pdo;
}

inline cia402::Tpdo1 random_tpdo1(base::Rng& rng, bool has_torque) {
  cia402::Tpdo1 pdo{any_node(rng, 127), any<std::uint16_t>(rng), any<std::int32_t>(rng), {}};
  if (has_torque) pdo.torque_permille = any<std::int16_t>(rng);
  return pdo;
}

/// Any finite float, by its bits.
inline float any_float(base::Rng& rng) {
  while (true) {
    const auto value = std::bit_cast<float>(any<std::uint32_t>(rng));
    if (std::isfinite(value)) return value;
  }
}

}  // namespace can
