// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/ladder.h"

#include <algorithm>
#include <optional>

#include "base/check.h"
#include "ladder/affordance.h"
#include "ladder/default_mode.h"
#include "ladder/paper_mode.h"

namespace ladder {

struct LadderTracker::Modes {
  explicit Modes(const LadderParams& params) : affordance(params) {
    if (params.mode == Mode::kPaper) {
      paper_mode.emplace(params);
    } else {
      default_mode.emplace(params);
    }
    estimate.rungs.reserve(params.max_tracks);
    const int max_rails = std::max(2 + params.max_bars, params.max_tracks);
    estimate.rails.reserve(max_rails);
    estimate.grasps.reserve(params.max_tracks);
    const AffordanceParams& p = params.affordance;
    const auto num_samples = static_cast<std::size_t>(p.max_length_m / p.step_m) + 2;
    estimate.intervals.reserve(num_samples * params.max_tracks);
    surfaces.reserve(params.max_tracks);
    rails.reserve(max_rails);
  }

  std::optional<DefaultMode> default_mode;  ///< one of the two
  std::optional<PaperMode> paper_mode;
  Affordance affordance;
  NodeCloud nothing;
  std::vector<RungSurface> surfaces;
  std::vector<RailLine> rails;
  std::optional<std::uint64_t> last_sequence;
  LadderEstimate estimate;
};

LadderTracker::LadderTracker(const LadderParams& params) {
  CHECK(check(params).empty(), "ladder parameters contradict each other");
  modes_ = std::make_unique<Modes>(params);
}

LadderTracker::~LadderTracker() = default;
LadderTracker::LadderTracker(LadderTracker&&) noexcept = default;
LadderTracker& LadderTracker::operator=(LadderTracker&&) noexcept = default;

void LadderTracker::reset() {
  if (modes_->default_mode) modes_->default_mode->reset();
  if (modes_->paper_mode) modes_->paper_mode->reset();
  modes_->last_sequence.reset();
  modes_->estimate.state = LadderState::kUnknown;
  modes_->estimate.sequence = 0;
  modes_->estimate.spacing_m = modes_->estimate.spacing_sigma_m = 0.0;
  modes_->estimate.rungs.clear();
  modes_->estimate.rails.clear();
  modes_->estimate.intervals.clear();
  modes_->estimate.grasps.clear();
}

HeadFit LadderTracker::head_fit() const {
  if (!modes_->default_mode) return {};
  const HeadAlignment& alignment = modes_->default_mode->alignment();
  return {alignment.misfit_m(), alignment.is_misfit()};
}

const LadderEstimate& LadderTracker::update(const NodeCloud& cloud) {
  Modes& m = *modes_;
  if (m.last_sequence == cloud.sequence) return m.estimate;
  m.last_sequence = cloud.sequence;
  m.estimate.sequence = cloud.sequence;
  const NodeCloud& usable = is_consistent(cloud) ? cloud : m.nothing;
  if (m.default_mode) m.default_mode->update(usable, m.estimate, m.surfaces, m.rails);
  if (m.paper_mode) m.paper_mode->update(usable, m.estimate, m.surfaces, m.rails);
  m.affordance.find(m.surfaces, m.rails, cloud.body_position_m.cast<double>(), m.estimate);
  return m.estimate;
}

}  // namespace ladder
