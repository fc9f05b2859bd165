// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/force_node.h"

#include <cmath>
#include <limits>

namespace simulator {
namespace {

constexpr std::int64_t kHeartbeatPeriod_us = 100'000;

std::uint32_t force_counts(double force_N) {
  if (!std::isfinite(force_N)) return ForceNode::kNoForce;
  const double counts = std::fmax(-32767.0, std::fmin(32767.0, std::floor(force_N * 10.0 + 0.5)));
  return static_cast<std::uint16_t>(static_cast<std::int16_t>(counts));
}

}  // namespace

void ForceNode::receive(const BusFrame& frame, std::vector<BusFrame>& sent) {
  if (!booted_) return;
  const bool for_me = frame.bytes[1] == 0 || frame.bytes[1] == node_id_;
  if (frame.id == 0x000 && frame.length == 2 && for_me) {
    if (frame.bytes[0] == 0x01) operational_ = true;
    if (frame.bytes[0] == 0x02 || frame.bytes[0] == 0x80) operational_ = false;
    if (frame.bytes[0] == 0x81 || frame.bytes[0] == 0x82) booted_ = operational_ = false;
  }
  if (frame.id != 0x080 || !operational_) return;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  BusFrame answer;
  answer.id = 0x180U + node_id_;
  answer.length = 6;
  answer.bytes[0] = touch ? 1 : 0;
  put_number(answer, 2, 2, force_counts(broken_sensor ? nan : across_N));
  put_number(answer, 4, 2, force_counts(broken_sensor ? nan : down_N));
  sent.push_back(answer);
}

void ForceNode::advance(std::int64_t now_us, std::vector<BusFrame>& sent) {
  if (booted_ && now_us < heartbeat_due_us_) return;
  BusFrame frame;
  frame.id = 0x700U + node_id_;
  frame.length = 1;
  if (booted_) frame.bytes[0] = operational_ ? 0x05 : 0x7F;
  booted_ = true;
  heartbeat_due_us_ = now_us + kHeartbeatPeriod_us;
  sent.push_back(frame);
}

}  // namespace simulator
