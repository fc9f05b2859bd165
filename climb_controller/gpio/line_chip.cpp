// SPDX-License-Identifier: BSD-3-Clause
#include "gpio/line_chip.h"

#include "gpio/kernel_lines.h"
#include "gpio/unix_lines.h"

namespace gpio {

std::unique_ptr<LineChip> make_line_chip(const LinesParams& params) {
  constexpr const char* kUnixPrefix = "unix:";
  if (params.chip.starts_with(kUnixPrefix)) {
    return std::make_unique<UnixLines>(params.chip.substr(5));
  }
  static const SystemChips chips;
  return std::make_unique<KernelLines>(params, chips);
}

}  // namespace gpio
