// SPDX-License-Identifier: BSD-3-Clause
// What surfaces and bars that heads see say about where the heads sit and about the error of range
// that they have in common: normal equations, summed over frames. Each surface's own shape is
// unknown as well and is eliminated at once.
#pragma once

#include <array>

#include <Eigen/Core>

#include "ladder/node_cloud.h"

namespace ladder {

/// A point p of a head that stands at h lies at p + turn x (p - h) + shift.
struct HeadCorrection {
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();
};

using HeadCorrections = std::array<HeadCorrection, kNumHeads>;

/// Error of the measured range: piecewise linear between knots, constant beyond them.
class RangeError {
 public:
  static constexpr int kNumKnots = 28;
  static constexpr double kFirst_m = 0.2;
  static constexpr double kStep_m = 0.1;

  struct Place {
    int knot = 0;
    double share = 0.0;  ///< of the next knot
  };
  static Place place(double range_m);

  double at(double range_m) const;
  double& operator[](int knot) { return error_m_[knot]; }

 private:
  std::array<double, kNumKnots> error_m_{};
};

/// What is known of them beforehand: standard deviations about zero.
struct AlignmentPrior {
  double turn_rad = 0.0;
  double shift_m = 0.0;
  double range_m = 0.0;
};

class AlignmentEquations {
 public:
  static constexpr int kMaxShape = 3;

  /// A head's point on a surface, and how the surface's shape moves it along the normal there.
  struct Sample {
    int head = 0;
    Eigen::Vector3d arm_m = Eigen::Vector3d::Zero();  ///< from the head to the point
    double off_m = 0.0;                               ///< along the normal, from any fixed place
    std::array<double, kMaxShape> shape{};            ///< 0 for what the surface does not have
    double weight = 0.0;                              ///< 1 / variance
  };

  void clear();
  /// Older frames count less from here on.
  void forget(double keep);
  void begin_surface(const Eigen::Vector3d& normal);
  void add(const Sample& sample);
  /// shape . coefficients = value, with this weight.
  void add_condition(const std::array<double, kMaxShape>& coefficients, double value,
                     double weight);
  void end_surface();

  /// False, and nothing written: the equations contradict each other.
  bool solve(const AlignmentPrior& prior, HeadCorrections& corrections, RangeError& error);

 private:
  static constexpr int kPerHead = 6;
  static constexpr int kNumUnknowns = kPerHead * kNumHeads + RangeError::kNumKnots;
  static constexpr int kNumInRow = kPerHead + 2;

  using Row = std::array<double, kNumUnknowns>;
  /// Lower triangle and right side.
  struct Normal {
    std::array<Row, kNumUnknowns> matrix{};
    Row right{};
  };

  bool factorize();

  Normal sum_, solution_;
  // The surface at hand.
  Eigen::Vector3d normal_ = Eigen::Vector3d::Zero();
  std::array<std::array<double, kMaxShape>, kNumUnknowns> coupling_{};
  std::array<bool, kNumUnknowns> is_touched_{};
  Eigen::Matrix3d shape_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d shape_right_ = Eigen::Vector3d::Zero();
};

}  // namespace ladder
