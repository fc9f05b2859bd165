// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/printable_text.h"

#include <cstdint>

namespace runtime {
namespace {

/// A code point and the bytes it took; 0 bytes when malformed (RFC 3629).
struct Decoded {
  std::uint32_t code_point = 0;
  std::size_t bytes = 0;
};

Decoded first_code_point(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t lead = byte(0);
  if (lead < 0x80) return {lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
  std::uint32_t code_point = lead & (0x7FU >> bytes);
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    code_point = code_point << 6 | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code_point >= 0xD800 && code_point <= 0xDFFF;
  if (code_point < kSmallest[bytes] || code_point > 0x10FFFF || is_surrogate) return {};
  return {code_point, bytes};
}

}  // namespace

bool is_printable_utf8(std::string_view text, LineBreaks line_breaks) {
  while (!text.empty()) {
    const auto [code_point, bytes] = first_code_point(text);
    if (bytes == 0) return false;
    const bool is_line_break = code_point == '\n' || code_point == '\t';
    const bool is_control = code_point < 0x20 || (code_point >= 0x7F && code_point < 0xA0);
    if (is_control && !(is_line_break && line_breaks == LineBreaks::kAllowed)) return false;
    text.remove_prefix(bytes);
  }
  return true;
}

}  // namespace runtime
