// SPDX-License-Identifier: BSD-3-Clause
// The guard against what LCM 1.3.1's generated decode does not survive, on every type.
#include "runtime/wire_guard.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lcmtypes/sample_messages.h"
#include "tests/lcmtypes/wire_edit.h"

namespace lcmtypes {
namespace {

using runtime::check_wire;
using runtime::decode_guarded;
using runtime::kWireTypeOf;
using runtime::Reject;
using runtime::WireKind;
using ::testing::AnyOf;

template <class Tuple>
struct AsTypes;
template <class... Msg>
struct AsTypes<std::tuple<Msg...>> {
  using Types = ::testing::Types<Msg...>;
};

template <class Msg>
class WireGuard : public ::testing::Test {};
TYPED_TEST_SUITE(WireGuard, AsTypes<AllMessages>::Types);

// What encode writes is accepted, decodes, and encodes again to the same bytes; for empty, small
// and larger messages.
TYPED_TEST(WireGuard, RoundTripIsIdentical) {
  for (const int size : {0, 1, 2, 7}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const auto message = sample<TypeParam>(size, seed);
      ASSERT_TRUE(runtime::encodable(message));
      const auto bytes = encode(message);
      TypeParam decoded{};
      ASSERT_EQ(decode_guarded(bytes, decoded), Reject::kNone) << "size " << size;
      EXPECT_EQ(encode(decoded), bytes);
      EXPECT_TRUE(runtime::encodable(decoded));
    }
  }
}

// An object that held a larger message before gives the same result as a fresh one (the generated
// decode keeps the elements of an array whose new count is 0).
TYPED_TEST(WireGuard, ReusedObjectKeepsNothing) {
  TypeParam reused = sample<TypeParam>(5, 1);
  const auto bytes = encode(sample<TypeParam>(0, 2));
  ASSERT_EQ(decode_guarded(bytes, reused), Reject::kNone);
  EXPECT_TRUE(runtime::encodable(reused));
  EXPECT_EQ(encode(reused), bytes);
}

// Every proper prefix is refused, as too short unless the cut falls into an array or a string.
TYPED_TEST(WireGuard, TruncationAtEveryByteIsRefused) {
  const auto bytes = encode(sample<TypeParam>(1, 3));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    // A copy of exact size lets the address sanitizer see a read behind the end.
    const std::vector<std::uint8_t> prefix(bytes.begin(), bytes.begin() + length);
    TypeParam decoded{};
    EXPECT_THAT(decode_guarded(prefix, decoded),
                AnyOf(Reject::kSize, Reject::kCount, Reject::kString))
        << length << " of " << bytes.size();
  }
}

// Empty, shorter than a fingerprint, and beyond the bound of the type: refused by size.
TYPED_TEST(WireGuard, SizeBounds) {
  const auto& type = kWireTypeOf<TypeParam>;
  const auto bytes = encode(sample<TypeParam>(1, 4));
  EXPECT_EQ(check_wire({}, type), Reject::kSize);
  EXPECT_EQ(check_wire(std::span(bytes).first(7), type), Reject::kSize);
  EXPECT_EQ(check_wire(bytes, type, bytes.size() - 1), Reject::kSize);
  EXPECT_EQ(check_wire(bytes, type, bytes.size()), Reject::kNone);
  std::vector<std::uint8_t> huge = bytes;
  huge.resize(type.max_bytes + 1);
  EXPECT_EQ(check_wire(huge, type), Reject::kSize);
}

// A message of another type or version is refused by its fingerprint, whatever byte differs.
TYPED_TEST(WireGuard, OtherFingerprintIsRefused) {
  for (std::size_t i = 0; i < 8; ++i) {
    auto bytes = encode(sample<TypeParam>(1, 5));
    bytes[i] ^= 0x10;
    TypeParam decoded{};
    EXPECT_EQ(decode_guarded(bytes, decoded), Reject::kFingerprint);
  }
}

// Bytes behind the end are refused (the generated decode accepts them), one or 4096.
TYPED_TEST(WireGuard, TrailingBytesAreRefused) {
  for (const std::size_t extra : {1U, 4U, 4096U}) {
    auto bytes = encode(sample<TypeParam>(0, 6));
    bytes.resize(bytes.size() + extra);
    const auto& type = kWireTypeOf<TypeParam>;
    EXPECT_EQ(check_wire(bytes, type, type.max_bytes + extra), Reject::kTrailing);
  }
}

// Each count of each type: negative, one above its bound, and the values that overflow the size
// check of the generated code.
TYPED_TEST(WireGuard, BadCountsAreRefused) {
  const auto& type = kWireTypeOf<TypeParam>;
  const auto bytes = encode(sample<TypeParam>(1, 7));
  for (const Place& place : places(bytes, type)) {
    if (place.field->kind != WireKind::kInt32 || place.field->limit < 0) continue;
    for (const std::int32_t count :
         {-1, std::numeric_limits<std::int32_t>::min(), place.field->limit + 1, 100'000'000,
          0x40000001, 0x20000001, std::numeric_limits<std::int32_t>::max()}) {
      auto damaged = bytes;
      write_int32(damaged, place.offset, count);
      TypeParam decoded{};
      EXPECT_EQ(decode_guarded(damaged, decoded), Reject::kCount)
          << place.field->name << " = " << count;
    }
  }
}

// Each count of each type at its bound, with far fewer elements present: refused.
TYPED_TEST(WireGuard, CountBeyondTheMessageIsRefused) {
  const auto& type = kWireTypeOf<TypeParam>;
  const auto bytes = encode(sample<TypeParam>(1, 8));
  for (const Place& place : places(bytes, type)) {
    if (place.field->kind != WireKind::kInt32 || place.field->limit < 0) continue;
    auto damaged = bytes;
    write_int32(damaged, place.offset, place.field->limit);
    TypeParam decoded{};
    EXPECT_EQ(decode_guarded(damaged, decoded), Reject::kCount) << place.field->name;
  }
}

// Each string of each type: length 0, negative, above its bound, beyond the message; NUL missing at
// the end or inside.
TYPED_TEST(WireGuard, BadStringsAreRefused) {
  const auto& type = kWireTypeOf<TypeParam>;
  const auto bytes = encode(sample<TypeParam>(2, 9));
  for (const Place& place : places(bytes, type)) {
    if (place.field->kind != WireKind::kString) continue;
    const auto expect_refused = [&](const std::vector<std::uint8_t>& damaged) {
      TypeParam decoded{};
      EXPECT_EQ(decode_guarded(damaged, decoded), Reject::kString) << place.field->name;
    };
    for (const std::int32_t length :
         {0, -1, std::numeric_limits<std::int32_t>::min(), place.field->limit + 2,
          static_cast<std::int32_t>(bytes.size() - place.offset - 3),
          std::numeric_limits<std::int32_t>::max()}) {
      auto damaged = bytes;
      write_int32(damaged, place.offset, length);
      expect_refused(damaged);
    }
    auto no_end = bytes;
    no_end[place.offset + 4 + place.elements - 1] = 'x';
    expect_refused(no_end);
    auto inner = bytes;
    inner[place.offset + 4] = 0;
    expect_refused(inner);
  }
}

// A type that contains itself is followed sixteen levels deep and no further.
TEST(WireGuardNested, DepthIsBounded) {
  static runtime::WireType list{"list_t", 0x1122334455667788U, 1000, {}};
  static const runtime::WireField fields[] = {{"num_next", WireKind::kInt32, 1, -1, 1},
                                              {"next", WireKind::kNested, 1, 0, -1, &list}};
  list.fields = fields;
  const auto chain = [](int levels) {
    std::vector<std::uint8_t> bytes{0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88};
    for (int level = 0; level <= levels; ++level) {
      bytes.insert(bytes.end(), {0, 0, 0, static_cast<std::uint8_t>(level < levels ? 1 : 0)});
    }
    return bytes;
  };
  EXPECT_EQ(check_wire(chain(0), list), Reject::kNone);
  EXPECT_EQ(check_wire(chain(16), list), Reject::kNone);
  EXPECT_EQ(check_wire(chain(17), list), Reject::kDepth);
  EXPECT_EQ(check_wire(chain(200), list), Reject::kDepth);
}

// An own mistake is caught before it is sent: a count that its vectors do not have would send heap
// memory, a string with a NUL would not arrive.
TEST(EncodeGuard, DisagreementIsRefused) {
  auto cloud = sample<ladder_msgs::point_cloud_t>(1, 1);
  cloud.num_points += 1;
  EXPECT_FALSE(runtime::encodable(cloud));
  cloud = sample<ladder_msgs::point_cloud_t>(1, 1);
  cloud.z_m.pop_back();
  EXPECT_FALSE(runtime::encodable(cloud));
  cloud = sample<ladder_msgs::point_cloud_t>(0, 1);
  cloud.num_points = -1;
  EXPECT_FALSE(runtime::encodable(cloud));

  auto event = sample<ladder_msgs::event_t>(1, 1);
  event.text.assign(500, 'x');
  EXPECT_TRUE(runtime::encodable(event));
  event.text.assign(501, 'x');
  EXPECT_FALSE(runtime::encodable(event));
  event.text = std::string("a\0b", 3);
  EXPECT_FALSE(runtime::encodable(event));
}

}  // namespace
}  // namespace lcmtypes
