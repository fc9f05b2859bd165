// SPDX-License-Identifier: BSD-3-Clause
#include "can/sdo_client.h"

#include <algorithm>

namespace can {

using cia402::SdoRequest;
using cia402::SdoResponse;

namespace {

using Need = ObjectStep::Need;

/// The drive says that it has no such object: nothing is known to be wrong with it.
bool is_absence(std::uint32_t abort_code) {
  return abort_code == cia402::kAbortNoObject || abort_code == cia402::kAbortNoSubindex;
}

/// The write was refused because the object cannot be changed, at all or now; its value may be
/// right all the same.
bool is_unchangeable(std::uint32_t abort_code) {
  return abort_code == cia402::kAbortReadOnly || abort_code == cia402::kAbortAccess ||
         abort_code == cia402::kAbortDeviceState;
}

bool forbids_motion_by(Need need, const ObjectIssue& issue) {
  switch (need) {
    case Need::kMotion:
    case Need::kIfPresent:
    case Need::kMeans:
      return true;
    case Need::kTold:
      return issue.kind != ObjectIssue::Kind::kAborted || !is_absence(issue.abort_code);
    case Need::kPart:
    case Need::kOptional:
      return false;
  }
  return true;
}

}  // namespace

void SdoClient::start(std::span<const ObjectStep> steps, Parts lost) {
  steps_ = steps;
  step_index_ = 0;
  has_answered_ = false;
  lost_ = lost;
  issues_.clear();
  issues_.reserve(steps.size());
  begin_step();
}

bool SdoClient::forbids_motion() const {
  return std::any_of(issues_.begin(), issues_.end(),
                     [](const ObjectIssue& issue) { return issue.forbids_motion; });
}

bool SdoClient::is_skipped(const ObjectStep& step) const {
  return (step.when == ObjectStep::When::kWithPart && lacks(step.part)) ||
         (step.when == ObjectStep::When::kWithoutPart && !lacks(step.part));
}

void SdoClient::begin_step() {
  while (!is_done() && is_skipped(steps_[step_index_])) ++step_index_;
  if (is_done()) return;
  stage_ = steps_[step_index_].write ? Stage::kWrite : Stage::kRead;
  write_abort_ = 0;
  num_attempts_ = 0;
  is_waiting_ = false;
}

void SdoClient::finish_step() {
  ++step_index_;
  begin_step();
}

std::optional<CanFrame> SdoClient::next_frame(std::int64_t now_us) {
  if (is_done() || (is_waiting_ && now_us < deadline_us_)) return std::nullopt;
  const ObjectStep& step = steps_[step_index_];
  if (num_attempts_ >= params_.max_attempts) {
    const CanFrame abort = cia402::encode_sdo_abort(node_, step.object, cia402::kAbortTimeout);
    give_up();
    return abort;
  }
  ++num_attempts_;
  is_waiting_ = true;
  deadline_us_ = now_us + params_.timeout_us;
  const bool write = stage_ == Stage::kWrite;
  return cia402::encode(SdoRequest{node_, step.object, write, step.num_bytes, step.value});
}

void SdoClient::give_up() {
  note(ObjectIssue::Kind::kSilent, 0, 0);
  if (has_answered_) {
    finish_step();
  } else {
    step_index_ = steps_.size();  // nobody there: the other objects would say the same
  }
}

void SdoClient::take(const SdoResponse& response) {
  if (is_done() || !is_waiting_ || response.node != node_) return;
  const ObjectStep& step = steps_[step_index_];
  if (!(response.object == step.object)) return;  // late answer to an earlier request
  const bool expected = response.kind == SdoResponse::Kind::kAbort ||
                        (response.kind == SdoResponse::Kind::kWritten) == (stage_ == Stage::kWrite);
  if (!expected) return;
  has_answered_ = true;
  is_waiting_ = false;
  num_attempts_ = 0;
  if (stage_ == Stage::kWrite) {
    if (response.kind == SdoResponse::Kind::kAbort) write_abort_ = response.value;
    stage_ = Stage::kRead;  // also after an abort: a constant may already be right
  } else if (response.kind == SdoResponse::Kind::kAbort) {
    const bool is_silent_need = step.need == Need::kIfPresent || step.need == Need::kMeans;
    if (!is_silent_need) {
      note(ObjectIssue::Kind::kAborted, write_abort_ != 0 ? write_abort_ : response.value, 0);
    }
    finish_step();
  } else {
    compare(response.value);
    finish_step();
  }
}

void SdoClient::compare(std::uint32_t found) {
  const ObjectStep& step = steps_[step_index_];
  if (step.need == Need::kMeans || (step.zero_is_unknown && found == 0)) return;
  const std::uint32_t bits =
      step.num_bytes >= 4 ? step.mask : step.mask & ((1U << 8 * step.num_bytes) - 1U);
  const bool equal = (found & bits) == (step.value & bits);
  if (write_abort_ != 0 && !(equal && is_unchangeable(write_abort_))) {
    note(ObjectIssue::Kind::kAborted, write_abort_, found);
  } else if (!equal) {
    note(ObjectIssue::Kind::kMismatch, 0, found);
  }
}

void SdoClient::note(ObjectIssue::Kind kind, std::uint32_t abort_code, std::uint32_t found) {
  const ObjectStep& step = steps_[step_index_];
  ObjectIssue issue;
  issue.axis = axis_;
  issue.index = step.object.index;
  issue.subindex = step.object.subindex;
  issue.object_name = step.object_name;
  issue.kind = kind;
  issue.abort_code = abort_code;
  issue.wanted = step.value;
  issue.found = found;
  issue.forbids_motion = forbids_motion_by(step.need, issue);
  if (step.need == Need::kPart) lost_ |= bit(step.part);
  issues_.push_back(issue);
}

}  // namespace can
