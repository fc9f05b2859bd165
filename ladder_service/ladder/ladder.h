// SPDX-License-Identifier: BSD-3-Clause
// The door of the library: a topological structure in, the ladder with its rungs and where they may
// be grasped out. Output depends on the parameters and the clouds since construction or reset()
// alone; no allocation after construction.
#pragma once

#include <memory>

#include "ladder/estimate.h"
#include "ladder/node_cloud.h"
#include "ladder/params.h"

namespace ladder {

/// How well the heads agree (head_alignment.h).
struct HeadFit {
  double misfit_m = 0.0;   ///< without corrections
  bool is_misfit = false;  ///< they sit elsewhere than configured
};

class LadderTracker {
 public:
  /// check(params) must be "".
  explicit LadderTracker(const LadderParams& params);
  ~LadderTracker();
  LadderTracker(LadderTracker&&) noexcept;
  LadderTracker& operator=(LadderTracker&&) noexcept;

  /// Takes one frame. A cloud with the sequence number of the previous one is the same frame and
  /// changes nothing; an inconsistent cloud counts as an empty one. The estimate stands until the
  /// next call.
  const LadderEstimate& update(const NodeCloud& cloud);

  /// What the default mode thinks of the heads' mounting; nothing else ever corrects.
  HeadFit head_fit() const;

  /// Forgets all rungs: a new recording, or a jump of the robot's pose.
  void reset();

 private:
  struct Modes;
  std::unique_ptr<Modes> modes_;
};

}  // namespace ladder
