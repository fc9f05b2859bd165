// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's entry. Without a corpus it starts from samples: one mutation in eight replaces the
// input by one.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "runtime/base/rng.h"
#include "tests/fuzz/wire_target.h"
#include "tests/lcmtypes/all_types.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t max);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  fuzz::check_bytes({bytes, size});
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size,
                                               std::size_t max, unsigned int seed) {
  base::Rng rng(seed);
  if (rng.below(8) == 0) {
    const auto sample =
        fuzz::sound_input(rng.below(lcmtypes::kNumTypes), static_cast<int>(rng.below(4)), seed);
    if (sample.size() <= max) {
      std::copy(sample.begin(), sample.end(), bytes);
      size = sample.size();
    }
  }
  return LLVMFuzzerMutate(bytes, size, max);
}
