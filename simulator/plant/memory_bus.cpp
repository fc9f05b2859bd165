// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/plant/memory_bus.h"

#include <algorithm>
#include <utility>

#include "base/check.h"

namespace simulator {
namespace {

/// Acceptance filter of a node: NMT, SYNC, heartbeats of all, and what carries its own id.
bool concerns(int node_id, const BusFrame& frame) {
  if (node_id == kEveryNode || !is_standard(frame)) return true;
  const std::uint32_t id = frame.id;
  return id == 0x000 || id == 0x080 || id >= 0x700 || static_cast<int>(id & 0x7F) == node_id;
}

}  // namespace

MemoryBus::MemoryBus(std::uint64_t seed, std::int64_t latency_us)
    : rng_(seed), latency_us_(latency_us) {}

int MemoryBus::attach(int node_id) {
  Port port;
  port.node_id = node_id;
  ports_.push_back(std::move(port));
  return static_cast<int>(ports_.size()) - 1;
}

SendResult MemoryBus::send(int port, const BusFrame& frame, std::int64_t now_us) {
  CHECK(port >= 0 && port < static_cast<int>(ports_.size()), "a port of this bus");
  const CarriedFrame carried{now_us, now_us, port, frame};
  if (condition_ == BusCondition::kDown) return SendResult::kDown;
  if (condition_ == BusCondition::kStalled) {
    auto& outbox = ports_[static_cast<std::size_t>(port)].outbox;
    if (static_cast<int>(outbox.size()) >= queue_length) return SendResult::kNoBuffers;
    outbox.push_back(carried);
    return SendResult::kSent;
  }
  carry(carried);
  return SendResult::kSent;
}

void MemoryBus::carry(const CarriedFrame& carried) {
  const PortFaults& faults = ports_[static_cast<std::size_t>(carried.port)].faults;
  // Numbers are drawn only for faults that are on: a healthy run does not depend on the seed.
  if (faults.loss_share > 0.0 && rng_.uniform() < faults.loss_share) return;
  const bool twice = faults.duplicate_share > 0.0 && rng_.uniform() < faults.duplicate_share;
  std::int64_t due_us = carried.time_us + latency_us_ + faults.delay_us;
  if (faults.jitter_us > 0) {
    due_us += static_cast<std::int64_t>(rng_.uniform() * static_cast<double>(faults.jitter_us));
  }
  for (int copy = 0; copy < (twice ? 2 : 1); ++copy) {
    if (recording_) carried_.push_back(carried);
    deliver(carried, due_us);
  }
}

void MemoryBus::deliver(const CarriedFrame& carried, std::int64_t due_us) {
  const std::uint64_t sequence = sequence_++;
  for (std::size_t i = 0; i < ports_.size(); ++i) {
    Port& port = ports_[i];
    if (static_cast<int>(i) == carried.port || !concerns(port.node_id, carried.frame)) continue;
    auto place = port.inbox.end();
    while (place != port.inbox.begin() && std::prev(place)->due_us > due_us) --place;
    port.inbox.insert(place, Delivery{due_us, sequence, carried});
  }
}

std::int64_t MemoryBus::next_due_us(int port) const {
  const auto& inbox = ports_[static_cast<std::size_t>(port)].inbox;
  return inbox.empty() ? INT64_MAX : inbox.front().due_us;
}

bool MemoryBus::receive(int port, std::int64_t now_us, CarriedFrame& received) {
  auto& inbox = ports_[static_cast<std::size_t>(port)].inbox;
  if (inbox.empty() || inbox.front().due_us > now_us) return false;
  received = inbox.front().carried;
  received.time_us = inbox.front().due_us;
  inbox.pop_front();
  return true;
}

void MemoryBus::set_condition(BusCondition condition, std::int64_t now_us) {
  condition_ = condition;
  for (Port& port : ports_) {
    if (condition == BusCondition::kDown) port.outbox.clear();
    if (condition != BusCondition::kUp) continue;
    for (CarriedFrame& waiting : port.outbox) {
      waiting.time_us = now_us;
      carry(waiting);
    }
    port.outbox.clear();
  }
}

void MemoryBus::purge(int port) {
  ports_[static_cast<std::size_t>(port)].outbox.clear();
}

int MemoryBus::num_waiting(int port) const {
  return static_cast<int>(ports_[static_cast<std::size_t>(port)].outbox.size());
}

std::vector<CarriedFrame> MemoryBus::take_carried() {
  return std::exchange(carried_, {});
}

}  // namespace simulator
