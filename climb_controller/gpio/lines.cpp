// SPDX-License-Identifier: BSD-3-Clause
#include "gpio/lines.h"

#include <algorithm>

#include <poll.h>

#include "base/check.h"

namespace gpio {

Lines::Lines(const LinesParams& params, LineChip& chip)
    : params_(params), chip_(chip), backoff_us_(params.first_reopen_us) {
  CHECK(check(params_).empty(), "check(params) comes first");
  for (int i = 0; i < kNumLines; ++i) debounces_.emplace_back(params_.line(i).debounce_us);
}

std::string Lines::open(int timeout_ms) {
  if (!is_open_) {
    open_error_ = chip_.open();
    if (!open_error_.empty()) return open_error_;
    is_open_ = true;
  }
  Levels levels{};
  ReadStatus status = chip_.read(levels);
  for (int waited_ms = 0; status == ReadStatus::kPending && waited_ms < timeout_ms; ++waited_ms) {
    pollfd waiting{chip_.wake_fd(), POLLIN, 0};
    ::poll(&waiting, 1, 1);
    status = chip_.read(levels);
  }
  if (status == ReadStatus::kDone) return "";
  is_open_ = false;
  open_error_ = status == ReadStatus::kLost
                    ? chip_.loss()
                    : params_.chip + " tells no levels; is the program behind it running?";
  return open_error_;
}

const LineStates& Lines::poll(std::int64_t now_us) {
  if (!is_open_ && !try_open(now_us)) return states_;
  Levels levels{};
  const ReadStatus status = chip_.read(levels);
  if (status == ReadStatus::kLost) {
    lose(now_us);
    return states_;
  }
  if (status == ReadStatus::kPending) return states_;  // lost, as it has been since it was opened
  are_levels_known_ = true;
  std::array<bool, kNumLines> active{};
  for (int i = 0; i < kNumLines; ++i) {
    active[i] = debounces_[i].update(now_us, levels[i]) != params_.line(i).active_low;
  }
  std::copy_n(active.begin(), kNumTouch, states_.touch.begin());
  states_.estop_active = active[kEstop];
  states_.lost = false;
  backoff_us_ = params_.first_reopen_us;
  return states_;
}

void Lines::lose(std::int64_t now_us) {
  if (are_levels_known_) ++num_losses_;
  are_levels_known_ = false;
  is_open_ = false;
  states_ = {};
  for (Debounce& debounce : debounces_) debounce.restart();
  next_attempt_us_ = now_us + backoff_us_;
  backoff_us_ = std::min(2 * backoff_us_, params_.longest_reopen_us);
}

bool Lines::try_open(std::int64_t now_us) {
  if (now_us < next_attempt_us_) return false;
  open_error_ = chip_.open();
  is_open_ = open_error_.empty();
  if (is_open_) return true;
  next_attempt_us_ = now_us + backoff_us_;
  backoff_us_ = std::min(2 * backoff_us_, params_.longest_reopen_us);
  return false;
}

std::string Lines::problem() const {
  return open_error_.empty() ? chip_.loss() : open_error_;
}

}  // namespace gpio
