// SPDX-License-Identifier: BSD-3-Clause
// One process data object: which objects of the dictionary travel in which bytes, and the rules by
// which a master may change that (CiA 301, 7.5.2.36: invalidate, clear, map, count, validate).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "simulator/plant/bus_frame.h"
#include "simulator/plant/object_dictionary.h"

namespace simulator {

inline constexpr std::uint8_t kLastSynchronousType = 240;

class Pdo {
 public:
  explicit Pdo(std::uint16_t communication_index) : communication_index_(communication_index) {}

  /// Reads the communication and mapping objects anew.
  void configure(ObjectDictionary& dictionary);

  bool valid() const { return valid_; }
  std::uint32_t id() const { return id_; }
  bool synchronous() const { return type_ <= kLastSynchronousType; }
  std::uint8_t type() const { return type_; }
  std::int64_t event_us() const { return event_us_; }
  int length() const { return length_; }

  BusFrame packed() const;
  /// The frame must have at least length() bytes.
  void unpack(const BusFrame& frame) const;

 private:
  std::uint16_t communication_index_;
  bool valid_ = false;
  std::uint32_t id_ = 0;
  std::uint8_t type_ = 0;
  std::int64_t event_us_ = 0;
  int length_ = 0;
  int num_objects_ = 0;
  std::array<Object*, 8> objects_{};
};

/// Is this a communication or mapping object of a PDO?
bool belongs_to_pdo(std::uint16_t index);

/// Why this write would break the rules, or kNoAbort.
AbortCode check_pdo_write(const ObjectDictionary& dictionary, std::uint16_t index,
                          std::uint8_t subindex, std::uint32_t value);

}  // namespace simulator
