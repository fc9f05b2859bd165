// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/wire_target.h"

#include <algorithm>
#include <array>

#include "runtime/base/check.h"
#include "runtime/wire_guard.h"
#include "tests/lcmtypes/sample_messages.h"

namespace fuzz {
namespace {

using lcmtypes::kNumTypes;
using runtime::Reject;

constexpr std::uint8_t kRepairBelow = 128;

template <class Msg>
Reject check_message(std::span<const std::uint8_t> bytes) {
  Msg message{};
  const Reject reject = runtime::decode_guarded(bytes, message);
  const bool has_sound_wire =
      runtime::check_wire(bytes, runtime::kWireTypeOf<Msg>) == Reject::kNone;
  CHECK(has_sound_wire == (reject == Reject::kNone || reject == Reject::kValue),
        "what the wire guard accepts, decode must take in full");
  if (reject != Reject::kNone) return reject;
  CHECK(runtime::encodable(message), "an accepted message may be sent on");
  const std::vector<std::uint8_t> again = lcmtypes::encode(message);
  CHECK(std::equal(again.begin(), again.end(), bytes.begin(), bytes.end()),
        "an accepted message encodes to the same bytes");
  return reject;
}

template <class Msg>
std::vector<std::uint8_t> encoded_sample(int size, std::uint64_t seed) {
  return lcmtypes::encode(lcmtypes::sample<Msg>(size, seed));
}

/// f<Msg> of each type, by index.
template <class... Msg>
constexpr auto checks(std::type_identity<std::tuple<Msg...>>) {
  return std::array{&check_message<Msg>...};
}
template <class... Msg>
constexpr auto samples(std::type_identity<std::tuple<Msg...>>) {
  return std::array{&encoded_sample<Msg>...};
}

constexpr std::type_identity<lcmtypes::AllMessages> kAll;

}  // namespace

Reject check_bytes(std::span<const std::uint8_t> input) {
  if (input.empty()) return Reject::kSize;
  const std::size_t type_index = input[0] % kNumTypes;
  // An exact copy, so that the address sanitizer sees a read one byte behind the end.
  std::vector<std::uint8_t> bytes(input.begin() + 1, input.end());
  if (input[0] < kRepairBelow && bytes.size() >= 8) {
    const std::uint64_t fingerprint = runtime::kWireTypes[type_index]->fingerprint;
    for (std::size_t i = 0; i < 8; ++i) {
      bytes[i] = static_cast<std::uint8_t>(fingerprint >> (56 - 8 * i));
    }
  }
  return checks(kAll)[type_index](bytes);
}

std::vector<std::uint8_t> sound_input(std::size_t type_index, int size, std::uint64_t seed) {
  std::vector<std::uint8_t> input = samples(kAll)[type_index](size, seed);
  input.insert(input.begin(), static_cast<std::uint8_t>(type_index));
  return input;
}

}  // namespace fuzz
