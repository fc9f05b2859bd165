// SPDX-License-Identifier: BSD-3-Clause
// What a message may cost in memory before it is trusted: refused by the guard, nothing; accepted,
// not much more than its own size.
#include <gtest/gtest.h>

#include "runtime/wire_guard.h"
#include "tests/lcmtypes/sample_messages.h"
#include "tests/lcmtypes/wire_edit.h"
#include "tests/support/allocation_counter.h"

namespace lcmtypes {
namespace {

using runtime::Reject;
using test_support::allocated_bytes;

template <class Msg>
std::size_t bytes_allocated_for(const std::vector<std::uint8_t>& message, Msg& out,
                                Reject& verdict) {
  const std::size_t before = allocated_bytes();
  verdict = runtime::decode_guarded(message, out);
  return allocated_bytes() - before;
}

template <class Msg>
void expect_refused_for_free(const std::vector<std::uint8_t>& message) {
  Msg out{};
  Reject verdict{};
  EXPECT_EQ(bytes_allocated_for(message, out, verdict), 0U);
  EXPECT_NE(verdict, Reject::kNone);
}

template <class Msg>
void check_type() {
  const auto& type = runtime::kWireTypeOf<Msg>;
  SCOPED_TRACE(type.name);
  const auto bytes = encode(sample<Msg>(3, 1));
  Msg out{};
  Reject verdict{};
  // Vectors hold what the wire holds; the twofold is for strings, which round their capacity up.
  EXPECT_LE(bytes_allocated_for(bytes, out, verdict), 2 * bytes.size());
  EXPECT_EQ(verdict, Reject::kNone);
  EXPECT_EQ(bytes_allocated_for(bytes, out, verdict), 0U) << "the second time memory is reused";

  for (const Place& place : places(bytes, type)) {
    if (place.field->limit < 0) continue;
    for (const std::int32_t value : {-1, place.field->limit, 0x40000001, 0x7fffffff}) {
      auto damaged = bytes;
      write_int32(damaged, place.offset, value);
      expect_refused_for_free<Msg>(damaged);
    }
  }
  auto trailing = bytes;
  trailing.push_back(0);
  expect_refused_for_free<Msg>(trailing);
  const std::vector<std::uint8_t> truncated(bytes.begin(), bytes.end() - 1);
  expect_refused_for_free<Msg>(truncated);
}

// No message costs more than twice its bytes, a refused one nothing, a repeated one nothing.
TEST(Allocation, IsBoundedByTheMessage) {
  for_each_message_type([]<class Msg>(std::type_identity<Msg>) { check_type<Msg>(); });
}

}  // namespace
}  // namespace lcmtypes
