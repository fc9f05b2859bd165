// SPDX-License-Identifier: BSD-3-Clause
// Arbitrary bytes as frames into both servo buses and all decoders: what is understood must encode
// to the same bytes, and no frame may break an invariant. The first byte chooses: ODrives, CiA 402
// drives that never answer, or such that do (scripted_drive.h), brought up before the rain. Then
// each 18 bytes: one struct can_frame, a flag byte and a byte of time.
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <optional>
#include <vector>

#include "base/check.h"
#include "can/cia402.h"
#include "can/cia402_bus.h"
#include "can/kernel_frame.h"
#include "can/odrive.h"
#include "can/odrive_bus.h"
#include "tests/can/scripted_drive.h"

namespace {

using can::CanFrame;

/// Hands out the fuzzer's frames and what the drives answer.
class ByteLine : public can::Transport {
 public:
  can::TransferStatus send(const CanFrame& frame) override {
    CHECK(can::is_plain(frame) && frame.dlc <= 8, "only plain frames are sent");
    ++num_sent;
    for (can::ScriptedDrive& drive : drives) {
      for (const CanFrame& answer : drive.hear(frame)) put(answer);
    }
    return can::TransferStatus::kDone;
  }
  can::TransferStatus receive(can::ReceivedFrame& received) override {
    if (waiting_.empty()) return can::TransferStatus::kWouldBlock;
    received = {waiting_.front(), 0, false};
    waiting_.pop_front();
    return can::TransferStatus::kDone;
  }
  bool has_unsent_frames() const override { return false; }
  bool maintain(std::int64_t) override { return true; }
  can::PurgeResult purge_transmit_queue() override { return can::PurgeResult::kPurged; }

  void put(const CanFrame& frame) { waiting_.push_back(frame); }

  std::vector<can::ScriptedDrive> drives;
  std::size_t num_sent = 0;

 private:
  std::deque<CanFrame> waiting_;
};

template <class Message>
void comes_back(const std::optional<Message>& message, const CanFrame& frame) {
  if (message) CHECK(encode(*message) == frame, "what is understood encodes to the same frame");
}

void check_decoders(const CanFrame& frame) {
  namespace c = can::cia402;
  comes_back(c::decode_nmt(frame), frame);
  comes_back(c::decode_heartbeat(frame), frame);
  comes_back(c::decode_rpdo1(frame), frame);
  comes_back(c::decode_tpdo1(frame), frame);
  comes_back(c::decode_tpdo2(frame), frame);
  comes_back(c::decode_emergency(frame), frame);
  // Frames with unused bytes: their meaning comes back, not every byte.
  if (const auto pdo = c::decode_rpdo2(frame))
    comes_back(c::decode_rpdo2(encode(*pdo)), encode(*pdo));
  if (const auto sdo = c::decode_sdo_request(frame)) {
    comes_back(c::decode_sdo_request(encode(*sdo)), encode(*sdo));
  }
  if (const auto sdo = c::decode_sdo_response(frame)) {
    comes_back(c::decode_sdo_response(encode(*sdo)), encode(*sdo));
    CHECK(c::abort_text(sdo->value) != nullptr, "every abort code has words");
  }
  namespace o = can::odrive;
  comes_back(o::decode_heartbeat(frame), frame);
  comes_back(o::decode_encoder_estimates(frame), frame);
  comes_back(o::decode_iq(frame), frame);
  comes_back(o::decode_input_pos(frame), frame);
  comes_back(o::decode_limits(frame), frame);
  comes_back(o::decode_controller_mode(frame), frame);
  comes_back(o::decode_set_axis_state(frame), frame);
}

can::AxisConfig axis_of(int node) {
  can::AxisConfig axis;
  axis.node_id = static_cast<std::uint8_t>(node);
  axis.counts_per_rad = 1000.0;
  return axis;
}

constexpr std::int64_t kStart_us = 1'000'000;

/// Two drives, enabled. Returns the time it is then.
std::int64_t bring_up(can::ServoBus& bus, ByteLine& line) {
  line.drives = {can::ScriptedDrive(1), can::ScriptedDrive(2)};
  std::vector<can::AxisFeedback> feedback(2);
  std::vector<can::AxisTarget> targets(2);
  for (can::AxisTarget& target : targets) target.position_rad = 1.0;  // where they stand
  std::int64_t now_us = kStart_us;
  bus.configure();
  for (int i = 0; i < 40; ++i, now_us += 10'000) {
    if (bus.phase() == can::BusPhase::kReady) bus.enable();
    if (bus.phase() == can::BusPhase::kEnabled) break;
    for (int poll = 0; poll < 8; ++poll) bus.poll(now_us + 1000 * poll);
    bus.begin_cycle(now_us + 9000, feedback);
    bus.end_cycle({now_us + 9000, targets});
  }
  CHECK(bus.phase() == can::BusPhase::kEnabled, "sound drives come up");
  return now_us;
}

/// One bus under a rain of frames, asked for everything now and then.
void rain(can::ServoBus& bus, ByteLine& line, std::int64_t now_us, const std::uint8_t* bytes,
          std::size_t size) {
  std::vector<can::AxisTarget> targets(2);
  std::vector<can::AxisFeedback> feedback(2);
  for (; size >= 18; bytes += 18, size -= 18) {
    ::can_frame raw{};
    std::memcpy(&raw, bytes, sizeof raw);
    CanFrame frame = can::from_kernel(raw);
    frame.fd = frame.fd || (bytes[16] & 0x80) != 0;
    line.put(frame);
    check_decoders(frame);
    now_us += 1000 * bytes[17];
    switch (bytes[16] & 0x0F) {
      case 0:
        bus.configure();
        break;
      case 1:
        bus.enable();
        break;
      case 2:
        bus.stop(static_cast<can::StopKind>(bytes[16] >> 4 & 1));
        break;
      case 3:
        bus.disable();
        break;
      case 4:
        bus.rearm();
        break;
      case 5:
        std::memcpy(&targets[0].position_rad, bytes + 8, 8);
        targets[1].position_rad = 0.5;
        break;
      case 6:
        bus.poll(now_us);
        break;
      default:
        break;
    }
    const bool is_latched = bus.phase() == can::BusPhase::kFaulted;
    const std::size_t num_sent = line.num_sent;
    bus.exchange(now_us, {now_us, targets}, feedback);
    CHECK(!is_latched || line.num_sent == num_sent, "a latched bus fault sends nothing");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  ByteLine line;
  if ((bytes[0] & 1) == 0) {
    can::Cia402Params params;
    params.axes = {axis_of(1), axis_of(2)};
    params.listen_us = 1000;
    can::Cia402Bus bus(params, line);
    const bool are_there = (bytes[0] & 2) != 0;
    rain(bus, line, are_there ? bring_up(bus, line) : kStart_us, bytes + 1, size - 1);
  } else {
    can::OdriveParams params;
    params.axes = {axis_of(1), axis_of(2)};
    params.listen_us = 1000;
    can::OdriveBus bus(params, line);
    rain(bus, line, kStart_us, bytes + 1, size - 1);
  }
  return 0;
}
