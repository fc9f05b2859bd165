// SPDX-License-Identifier: BSD-3-Clause
// Whole lines from a descriptor (a pipe, a terminal) as they come, without ever waiting.
#pragma once

#include <string>
#include <vector>

namespace simulator {

class LineReader {
 public:
  /// Does not own the descriptor; makes it non-blocking.
  explicit LineReader(int descriptor);

  /// Without their ends; a line that is not finished stays for later. Lines longer than 4096 bytes
  /// are dropped. Nothing after the other side has closed.
  std::vector<std::string> take();
  int descriptor() const { return descriptor_; }  ///< -1 when closed

 private:
  int descriptor_;
  std::string unfinished_;
};

}  // namespace simulator
