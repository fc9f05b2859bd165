// SPDX-License-Identifier: BSD-3-Clause
// FNV-1a over messages in their order: equal runs, equal numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace robot_in_a_box {

class ByteHash {
 public:
  void add(std::string_view channel, const void* bytes, std::size_t num_bytes) {
    for (const char c : channel) mix(static_cast<std::uint8_t>(c));
    const auto* first = static_cast<const std::uint8_t*>(bytes);
    for (std::size_t i = 0; i < num_bytes; ++i) mix(first[i]);
    ++num_messages_;
  }
  std::uint64_t value() const { return value_; }
  std::int64_t num_messages() const { return num_messages_; }

 private:
  void mix(std::uint8_t byte) { value_ = (value_ ^ byte) * 0x100000001B3ULL; }

  std::uint64_t value_ = 0xCBF29CE484222325ULL;
  std::int64_t num_messages_ = 0;
};

}  // namespace robot_in_a_box
