// SPDX-License-Identifier: BSD-3-Clause
// One cycle of the CiA 402 bus with sixteen axes: 32 frames in, 17 out, on a line without kernel.
#include <cstdint>
#include <vector>

#include <benchmark/benchmark.h>

#include "can/cia402.h"
#include "can/cia402_bus.h"

namespace {

constexpr int kNumAxes = 16;

/// Answers each SDO, NMT and SYNC with the least that keeps the bus content.
class EchoLine : public can::Transport {
 public:
  EchoLine() { answers_.reserve(4096); }

  can::TransferStatus send(const can::CanFrame& frame) override {
    namespace c = can::cia402;
    if (const auto sdo = c::decode_sdo_request(frame)) {
      const auto kind = sdo->write ? c::SdoResponse::Kind::kWritten : c::SdoResponse::Kind::kValue;
      if (sdo->write) last_values_[sdo->node] = sdo->value;
      const std::uint32_t value = sdo->object.index == 0x1000 ? 402 : last_values_[sdo->node];
      if (sdo->object.index == 0x608F) {
        answer(encode(c::SdoResponse{sdo->node, sdo->object, c::SdoResponse::Kind::kAbort, 4,
                                     c::kAbortNoObject}));
      } else {
        answer(encode(c::SdoResponse{sdo->node, sdo->object, kind, 4, value}));
      }
    } else if (const auto nmt = c::decode_nmt(frame)) {
      answer(encode(c::Heartbeat{nmt->node, c::NmtState::kOperational}));
    } else if (const auto pdo = c::decode_rpdo1(frame)) {
      words_[pdo->node] = pdo->control_word;
    } else if (c::is_sync(frame)) {
      for (std::uint8_t node = 1; node <= kNumAxes; ++node) {
        answer(encode(c::Tpdo1{node, status(words_[node]), 1000, std::int16_t{100}}));
        answer(encode(c::Heartbeat{node, c::NmtState::kOperational}));
      }
    }
    return can::TransferStatus::kDone;
  }

  can::TransferStatus receive(can::ReceivedFrame& received) override {
    if (next_ == answers_.size()) {
      answers_.clear();
      next_ = 0;
      return can::TransferStatus::kWouldBlock;
    }
    received.frame = answers_[next_++];
    return can::TransferStatus::kDone;
  }

  bool has_unsent_frames() const override { return false; }
  bool maintain(std::int64_t) override { return true; }
  can::PurgeResult purge_transmit_queue() override { return can::PurgeResult::kPurged; }

 private:
  void answer(const can::CanFrame& frame) { answers_.push_back(frame); }

  static std::uint16_t status(std::uint16_t control_word) {
    switch (control_word) {
      case 0x06:
        return 0x21;
      case 0x07:
        return 0x23;
      case 0x0F:
        return 0x27;
      default:
        return 0x40;
    }
  }

  std::vector<can::CanFrame> answers_;
  std::size_t next_ = 0;
  std::uint32_t last_values_[128] = {};
  std::uint16_t words_[128] = {};
};

void exchange_16_axes(benchmark::State& state) {
  can::Cia402Params params;
  params.listen_us = 0;
  for (int i = 0; i < kNumAxes; ++i) {
    can::AxisConfig axis;
    axis.node_id = static_cast<std::uint8_t>(i + 1);
    params.axes.push_back(axis);
  }
  EchoLine line;
  can::FlightRecorder recorder;
  can::Cia402Bus bus(params, line, &recorder);
  std::vector<can::AxisTarget> targets(kNumAxes);
  for (can::AxisTarget& target : targets) target.position_rad = 0.1;
  std::vector<can::AxisFeedback> feedback(kNumAxes);
  std::int64_t now_us = 0;
  const auto cycle = [&] {
    now_us += 10'000;
    bus.exchange(now_us, {now_us, targets}, feedback);
  };
  bus.configure();
  for (int i = 0; i < 2000 && bus.phase() != can::BusPhase::kEnabled; ++i) {
    cycle();
    bus.enable();
  }
  if (bus.phase() != can::BusPhase::kEnabled) {
    state.SkipWithError("the bus did not come up");
    return;
  }
  for (auto _ : state) cycle();
  if (!bus.faults().empty()) state.SkipWithError("a fault while measuring");
}
BENCHMARK(exchange_16_axes)->Unit(benchmark::kMicrosecond);

}  // namespace
