// SPDX-License-Identifier: BSD-3-Clause
#include "can/sdo_client.h"

#include <algorithm>

namespace can {

using cia402::SdoRequest;
using cia402::SdoResponse;

void SdoClient::start(std::span<const ObjectStep> steps) {
  steps_ = steps;
  step_index_ = 0;
  has_answered_ = false;
  lacks_hold_on_loss_ = false;
  issues_.clear();
  issues_.reserve(steps.size());
  if (!is_done()) begin_step();
}

bool SdoClient::forbids_motion() const {
  return std::any_of(issues_.begin(), issues_.end(),
                     [](const ObjectIssue& issue) { return issue.forbids_motion; });
}

void SdoClient::begin_step() {
  stage_ = steps_[step_index_].write ? Stage::kWrite : Stage::kRead;
  write_abort_ = 0;
  num_attempts_ = 0;
  is_waiting_ = false;
}

void SdoClient::finish_step() {
  ++step_index_;
  if (!is_done()) begin_step();
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
    if (step.need != ObjectStep::Need::kIfPresent) {
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
  const std::uint32_t bits =
      step.num_bytes >= 4 ? step.mask : step.mask & ((1U << 8 * step.num_bytes) - 1U);
  const bool equal = (found & bits) == (step.value & bits);
  if (write_abort_ != 0 && !(equal && write_abort_ == cia402::kAbortReadOnly)) {
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
  issue.forbids_motion =
      step.need == ObjectStep::Need::kMotion || step.need == ObjectStep::Need::kIfPresent;
  if (step.need == ObjectStep::Need::kHoldOnLoss) lacks_hold_on_loss_ = true;
  issues_.push_back(issue);
}

}  // namespace can
