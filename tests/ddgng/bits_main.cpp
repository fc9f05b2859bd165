// SPDX-License-Identifier: BSD-3-Clause
// Prints one hash per instruction set of this machine: they are all the same, here and elsewhere.
// usage: ddgng_bits [signals, default 1000000]
#include <cinttypes>
#include <cstdio>
#include <cstdlib>

#include <hwy/targets.h>

#include "tests/ddgng/bits.h"

int main(int argc, char** argv) {
  const int num_signals = argc > 1 ? std::atoi(argv[1]) : 1'000'000;
  bool same = true;
  std::uint64_t first = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const std::uint64_t bits = ddgng::bits_after(num_signals);
    if (first == 0) first = bits;
    same = same && bits == first;
    std::printf("%016" PRIx64 " after %d signals on %s\n", bits, num_signals,
                hwy::TargetName(target));
  }
  return same ? 0 : 1;
}
