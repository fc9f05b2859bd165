// SPDX-License-Identifier: BSD-3-Clause
// A line inside the test: what the bus sends is kept, what a test puts in is received.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "can/transport.h"

namespace can {

class FakeLine : public Transport {
 public:
  FakeLine() {
    sent.reserve(1 << 16);
    incoming_.reserve(1 << 16);
  }

  TransferStatus send(const CanFrame& frame) override {
    if (send_status == TransferStatus::kDone) sent.push_back(frame);
    return send_status;
  }

  TransferStatus receive(ReceivedFrame& received) override {
    if (receive_status != TransferStatus::kWouldBlock) return receive_status;
    if (next_ == incoming_.size()) {
      incoming_.clear();
      next_ = 0;
      return TransferStatus::kWouldBlock;
    }
    received = incoming_[next_++];
    return TransferStatus::kDone;
  }

  bool has_unsent_frames() const override { return has_unsent; }
  bool maintain(std::int64_t) override { return is_usable; }
  PurgeResult purge_transmit_queue() override {
    ++num_purges;
    if (purge_result == PurgeResult::kPurged) has_unsent = false;
    return purge_result;
  }

  void put(const CanFrame& frame, bool from_this_host = false) {
    incoming_.push_back({frame, 0, from_this_host});
  }

  std::vector<CanFrame> sent;
  TransferStatus send_status = TransferStatus::kDone;
  TransferStatus receive_status = TransferStatus::kWouldBlock;
  bool has_unsent = false;
  bool is_usable = true;
  PurgeResult purge_result = PurgeResult::kPurged;
  int num_purges = 0;

 private:
  std::vector<ReceivedFrame> incoming_;
  std::size_t next_ = 0;
};

/// "181#2706E8030000F4FF" as candump and cansend write it.
inline std::string hex(const CanFrame& frame) {
  char text[16];
  std::snprintf(text, sizeof text, frame.extended ? "%08X#" : "%03X#", frame.id);
  std::string line = text;
  for (std::size_t i = 0; i < frame.dlc; ++i) {
    std::snprintf(text, sizeof text, "%02X", frame.data[i]);
    line += text;
  }
  return line;
}

inline CanFrame from_hex(const std::string& line) {
  CanFrame frame;
  const std::size_t hash = line.find('#');
  frame.id = static_cast<std::uint32_t>(std::strtoul(line.substr(0, hash).c_str(), nullptr, 16));
  frame.extended = hash > 3;
  for (std::size_t at = hash + 1; at + 1 < line.size(); at += 2) {
    frame.data[frame.dlc++] =
        static_cast<std::uint8_t>(std::strtoul(line.substr(at, 2).c_str(), nullptr, 16));
  }
  return frame;
}

}  // namespace can
