// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/bus_walk.h"

namespace climb_controller {

using can::BusPhase;
using climb::DriveRequest;

namespace {
constexpr int kReadyCycles = 3;  // until every drive has told its state again
}

void BusWalk::step(std::int64_t now_us, bool unattended) {
  now_us_ = now_us;
  if (is_resetting_) return advance_reset();
  if (unattended && now_us >= next_bring_up_us_) bring_up();
}

void BusWalk::bring_up() {
  const BusPhase phase = bus_.phase();
  const bool asked = phase == BusPhase::kIdle      ? bus_.configure()
                     : phase == BusPhase::kFaulted ? bus_.rearm()
                                                   : false;
  if (asked) next_bring_up_us_ = now_us_ + params_.bring_up_period_us;
}

void BusWalk::begin_reset(std::int64_t now_us) {
  is_resetting_ = bus_.rearm();
  reset_since_us_ = now_us;
  was_configured_again_ = false;
  num_ready_cycles_ = 0;
}

void BusWalk::advance_reset() {
  const BusPhase phase = bus_.phase();
  num_ready_cycles_ = phase == BusPhase::kReady ? num_ready_cycles_ + 1 : 0;
  if (phase == BusPhase::kIdle && !was_configured_again_) {
    was_configured_again_ = bus_.configure();
    return;
  }
  const bool failed = phase == BusPhase::kFaulted || phase == BusPhase::kIdle ||
                      now_us_ - reset_since_us_ > params_.reset_timeout_us;
  if (failed || num_ready_cycles_ > kReadyCycles) is_resetting_ = false;
}

void BusWalk::obey(DriveRequest request, bool has_targets) {
  if (is_resetting_) return;  // nothing is followed meanwhile
  if (request != DriveRequest::kQuickStop) is_quick_stopped_ = false;
  const BusPhase phase = bus_.phase();
  const bool is_powering = phase == BusPhase::kEnabled || phase == BusPhase::kEnabling;
  switch (request) {
    case DriveRequest::kNone:
      if (is_powering && !has_targets) bus_.stop(can::StopKind::kQuickStop);
      return;
    case DriveRequest::kEnable:
      bus_.enable();  // no effect while it is enabling
      return;
    case DriveRequest::kHold:
      // By themselves: whoever arms next begins at the measured place, and drives that still
      // followed the last target would be given a step by that.
      if (is_powering) bus_.stop(can::StopKind::kQuickStop);
      return;
    case DriveRequest::kQuickStop:
      if (!is_quick_stopped_) is_quick_stopped_ = bus_.stop(can::StopKind::kQuickStop);
      return;
    case DriveRequest::kDisable:
      bus_.disable();  // no effect while it is disabling
      return;
  }
}

bool BusWalk::is_configured() const {
  switch (bus_.phase()) {
    case BusPhase::kIdle:
    case BusPhase::kListening:
    case BusPhase::kConfiguring:
    case BusPhase::kFaulted:
      return false;
    default:
      return true;
  }
}

bool BusWalk::follows_targets() const {
  return bus_.phase() == BusPhase::kEnabled || bus_.phase() == BusPhase::kDisabling;
}

}  // namespace climb_controller
