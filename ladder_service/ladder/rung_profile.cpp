// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/rung_profile.h"

#include "ladder/rectangular_bar.h"

namespace ladder {
namespace {

constexpr double kKeep = 0.9;  // of older frames
constexpr int kMinRungs = 3;
// As much as rungs seen from different heights in five frames differ: with less, nothing is said.
constexpr double kLeast = 0.04;
// The height grows by this share of what a square one's would: square ones .77 to 1.33, round ones
// less than .6, before nothing up to .8 but explained to .69 only (tuning seeds).
constexpr double kMinSlope = 0.7;
constexpr double kMaxSlope = 1.5;
// So much of the differences must come from the angle.
constexpr double kMinExplained = 0.72;
// Nearer, few rungs are seen whole: from the dock, 0.3 m before it, two of 37 round ladders looked
// square (run).
constexpr double kMinRange_m = 0.45;

}  // namespace

void RungProfile::learn(const std::vector<MeasuredBar>& bars, const Eigen::Vector3d& up) {
  seen_.clear();
  double weight = 0.0, expected = 0.0, measured_m = 0.0;
  for (const MeasuredBar& bar : bars) {
    if (bar.is_stub() || bar.is_wide || !bar.is_whole() || !(bar.radius_m > 0.0)) continue;
    if (bar.range_m < kMinRange_m) return;
    const Seen seen{square_height(bar.depth.dot(up)), bar.radius_m, bar.weight};
    seen_.push_back(seen);
    weight += seen.weight;
    expected += seen.weight * seen.expected;
    measured_m += seen.weight * seen.measured_m;
  }
  if (static_cast<int>(seen_.size()) < kMinRungs) return;
  expected /= weight;
  measured_m /= weight;
  xx_ *= kKeep;
  xy_ *= kKeep;
  yy_ *= kKeep;
  for (const Seen& seen : seen_) {
    const double x = seen.expected / expected - 1.0;
    const double y = seen.measured_m / measured_m - 1.0;
    xx_ += seen.weight / weight * x * x;
    xy_ += seen.weight / weight * x * y;
    yy_ += seen.weight / weight * y * y;
  }
}

bool RungProfile::is_square() const {
  return xx_ > kLeast && xy_ > kMinSlope * xx_ && xy_ < kMaxSlope * xx_ &&
         xy_ * xy_ > kMinExplained * xx_ * yy_;
}

}  // namespace ladder
