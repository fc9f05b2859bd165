// SPDX-License-Identifier: BSD-3-Clause
// Where the heads really sit: a small turn and shift of each, so that they agree on planes, rungs
// and rails, and planes on gravity. Learnt from frame to frame, held to the mounting's tolerance,
// and only where the heads disagree by more than their own phase error explains. What all heads
// have in common and gravity does not show stays unknown.
#pragma once

#include <array>

#include <Eigen/Core>

#include "ladder/bar.h"
#include "ladder/node_cloud.h"
#include "ladder/params.h"

namespace ladder {

/// A point p of a head that stands at h lies at p + turn x (p - h) + shift.
struct HeadCorrection {
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
};

using HeadCorrections = std::array<HeadCorrection, kNumHeads>;

class HeadAlignment {
 public:
  explicit HeadAlignment(const LadderParams& params);

  /// The cloud with its moments corrected by what is known so far; without corrections the same
  /// one. Stands until the next call.
  const NodeCloud& correct(const NodeCloud& cloud);

  /// Learns from a corrected cloud and the bars found in it.
  void learn(const NodeCloud& cloud, const BarNodes& nodes, const BarSet& bars);

  void reset();
  /// How far the heads are apart on what they see together, without corrections; averaged.
  double misfit_m() const { return misfit_m_; }
  bool is_correcting() const { return is_correcting_; }
  const HeadCorrections& corrections() const { return corrections_; }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  /// What one head's points say about its correction, as normal equations.
  struct Equations {
    Matrix6 information = Matrix6::Zero();
    Vector6 right = Vector6::Zero();
  };
  /// Points of one head on one surface or bar.
  struct Sample {
    int head = 0;
    Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
  };

  void sample_plane(const NodeCloud& cloud, int plane);
  void sample_bar(const NodeCloud& cloud, const BarNodes& nodes, const BarSet& bars,
                  const Bar& bar);
  void add_distances(const NodeCloud& cloud, const Eigen::Vector3d& normal, double num_points);
  void follow_misfit();
  void solve(const NodeCloud& cloud);

  AlignParams params_;
  HeadCorrections corrections_;
  std::array<Equations, kNumHeads> equations_;
  std::vector<Sample> samples_;
  std::vector<double> misfits_m_;  ///< of this frame: each head on each surface and bar
  double misfit_m_ = 0.0;
  bool is_correcting_ = false;
  NodeCloud aligned_;
};

}  // namespace ladder
