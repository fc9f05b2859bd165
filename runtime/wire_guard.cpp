// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/wire_guard.h"

#include <array>
#include <cstring>

namespace runtime {
namespace {

constexpr int kMaxDepth = 16;
constexpr std::size_t kMaxFields = 128;  // of one type; wire_tables.py refuses more

std::int64_t element_bytes(WireKind kind) {
  switch (kind) {
    case WireKind::kBoolean:
    case WireKind::kByte:
    case WireKind::kInt8:
      return 1;
    case WireKind::kInt16:
      return 2;
    case WireKind::kInt32:
    case WireKind::kFloat:
      return 4;
    case WireKind::kInt64:
    case WireKind::kDouble:
      return 8;
    case WireKind::kString:
    case WireKind::kNested:
      break;
  }
  return 0;
}

/// Goes over the bytes of one message; every step checks before it moves.
class Walker {
 public:
  explicit Walker(std::span<const std::uint8_t> rest) : rest_(rest) {}

  bool at_end() const { return rest_.empty(); }

  Reject walk(const WireType& type, int depth) {
    if (depth > kMaxDepth) return Reject::kDepth;
    std::array<std::int32_t, kMaxFields> counts{};  // at the places of the count fields
    for (std::size_t i = 0; i < type.fields.size(); ++i) {
      const WireField& field = type.fields[i];
      const std::int32_t elements = field.count_index < 0 ? field.fixed : counts[field.count_index];
      Reject reject = Reject::kNone;
      if (field.kind == WireKind::kString) {
        reject = walk_string(field.limit);
      } else if (field.kind == WireKind::kNested) {
        reject = walk_nested(*field.nested, elements, depth + 1);
      } else if (field.limit >= 0) {
        reject = walk_count(field.limit, counts[i]);
      } else {
        reject = walk_array(field, elements);
      }
      if (reject != Reject::kNone) return reject;
    }
    return Reject::kNone;
  }

 private:
  std::int64_t rest_bytes() const { return static_cast<std::int64_t>(rest_.size()); }

  void skip(std::int64_t bytes) { rest_ = rest_.subspan(static_cast<std::size_t>(bytes)); }

  Reject walk_count(std::int32_t limit, std::int32_t& count) {
    if (!read_int32(count)) return Reject::kSize;
    return count < 0 || count > limit ? Reject::kCount : Reject::kNone;
  }

  Reject walk_array(const WireField& field, std::int32_t elements) {
    const std::int64_t bytes = elements * element_bytes(field.kind);
    if (bytes > rest_bytes()) return field.count_index < 0 ? Reject::kSize : Reject::kCount;
    skip(bytes);
    return Reject::kNone;
  }

  /// On the wire: length with the final NUL (int32), the bytes, the NUL.
  Reject walk_string(std::int32_t limit) {
    std::int32_t length = 0;
    if (!read_int32(length)) return Reject::kSize;
    if (length < 1 || length - 1 > limit || length > rest_bytes()) return Reject::kString;
    const auto size = static_cast<std::size_t>(length);
    if (std::memchr(rest_.data(), 0, size) != rest_.data() + (size - 1)) return Reject::kString;
    skip(length);
    return Reject::kNone;
  }

  Reject walk_nested(const WireType& type, std::int32_t elements, int depth) {
    if (elements > rest_bytes()) return Reject::kCount;  // each takes a byte at least
    for (std::int32_t i = 0; i < elements; ++i) {
      const Reject reject = walk(type, depth);
      if (reject != Reject::kNone) return reject;
    }
    return Reject::kNone;
  }

  bool read_int32(std::int32_t& value) {
    if (rest_.size() < 4) return false;
    value =
        static_cast<std::int32_t>(std::uint32_t{rest_[0]} << 24 | std::uint32_t{rest_[1]} << 16 |
                                  std::uint32_t{rest_[2]} << 8 | std::uint32_t{rest_[3]});
    skip(4);
    return true;
  }

  std::span<const std::uint8_t> rest_;
};

std::uint64_t read_fingerprint(std::span<const std::uint8_t> message) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : message.first(8)) value = value << 8 | byte;
  return value;
}

}  // namespace

Reject check_wire(std::span<const std::uint8_t> message, const WireType& type,
                  std::size_t max_bytes) {
  if (message.size() < 8 || message.size() > max_bytes) return Reject::kSize;
  if (read_fingerprint(message) != type.fingerprint) return Reject::kFingerprint;
  Walker walker(message.subspan(8));
  const Reject reject = walker.walk(type, 0);
  if (reject != Reject::kNone) return reject;
  return walker.at_end() ? Reject::kNone : Reject::kTrailing;
}

}  // namespace runtime
