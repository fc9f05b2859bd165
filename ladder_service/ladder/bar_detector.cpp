// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/bar_detector.h"

#include <algorithm>
#include <cmath>

#include "ladder/rectangular_bar.h"
#include "ladder/weighted_median.h"

namespace ladder {
namespace {

/// So many frames tell what a ladder's rungs are like, thick or thin, round or square: then the
/// robot may climb it, and its own legs hide parts of them (run: round ones looked square).
constexpr int kSettledFrames = 100;
/// Rungs that look thinner than this share of that are hidden in part: a leg before two of three
/// took a quarter, for some hundred frames (run).
constexpr double kThin = 0.9;
constexpr double kThinGain = 0.001;      ///< ... and should they be thin, it is learnt so slowly
constexpr double kOtherLadder_m = 0.25;  ///< a rail so far off is another ladder's

}  // namespace

BarDetector::BarDetector(const LadderParams& params)
    : params_(params),
      alignment_(params),
      nodes_(params),
      search_(params),
      test_(params),
      measurement_(params),
      profile_(params.max_bars) {
  found_.bars.reserve(params.max_bars);
  found_.rails.reserve(params.max_bars);
  used_.reserve(params.max_bars);
  deep_.reserve(params.max_bars);
  radii_.reserve(params.max_bars);
  ladder_.rungs.reserve(params.max_bars);
  heights_m_.reserve(params.max_bars);
  levels_.reserve(params.max_bars);
}

const Detections& BarDetector::detect(const NodeCloud& seen) {
  found_.bars.clear();
  found_.rails.clear();
  const NodeCloud& cloud = alignment_.correct(seen);
  nodes_.gather(cloud);
  const Eigen::Vector3d body_m = cloud.body_position_m.cast<double>();
  const BarSet& bars = search_.search(nodes_, body_m);
  const LadderHypothesis& ladder = test_.find(nodes_, bars, body_m);
  used_.assign(bars.rungs.size(), 0);
  found_.is_ladder = false;
  ladder_.left = -1;
  ladder_.rungs.clear();
  if (ladder.found()) measure_ladder(cloud, bars, ladder);
  for (int i = 0; i < static_cast<int>(bars.rails.size()); ++i) {
    if (found_.is_ladder && (i == ladder.left || i == ladder.right)) continue;
    found_.rails.push_back(
        measurement_.measure_rail({cloud, nodes_, bars}, bars.rails[i], Eigen::Vector3d::Zero()));
  }
  measure_others(cloud, bars);
  alignment_.learn(seen, nodes_, bars, ladder_);
  return found_;
}

void BarDetector::measure_ladder(const NodeCloud& cloud, const BarSet& bars,
                                 const LadderHypothesis& ladder) {
  const BarFrame frame{cloud, nodes_, bars};
  const Bar& left_bar = bars.rails[ladder.left];
  const Bar& right_bar = bars.rails[ladder.right];
  const Eigen::Vector3d across = left_bar.axis.across(right_bar.axis.origin_m);
  MeasuredRail left = measurement_.measure_rail(frame, left_bar, across);
  MeasuredRail right = measurement_.measure_rail(frame, right_bar, across);
  // Rails are parallel.
  const Eigen::Vector3d along =
      left_bar.support() * left.axis.direction + right_bar.support() * right.axis.direction;
  left.axis.direction = right.axis.direction = unit(along, left.axis.direction);
  found_.rails.assign({left, right});
  for (const Joint& joint : ladder.joints) {
    auto bar = measurement_.measure(frame, joint.bar, {&left, &right});
    if (!bar) continue;
    bar->on_ladder = true;
    found_.bars.push_back(*bar);
  }
  push_back_together();
  join_halves();
  drop_short_stubs();
  if (is_deep()) {
    // Shelf boards go on behind their edges: no ladder, and its bars are measured as free ones.
    found_.bars.clear();
    found_.rails.clear();
    return;
  }
  found_.is_ladder = true;
  for (const Joint& joint : ladder.joints) used_[joint.bar] = 1;
  keep_one_per_level();
  note_ladder(bars, ladder);
}

bool BarDetector::is_straight(const MeasuredBar& bar) const {
  const MeasureParams& p = params_.measure;
  // Heads that are far apart bend a rung that two of them see.
  const double most_sag_m = std::max(p.sag_flag_m, 2.0 * alignment_.misfit_m());
  return !bar.is_stub() && !bar.is_v && bar.sag_m <= most_sag_m && bar.bend_tan <= p.bent_flag_tan;
}

// A bent or broken rung, or one of another kind, stands where it stands.
bool BarDetector::is_exemplary(const MeasuredBar& bar) const {
  return is_straight(bar) && bar.tilt_sin <= params_.measure.tilt_flag_sin && bar.is_alike;
}

void BarDetector::note_ladder(const BarSet& bars, const LadderHypothesis& ladder) {
  ladder_.left = ladder.left;
  ladder_.right = ladder.right;
  const MeasuredRail& left = found_.rails[0];
  ladder_.up = left.axis.direction;
  ladder_.along = unit(left.axis.across(found_.rails[1].axis.origin_m), Eigen::Vector3d::UnitY());
  // Ascending; bars are kept in the order of their weights.
  std::vector<MeasuredBar>& rungs = found_.bars;
  std::sort(rungs.begin(), rungs.end(), [&](const MeasuredBar& a, const MeasuredBar& b) {
    const double height_a_m = left.axis.along(a.middle_m());
    const double height_b_m = left.axis.along(b.middle_m());
    return height_a_m < height_b_m || (height_a_m == height_b_m && a.bar < b.bar);
  });
  heights_m_.clear();
  for (const MeasuredBar& rung : rungs) {
    if (!is_exemplary(rung)) continue;
    const Axis& axis = bars.rungs[rung.bar].axis;
    const double trim_m = params_.measure.joint_trim_m;
    heights_m_.push_back(left.axis.along(rung.middle_m()));
    ladder_.rungs.push_back({rung.bar, 0, axis.along(rung.end0_m) + trim_m,
                             axis.along(rung.end1_m) - trim_m, rung.front_m,
                             params_.measure.whole_height * (rung.radius_m - rung.lost_m)});
  }
  levels_.assign(heights_m_.size(), 0);
  number_levels(heights_m_, params_.test, levels_);
  for (std::size_t i = 0; i < levels_.size(); ++i) ladder_.rungs[i].level = levels_[i];
  std::erase_if(ladder_.rungs, [](const SeenRung& rung) { return rung.level < 0; });
}

// The rungs of a ladder are alike: the median of their radii, by weight, is better known than each.
void BarDetector::push_back_together() {
  std::vector<MeasuredBar>& bars = found_.bars;
  if (bars.empty()) return;
  const Axis& rail = found_.rails[0].axis;
  const Eigen::Vector3d& up = rail.direction;
  if (rail.distance(known_rail_m_) > kOtherLadder_m) forget_rungs();
  known_rail_m_ = rail.origin_m;
  if (params_.measure.square_rungs && num_radii_ < kSettledFrames) profile_.learn(bars, up);
  const bool is_square = profile_.is_square();
  if (is_square != was_square_) num_radii_ = 0;
  was_square_ = is_square;
  if (is_square) {
    for (MeasuredBar& bar : bars) bar.radius_m /= square_height(bar.depth.dot(up));
  }
  const double radius_m = rung_radius_m();
  for (MeasuredBar& bar : bars) {
    // One of another kind keeps its own.
    bar.is_alike = std::abs(bar.radius_m - radius_m) <= params_.measure.radius_alike * radius_m;
    if (bar.is_alike) bar.radius_m = radius_m;
    if (is_square) {
      BarMeasurement::push_back_square(square_height(bar.depth.dot(up)), bar);
    } else {
      BarMeasurement::push_back(bar.radius_m, bar);
    }
  }
}

void BarDetector::forget_rungs() {
  profile_.reset();
  num_radii_ = 0;
}

// Of the straight ones while there are any: a bent one looks as thick as its bend is high.
double BarDetector::rung_radius_m() {
  const auto straight = [&](const MeasuredBar& bar) { return is_straight(bar); };
  const bool any_straight = std::any_of(found_.bars.begin(), found_.bars.end(), straight);
  if (!any_straight) return median_radius_m([](const MeasuredBar&) { return true; });
  const double radius_m = median_radius_m(straight);
  const bool is_known = num_radii_ == kSettledFrames;
  const bool is_thin = is_known && radius_m < kThin * known_radius_m_;
  if (!is_known) ++num_radii_;
  known_radius_m_ += (is_thin ? kThinGain : 1.0 / num_radii_) * (radius_m - known_radius_m_);
  return is_thin ? known_radius_m_ : radius_m;
}

template <class Counts>
double BarDetector::median_radius_m(const Counts& counts) {
  radii_.clear();
  for (const MeasuredBar& bar : found_.bars) {
    if (counts(bar)) radii_.emplace_back(bar.radius_m, bar.weight);
  }
  return weighted_median(radii_);
}

void BarDetector::join_halves() {
  const Eigen::Vector3d& up = found_.rails[0].axis.direction;
  std::vector<MeasuredBar>& bars = found_.bars;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    for (std::size_t j = 0; i < bars.size() && j < bars.size(); ++j) {
      const bool halves = i != j && bars[i].reaches_end0 && !bars[i].reaches_end1 &&
                          !bars[j].reaches_end0 && bars[j].reaches_end1;
      if (!halves) continue;
      MeasuredBar& left = bars[i];
      const MeasuredBar& right = bars[j];
      if (std::abs((left.end0_m - right.end1_m).dot(up)) > params_.test.v_height_m) continue;
      const double gap_m = std::sqrt((left.end1_m - right.end0_m).squaredNorm());
      if (gap_m > params_.test.v_gap_m) continue;
      left.end1_m = right.end1_m;
      left.reaches_end1 = true;
      left.is_v = true;
      left.weight += right.weight;
      left.num_inliers += right.num_inliers;
      bars.erase(bars.begin() + j);
      break;
    }
  }
}

void BarDetector::drop_short_stubs() {
  std::erase_if(found_.bars, [this](const MeasuredBar& bar) {
    return bar.is_stub() && bar.length_m() < params_.test.min_stub_length_m;
  });
}

bool BarDetector::is_deep() {
  if (found_.bars.empty()) return true;
  deep_.clear();
  for (const MeasuredBar& bar : found_.bars) deep_.push_back(bar.deep);
  const auto median = deep_.begin() + deep_.size() / 2;
  std::nth_element(deep_.begin(), median, deep_.end());
  return *median > params_.test.deep_max;
}

void BarDetector::keep_one_per_level() {
  std::vector<MeasuredBar>& bars = found_.bars;
  std::sort(bars.begin(), bars.end(), [](const MeasuredBar& a, const MeasuredBar& b) {
    return a.weight > b.weight || (a.weight == b.weight && a.bar < b.bar);
  });
  const Eigen::Vector3d& up = found_.rails[0].axis.direction;
  std::size_t num_kept = 0;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    const bool taken = std::any_of(bars.begin(), bars.begin() + num_kept, [&](const auto& kept) {
      return std::abs((bars[i].middle_m() - kept.middle_m()).dot(up)) < params_.test.same_level_m;
    });
    if (!taken) {
      const MeasuredBar bar = bars[i];
      bars[num_kept++] = bar;
    }
  }
  bars.resize(num_kept);
}

void BarDetector::measure_others(const NodeCloud& cloud, const BarSet& bars) {
  for (int i = 0; i < static_cast<int>(bars.rungs.size()); ++i) {
    if (used_[i] || static_cast<int>(found_.bars.size()) >= params_.max_bars) continue;
    auto bar = measurement_.measure({cloud, nodes_, bars}, i, {});
    if (!bar) continue;
    // The front of a board is flat.
    if (!bars.rungs[i].wide) BarMeasurement::push_back(bar->radius_m, *bar);
    found_.bars.push_back(*bar);
  }
}

}  // namespace ladder
