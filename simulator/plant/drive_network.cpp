// SPDX-License-Identifier: BSD-3-Clause
// The network side of a drive: NMT, SYNC, PDOs, SDO, heartbeats, emergencies.
#include "simulator/plant/drive.h"
#include "simulator/plant/sdo_server.h"

namespace simulator {
namespace {

constexpr std::uint16_t kHeartbeatLostCode = 0x8130;
constexpr std::uint16_t kPdoTooShortCode = 0x8210;
constexpr std::uint16_t kPdoTooLongCode = 0x8220;
constexpr std::uint16_t kSyncLengthCode = 0x8240;
constexpr std::uint16_t kRpdoLateCode = 0x8250;

/// Error register 1001h: generic, and the kind by the code's first digit.
std::uint8_t error_register(std::uint16_t code) {
  switch (code >> 12) {
    case 0:
      return 0x00;
    case 2:
      return 0x03;
    case 3:
      return 0x05;
    case 4:
      return 0x09;
    default:
      break;
  }
  return (code & 0xFF00) == 0x8100 || (code & 0xFF00) == 0x8200 ? 0x11 : 0x21;
}

std::uint8_t heartbeat_code(NmtState state) {
  switch (state) {
    case NmtState::kBooting:
      return 0x00;
    case NmtState::kStopped:
      return 0x04;
    case NmtState::kOperational:
      return 0x05;
    case NmtState::kPreOperational:
      break;
  }
  return 0x7F;
}

BusFrame heartbeat_frame(std::uint8_t node_id, NmtState state) {
  BusFrame frame;
  frame.id = 0x700U + node_id;
  frame.length = 1;
  frame.bytes[0] = heartbeat_code(state);
  return frame;
}

}  // namespace

void Drive::receive(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent) {
  if (faults.silent || nmt_ == NmtState::kBooting || !is_standard(frame)) return;
  const std::uint32_t node = params_.node_id;
  if (frame.id == 0x000) return on_nmt(frame, now_us, sent);
  if (frame.id == 0x080) return on_sync(frame, now_us, sent);
  if (frame.id == 0x600 + node) return on_sdo(frame, now_us, sent);
  for (std::size_t i = 0; i < rpdos_.size(); ++i) {
    if (rpdos_[i].valid() && frame.id == rpdos_[i].id()) return on_rpdo(i, frame, now_us, sent);
  }
  if (frame.id > 0x700) on_heartbeat(frame, now_us, sent);
}

void Drive::on_nmt(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent) {
  if (frame.length != 2) return;
  if (frame.bytes[1] != 0 && frame.bytes[1] != params_.node_id) return;
  switch (frame.bytes[0]) {
    case 0x01:
      return enter_nmt(NmtState::kOperational, sent);
    case 0x02:
      return enter_nmt(NmtState::kStopped, sent);
    case 0x80:
      return enter_nmt(NmtState::kPreOperational, sent);
    case 0x81:
      return reset_node(false, now_us);
    case 0x82:
      return reset_node(true, now_us);
    default:
      return;
  }
}

void Drive::enter_nmt(NmtState next, std::vector<BusFrame>& sent) {
  const bool leaves_operational = nmt_ == NmtState::kOperational && next != nmt_;
  nmt_ = next;
  is_staged_ = {};
  rpdo_watched_ = {};
  syncs_ = {};
  if (leaves_operational) lose_connection(sent);
}

void Drive::drop_to_pre_operational(std::vector<BusFrame>& sent) {
  enter_nmt(NmtState::kPreOperational, sent);
}

void Drive::reset_node(bool communication_only, std::int64_t now_us) {
  dictionary_.restore(communication_only);
  if (!communication_only || has_torque(power_)) power_ = PowerState::kSwitchOnDisabled;
  nmt_ = NmtState::kBooting;
  boot_due_us_ = now_us + params_.boot_us;
  last_control_word_ = 0;
  warning_ = limit_active_ = following_error_ = false;
  master_watched_ = master_lost_ = false;
  is_staged_ = rpdo_watched_ = {};
  configure_pdos();
}

void Drive::reboot(std::int64_t now_us) {
  reset_node(false, now_us);
}

void Drive::boot(std::int64_t now_us, std::vector<BusFrame>& sent) {
  sent.push_back(heartbeat_frame(params_.node_id, NmtState::kBooting));
  nmt_ = NmtState::kPreOperational;
  heartbeat_due_us_ = now_us;
  refresh_objects();
}

void Drive::configure_pdos() {
  for (Pdo& pdo : rpdos_) pdo.configure(dictionary_);
  for (Pdo& pdo : tpdos_) pdo.configure(dictionary_);
}

void Drive::on_sdo(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent) {
  if (nmt_ == NmtState::kStopped) return;
  const std::uint32_t heartbeat_before = dictionary_.at(0x1017).value;
  const std::optional<BusFrame> answer = answer_sdo(dictionary_, params_.node_id, frame);
  if (!answer) return;
  sent.push_back(*answer);
  if (answer->bytes[0] != 0x60) return;  // nothing was written
  const auto index = static_cast<std::uint16_t>(number_at(frame, 1, 2));
  if (belongs_to_pdo(index)) configure_pdos();
  if (index == 0x6040) apply_control_word(sent);
  if (index == 0x1016) master_watched_ = false;
  if (dictionary_.at(0x1017).value != heartbeat_before) heartbeat_due_us_ = now_us;
}

void Drive::on_rpdo(std::size_t number, const BusFrame& frame, std::int64_t now_us,
                    std::vector<BusFrame>& sent) {
  if (nmt_ != NmtState::kOperational) return;
  const Pdo& pdo = rpdos_[number];
  if (frame.length < pdo.length()) return send_emergency(kPdoTooShortCode, sent);
  if (frame.length > pdo.length()) send_emergency(kPdoTooLongCode, sent);
  rpdo_heard_us_[number] = now_us;
  rpdo_watched_[number] = true;
  if (pdo.synchronous()) {
    staged_[number] = frame;
    is_staged_[number] = true;
    return;
  }
  pdo.unpack(frame);
  apply_control_word(sent);
  apply_target(now_us);
}

void Drive::on_sync(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent) {
  if (nmt_ != NmtState::kOperational) return;
  if (frame.length > 1) return send_emergency(kSyncLengthCode, sent);
  refresh_objects();  // what is sent is the state at SYNC, before the new command
  for (std::size_t i = 0; i < tpdos_.size(); ++i) {
    const Pdo& pdo = tpdos_[i];
    if (!pdo.valid() || !pdo.synchronous() || ++syncs_[i] < pdo.type()) continue;
    syncs_[i] = 0;
    send_tpdo(i, now_us, sent);
  }
  bool commanded = false;
  for (std::size_t i = 0; i < rpdos_.size(); ++i) {
    if (!is_staged_[i]) continue;
    rpdos_[i].unpack(staged_[i]);
    is_staged_[i] = false;
    commanded = true;
  }
  if (!commanded) return;
  apply_control_word(sent);
  apply_target(now_us);
}

void Drive::send_tpdo(std::size_t number, std::int64_t now_us, std::vector<BusFrame>& sent) {
  BusFrame frame = tpdos_[number].packed();
  tpdo_last_[number] = frame;
  tpdo_sent_us_[number] = now_us;
  if (number == 0 && faults.no_state) return;
  if (number == 0 && faults.wrong_length) --frame.length;
  sent.push_back(frame);
}

void Drive::on_heartbeat(const BusFrame& frame, std::int64_t now_us, std::vector<BusFrame>& sent) {
  const std::uint32_t consumer = dictionary_.at(0x1016, 1).value;
  const std::uint32_t watched_node = (consumer >> 16) & 0x7F;
  if (watched_node == 0 || frame.length != 1 || frame.id != 0x700 + watched_node) return;
  master_heard_us_ = now_us;
  master_watched_ = true;
  if (!master_lost_) return;
  master_lost_ = false;
  if (error_code() == kHeartbeatLostCode) send_emergency(0, sent);
}

void Drive::watch_master(std::int64_t now_us, std::vector<BusFrame>& sent) {
  const std::int64_t limit_us = (dictionary_.number(0x1016, 1) & 0xFFFF) * 1000;
  if (master_watched_ && !master_lost_ && limit_us > 0 && now_us - master_heard_us_ >= limit_us) {
    master_lost_ = true;
    lose_connection(sent);
    send_emergency(kHeartbeatLostCode, sent);
    const std::int64_t behaviour = dictionary_.number(0x1029, 1);
    if (behaviour == 0 && nmt_ == NmtState::kOperational) drop_to_pre_operational(sent);
    if (behaviour == 2) enter_nmt(NmtState::kStopped, sent);
  }
  for (std::size_t i = 0; i < rpdos_.size(); ++i) {
    const std::int64_t deadline_us = rpdos_[i].event_us();
    const bool late =
        rpdo_watched_[i] && deadline_us > 0 && now_us - rpdo_heard_us_[i] > deadline_us;
    if (!late) continue;
    rpdo_watched_[i] = false;
    send_emergency(kRpdoLateCode, sent);
  }
}

void Drive::lose_connection(std::vector<BusFrame>& sent) {
  switch (dictionary_.number(0x6007)) {
    case 1:
      return raise_fault(kHeartbeatLostCode, sent);
    case 2:
      if (has_torque(power_)) enter(PowerState::kSwitchOnDisabled);
      return;
    case 3:
      if (power_ == PowerState::kOperationEnabled) quick_stop();
      return;
    default:
      return;
  }
}

void Drive::send_timed(std::int64_t now_us, std::vector<BusFrame>& sent) {
  const std::int64_t period_us = dictionary_.number(0x1017) * 1000;
  if (period_us > 0 && now_us >= heartbeat_due_us_) {
    heartbeat_due_us_ = now_us + period_us;
    if (!faults.no_heartbeat) sent.push_back(heartbeat_frame(params_.node_id, nmt_));
  }
  if (nmt_ != NmtState::kOperational) return;
  for (std::size_t i = 0; i < tpdos_.size(); ++i) {
    const Pdo& pdo = tpdos_[i];
    if (!pdo.valid() || pdo.synchronous()) continue;
    const bool due = pdo.event_us() > 0 && now_us - tpdo_sent_us_[i] >= pdo.event_us();
    if (due || pdo.packed() != tpdo_last_[i]) send_tpdo(i, now_us, sent);
  }
}

void Drive::send_emergency(std::uint16_t code, std::vector<BusFrame>& sent) {
  dictionary_.at(0x603F).value = code;
  dictionary_.at(0x1001).value = error_register(code);
  dictionary_.at(0x1003, 0).value = code == 0 ? 0 : 1;
  dictionary_.at(0x1003, 1).value = code;
  if (faults.silent || nmt_ == NmtState::kStopped) return;
  BusFrame frame;
  frame.id = 0x080U + params_.node_id;
  frame.length = 8;
  put_number(frame, 0, 2, code);
  frame.bytes[2] = error_register(code);
  sent.push_back(frame);
}

}  // namespace simulator
