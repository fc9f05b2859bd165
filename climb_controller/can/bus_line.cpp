// SPDX-License-Identifier: BSD-3-Clause
#include "can/bus_line.h"

#include <linux/can/error.h>

namespace can {

void BusLine::begin_poll(std::int64_t now_us) {
  now_us_ = now_us;
  const bool was_usable = is_usable_;
  is_usable_ = transport_.maintain(now_us);
  if (was_usable && !is_usable_) raise(FaultCause::kInterfaceLost, -1, 0);
}

void BusLine::watch_unsent(std::int64_t max_us) {
  if (!is_busy()) {
    unsent_since_us_ = -1;
    return;
  }
  if (unsent_since_us_ < 0) unsent_since_us_ = now_us_;
  const std::int64_t unsent_us = now_us_ - unsent_since_us_;
  if (unsent_us < max_us) return;
  raise(FaultCause::kTransmitStalled, -1, static_cast<std::uint32_t>(unsent_us / 1000));
}

bool BusLine::receive(ReceivedFrame& received) {
  while (true) {
    const TransferStatus status = transport_.receive(received);
    if (status == TransferStatus::kWouldBlock) return false;
    if (status != TransferStatus::kDone) {
      raise(FaultCause::kInterfaceLost, -1, static_cast<std::uint32_t>(status));
      return false;
    }
    const CanFrame& frame = received.frame;
    if (recorder_ != nullptr) {
      recorder_->record(now_us_, FlightRecorder::Direction::kReceived, frame);
    }
    if (frame.error) {
      take_error_frame(frame);
    } else if (is_plain(frame)) {
      return true;
    } else {
      count_malformed();
    }
  }
}

void BusLine::take_error_frame(const CanFrame& frame) {
  if ((frame.id & (CAN_ERR_BUSOFF | CAN_ERR_RESTARTED)) != 0) {
    raise(FaultCause::kBusOff, -1, frame.id);
  }
  constexpr int kPassive = CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE;
  if ((frame.id & CAN_ERR_CRTL) != 0 && (frame.data[1] & kPassive) != 0) {
    raise(FaultCause::kErrorPassive, -1, frame.data[1]);
  }
  if ((frame.id & CAN_ERR_TX_TIMEOUT) != 0) raise(FaultCause::kTransmitStalled, -1, frame.id);
}

void BusLine::count_malformed() {
  const auto allowed = static_cast<std::uint64_t>(params_.max_malformed_per_s);
  malformed_us_[num_malformed_ % malformed_us_.size()] = now_us_;
  ++num_malformed_;
  if (num_malformed_ - num_malformed_at_clear_ <= allowed) return;
  // One more than allowed: was the first of them less than a second ago?
  const std::int64_t first_us =
      malformed_us_[(num_malformed_ - 1 - allowed) % malformed_us_.size()];
  if (now_us_ - first_us <= 1'000'000) {
    raise(FaultCause::kMalformedFrames, -1, static_cast<std::uint32_t>(num_malformed_));
  }
}

bool BusLine::begin_cycle() {
  if (is_faulted_) return false;
  is_cycle_complete_ = true;
  if (!transport_.has_unsent_frames()) return true;
  stalled();
  return false;
}

bool BusLine::send(const CanFrame& frame) {
  if (is_faulted_) return false;
  const TransferStatus status = transport_.send(frame);
  switch (status) {
    case TransferStatus::kDone:
      if (unsent_since_us_ < 0) unsent_since_us_ = now_us_;
      if (recorder_ != nullptr) {
        recorder_->record(now_us_, FlightRecorder::Direction::kSent, frame);
      }
      return true;
    case TransferStatus::kWouldBlock:
    case TransferStatus::kNoBuffers:
      is_cycle_complete_ = false;
      return false;
    default:
      raise(FaultCause::kInterfaceLost, -1, static_cast<std::uint32_t>(status));
      return false;
  }
}

void BusLine::end_cycle() {
  if (is_cycle_complete_) {
    num_stalled_cycles_ = 0;
  } else {
    stalled();
  }
}

void BusLine::stalled() {
  if (++num_stalled_cycles_ >= params_.max_stalled_cycles) {
    raise(FaultCause::kTransmitStalled, -1, static_cast<std::uint32_t>(num_stalled_cycles_));
  }
}

void BusLine::raise(FaultCause cause, int axis, std::uint32_t detail) {
  if (!is_watching_) return;
  const bool is_first = is_bus_fault(cause) && !is_faulted_;
  if (is_bus_fault(cause)) is_faulted_ = true;
  // What has not left yet must not leave when the bus comes back.
  if (is_first && is_usable_ && transport_.has_unsent_frames()) transport_.purge_transmit_queue();
  const Fault fault{cause, axis, detail, now_us_};
  if (faults_.raise(fault) && recorder_ != nullptr) recorder_->record(fault);
}

bool BusLine::clear() {
  const bool was_faulted = is_faulted_;
  faults_.clear();
  is_faulted_ = false;
  num_stalled_cycles_ = 0;
  num_malformed_at_clear_ = num_malformed_;
  is_watching_ = true;
  if (!is_usable_) {
    raise(FaultCause::kInterfaceLost, -1, 0);
  } else if (was_faulted && transport_.has_unsent_frames() &&
             transport_.purge_transmit_queue() != PurgeResult::kPurged) {
    is_faulted_ = true;  // nothing more to purge
    raise(FaultCause::kTransmitStalled, -1, 0);
  }
  return !is_faulted_;
}

}  // namespace can
