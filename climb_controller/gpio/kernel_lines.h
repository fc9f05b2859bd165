// SPDX-License-Identifier: BSD-3-Clause
// The five lines on a GPIO chip of the kernel, found by label and names whenever it is opened.
#pragma once

#include <array>
#include <memory>
#include <string>

#include "gpio/gpiod_chip.h"
#include "gpio/line_chip.h"

namespace gpio {

class KernelLines : public LineChip {
 public:
  /// `params` passed check(); its chip is a label. `chips` outlives the lines.
  KernelLines(const LinesParams& params, const Chips& chips);

  std::string open() override;
  ReadStatus read(Levels& levels) override;
  int wake_fd() const override { return chip_ ? chip_->wake_fd() : -1; }
  std::string loss() const override;

 private:
  LinesParams params_;
  const Chips& chips_;
  std::unique_ptr<GpiodChip> chip_;
  std::string path_;  ///< where it was last found
  bool is_lost_ = false;
};

}  // namespace gpio
