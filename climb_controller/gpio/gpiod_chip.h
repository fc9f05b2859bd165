// SPDX-License-Identifier: BSD-3-Clause
// The little that is asked of libgpiod, so that its versions 1 and 2, which share not one call,
// each take one file; which is built is decided at configure time. Searching by label and name,
// and words for what went wrong, are kernel_lines.cpp.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "gpio/line_params.h"

namespace gpio {

struct LineInfo {
  std::string name;
  bool is_used = false;
  std::string consumer;  ///< who uses it, in his own words
};

struct InputRequest {
  int offset = 0;
  Bias bias = Bias::kAsIs;
};
using InputRequests = std::array<InputRequest, kNumLines>;

/// One open chip. Closing gives its lines back.
class GpiodChip {
 public:
  virtual ~GpiodChip() = default;

  virtual std::string label() const = 0;
  virtual int num_lines() const = 0;
  virtual LineInfo line(int offset) const = 0;

  /// The five lines as inputs; 0 or errno, and then none is held.
  virtual int request(const InputRequests& inputs, bool with_edges) = 0;
  /// In the order of the request, after taking away waiting edges. False: the chip is gone.
  virtual bool read(Levels& levels) = 0;
  /// Readable at an edge; -1 without edges.
  virtual int wake_fd() const = 0;
};

/// The chips of a machine.
class Chips {
 public:
  virtual ~Chips() = default;
  /// Sorted.
  virtual std::vector<std::string> paths() const = 0;
  /// Null, and `error` is errno.
  virtual std::unique_ptr<GpiodChip> open(const std::string& path, int& error) const = 0;
};

/// /dev/gpiochip*, by the libgpiod that this program was built with.
class SystemChips : public Chips {
 public:
  std::vector<std::string> paths() const override;
  std::unique_ptr<GpiodChip> open(const std::string& path, int& error) const override;
};

/// Takes what waits at a non-blocking descriptor of edges; they have woken us, levels are read
/// anew.
void discard_edges(int fd);

/// Edges are read only to be discarded, and never waited for.
void make_non_blocking(int fd);

}  // namespace gpio
