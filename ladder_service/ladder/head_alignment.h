// SPDX-License-Identifier: BSD-3-Clause
// Where the heads really sit and how far they err in range: a small turn and shift of each and an
// error over range that they have in common, so that planes are flat and the same for every head,
// floors level, walls upright and ladders regular (seen_ladder.h). Held to what mountings and heads
// of this kind may have; what nothing shows stays zero, as does what all heads have in common and
// gravity does not show. Learnt from the cloud as it came: no estimate feeds itself. Other bars
// teach nothing, they only show how far the heads are apart: what is seen of them depends on where
// they are seen from.
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "ladder/alignment_equations.h"
#include "ladder/bar.h"
#include "ladder/node_cloud.h"
#include "ladder/params.h"
#include "ladder/seen_ladder.h"

namespace ladder {

class HeadAlignment {
 public:
  explicit HeadAlignment(const LadderParams& params);

  /// The cloud with its moments corrected by what is known so far; without corrections the same
  /// one. Stands until the next call.
  const NodeCloud& correct(const NodeCloud& cloud);

  /// Learns from the cloud as it came and the bars and the ladder found in the corrected one.
  void learn(const NodeCloud& seen, const BarNodes& nodes, const BarSet& bars,
             const SeenLadder& ladder = {});

  void reset();
  /// How far the heads are apart on what they see together, without corrections; averaged.
  double misfit_m() const { return misfit_m_; }
  /// The heads are farther apart than well mounted ones.
  bool is_misfit() const { return is_misfit_; }
  /// Before, the heads may be off by more than their corrections yet say.
  bool is_settled() const { return !params_.enabled || num_frames_ >= params_.settle_frames; }
  /// How far what stands so far away may be off to the side: all heads may be turned by what none
  /// shows, and the two that see one end be shifted, as much as the others were seen to be wrong.
  double side_sigma_m(double range_m) const;
  const HeadCorrections& corrections() const { return corrections_; }
  double range_error_m(double range_m) const { return range_error_.at(range_m); }

 private:
  /// Points of one head on one surface or bar.
  struct Sample {
    int head = 0;
    Eigen::Vector3d point_m = Eigen::Vector3d::Zero();
    double variance_m2 = 0.0;  ///< of the mean across the surface
    double thickness = 0.0;    ///< variance across the surface / range^2
  };
  /// What every frame says alike, gravity or a ladder's regularity, counts once, however long it is
  /// looked at.
  class Told {
   public:
    void begin_frame(const AlignParams& params);
    /// What this frame may say, in parts of everything.
    double say();
    void end_frame() { sum_ += is_said_ ? share_ : 0.0; }

   private:
    double sum_ = 0.0;
    double share_ = 0.0;
    bool is_said_ = false;
  };
  /// A plane: samples lie along `normal` as a linear function of the other two directions.
  struct Surface {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitX();
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
  };

  void learn_plane(const NodeCloud& cloud, const BarNodes& nodes, int plane);
  void note_bar(const NodeCloud& cloud, const BarNodes& nodes, const BarSet& bars, const Bar& bar);
  void add_sample(const NodeCloud& cloud, const HeadMoment& moment, const Eigen::Vector3d& normal);
  void measure_noise();
  bool is_on_plane(const Plane& plane) const;
  bool is_at_corner(const NodeCloud& cloud, int plane, const Eigen::Vector3d& point_m) const;
  bool is_contested(const BarNodes& nodes, const Eigen::Vector3d& point_m) const;
  void add_surface(const NodeCloud& cloud, const Surface& surface);
  void add_gravity(const NodeCloud& cloud, int plane, const Surface& surface);
  void note_misfit(const Eigen::Vector3d& normal);
  void follow_misfit();
  void solve();

  AlignParams params_;
  AlignmentEquations equations_;
  HeadCorrections corrections_;
  RangeError range_error_;
  Told wall_, floor_, ladder_;
  std::vector<Sample> samples_;
  std::vector<double> thicknesses_;
  std::vector<double> misfits_m_;  ///< of this frame: each head on each surface and bar
  double misfit_m_ = 0.0;
  int num_frames_ = 0;
  int num_misfits_ = 0;
  bool is_misfit_ = false;
  NodeCloud aligned_;
};

}  // namespace ladder
