// SPDX-License-Identifier: BSD-3-Clause
// Which pixels of a depth image are believed. In this order: range, confidence, wrapped distances,
// flying pixels, isolated pixels. Integer arithmetic on whole rows; no pixel is changed, only kept
// or dropped.
#pragma once

#include <cstdint>
#include <vector>

#include "tof/depth_frame.h"
#include "tof/params.h"

namespace tof {

/// The pixels of one frame that were kept, row by row as in the frame; 0 = no return or dropped.
struct FilteredImage {
  std::vector<std::int16_t> depth_mm;
  int num_kept = 0;
};

class Filter {
 public:
  explicit Filter(const FilterParams& params);

  /// The frame must be sound (find_fault). Allocates only when an image is larger than all before.
  ///
  /// Range: the head's own range_min .. range_max, both included, compared with the distance as
  /// delivered (along the axis or along the ray).
  ///
  /// Wrapped distances, for wrap_range_m > 0: a reading r stands for r, r + wrap, r + 2 wrap ... .
  /// Echoes fade with the square of the distance, so a surface one wrap farther has at most the
  /// confidence of white there, 255 / (1 + ((r + wrap) / white_half_confidence_m)^2); a reading
  /// with no more is dropped, as is any reading at or beyond the wrap range. What it cannot tell: a
  /// true surface that is about (r / (r + wrap))^2 as bright as white or darker (4 % at 0.6 m, 20 %
  /// at 2 m, 25 % at the wrap range for wrap = 2.49 m) is dropped with the wrapped ones;
  /// retro-reflectors beyond the wrap range pass; without confidence, or with
  /// white_half_confidence_m = 0, nothing is told.
  ///
  /// Flying pixels lie between an edge and what is behind it: dropped when one 4-neighbour is
  /// nearer and one is farther by more than the step max(flying_step_m, flying_step_ratio * depth).
  /// The step grows with distance as noise does (1 % of range) and as a floor seen at a grazing
  /// angle does. No return on a side proves nothing. Neighbours that were dropped as isolated or
  /// flying still count: the result does not depend on the order of the pixels.
  ///
  /// Isolated: no 4-neighbour within the step. An image of one pixel is isolated.
  void apply(const DepthFrame& frame, FilteredImage& result);

 private:
  void gate(const DepthFrame& frame);
  void drop_edges(const DepthFrame& frame, FilteredImage& result) const;

  FilterParams params_;
  std::vector<std::int16_t> gated_mm_;  ///< with a border of one pixel without return
};

}  // namespace tof
