// SPDX-License-Identifier: BSD-3-Clause
// A fuzzer without a fuzzer: samples, damaged at random with a fixed seed, go through the same
// check as under libFuzzer. LADDER_MUTATIONS sets how many (default 200000).
#include <cstdlib>
#include <limits>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "runtime/base/rng.h"
#include "tests/fuzz/wire_target.h"
#include "tests/lcmtypes/all_types.h"

namespace fuzz {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::size_t any_place(const Bytes& bytes, base::Rng& rng) {
  return rng.below(static_cast<std::uint32_t>(bytes.size()));
}

void overwrite_int32(Bytes& bytes, base::Rng& rng) {
  constexpr std::int32_t kInteresting[] = {
      0, 1, -1, 127, 255, 32768, 1048576, 0x20000001, 0x40000001, INT32_MAX, INT32_MIN, 0x7fc00000};
  const auto value = static_cast<std::uint32_t>(kInteresting[rng.below(std::size(kInteresting))]);
  const std::size_t start = any_place(bytes, rng);
  for (std::size_t i = 0; i < 4 && start + i < bytes.size(); ++i) {
    bytes[start + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
  }
}

void mutate(Bytes& bytes, base::Rng& rng) {
  if (bytes.empty()) return;
  switch (rng.below(6)) {
    case 0:
      bytes[any_place(bytes, rng)] ^= static_cast<std::uint8_t>(1U << rng.below(8));
      break;
    case 1:
      bytes[any_place(bytes, rng)] = static_cast<std::uint8_t>(rng.next());
      break;
    case 2:
      overwrite_int32(bytes, rng);
      break;
    case 3:
      bytes.resize(any_place(bytes, rng));
      break;
    case 4:
      bytes.insert(bytes.end(), 1 + rng.below(16), static_cast<std::uint8_t>(rng.next()));
      break;
    default:
      bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(any_place(bytes, rng)));
  }
}

int num_mutations() {
  const char* asked = std::getenv("LADDER_MUTATIONS");
  return asked == nullptr ? 200000 : std::stoi(asked);
}

// Undamaged samples of every type and size are accepted.
TEST(WireMutation, SamplesAreSound) {
  for (std::size_t type = 0; type < lcmtypes::kNumTypes; ++type) {
    for (const int size : {0, 1, 4}) {
      EXPECT_EQ(check_bytes(sound_input(type, size, 1)), runtime::Reject::kNone) << type;
    }
  }
}

// Damaged messages are refused or are messages: check_bytes ends the process otherwise. Every cause
// that bytes alone can have comes up, and so does acceptance: the mutations reach all of the guard.
TEST(WireMutation, DamagedMessagesAreRefusedOrMeanWhatTheySay) {
  base::Rng rng(20240521);
  std::map<std::string_view, int> verdicts;
  for (int i = 0; i < num_mutations(); ++i) {
    Bytes input =
        sound_input(rng.below(lcmtypes::kNumTypes), static_cast<int>(rng.below(3)), rng.next());
    if (rng.below(4) == 0) input[0] = static_cast<std::uint8_t>(input[0] + 130);
    for (std::uint32_t edits = 1 + rng.below(3); edits > 0; --edits) mutate(input, rng);
    ++verdicts[runtime::name(check_bytes(input))];
  }
  for (const char* verdict :
       {"none", "size", "fingerprint", "count", "string", "trailing", "value"}) {
    EXPECT_GT(verdicts[verdict], 0) << verdict;
    RecordProperty(verdict, verdicts[verdict]);
  }
}

}  // namespace
}  // namespace fuzz
