// SPDX-License-Identifier: BSD-3-Clause
// Algorithm 3: known rungs are corrected and aged, look-alikes merged, and random pairs of nodes
// tried for new ones.
#pragma once

#include <span>
#include <vector>

#include "ladder/adjacency.h"
#include "ladder/node_cloud.h"
#include "ladder/paper_rung.h"
#include "ladder/params.h"
#include "ladder/rung_correction.h"
#include "ladder/rung_evaluation.h"

namespace ladder {

/// The merge rule: nearly parallel, and the middle of b near the line of a.
bool is_same_rung(const PaperRung& a, const PaperRung& b, const PaperParams& params);

class RungTracker {
 public:
  explicit RungTracker(const LadderParams& params);
  void update(const NodeCloud& cloud);
  void reset();

  /// Rungs and rails alike, oldest first.
  std::span<const PaperRung> rungs() const {
    return {rungs_.data(), static_cast<std::size_t>(num_rungs_)};
  }

 private:
  void correct_all(const NodeCloud& cloud);
  void merge_look_alikes();
  void age_all();
  void draw_candidates(const NodeCloud& cloud);
  void try_pair(const NodeCloud& cloud, int n1, int n2);
  void collect_eligible(const NodeCloud& cloud);
  bool passes_gate(const NodeCloud& cloud, int n1, int n2) const;
  void remove(int index);

  LadderParams params_;
  Adjacency graph_;
  RungCorrection correction_;
  RungEvaluation evaluation_;
  std::vector<PaperRung> rungs_;  ///< the first num_rungs_ live; the others keep their memory
  int num_rungs_ = 0;
  int next_id_ = 1;
  std::vector<int> eligible_;
};

}  // namespace ladder
