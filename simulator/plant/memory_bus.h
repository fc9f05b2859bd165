// SPDX-License-Identifier: BSD-3-Clause
// A CAN bus inside one process, in virtual time: every frame reaches every other port, in the order
// of (time, sending). Loss, duplication and delay per port from a seed; the whole bus can be cut
// or stalled, so that old frames leave late, as a real transmit queue does.
// Does not model arbitration or bit times: a frame takes latency_us.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "base/rng.h"
#include "simulator/plant/bus_frame.h"

namespace simulator {

inline constexpr int kEveryNode = -1;

enum class BusCondition : std::uint8_t {
  kUp,
  kDown,     ///< the interface is down: nothing is taken
  kStalled,  ///< nobody acknowledges: frames wait in the sender's queue
};

enum class SendResult : std::uint8_t { kSent, kNoBuffers, kDown };

/// Applied to the frames that a port sends.
struct PortFaults {
  double loss_share = 0.0;       ///< 0..1
  double duplicate_share = 0.0;  ///< 0..1
  std::int64_t delay_us = 0;     ///< >= 0, added to the bus' latency
  std::int64_t jitter_us = 0;    ///< >= 0, uniform; may reorder
};

/// A frame as it crossed the bus.
struct CarriedFrame {
  std::int64_t time_us = 0;         ///< when it left
  std::int64_t handed_over_us = 0;  ///< when its sender gave it away; older if the bus was stalled
  int port = 0;                     ///< of the sender
  BusFrame frame;
};

class MemoryBus {
 public:
  explicit MemoryBus(std::uint64_t seed = 1, std::int64_t latency_us = 0);

  /// A new port; with a node id only what concerns that node is delivered to it.
  int attach(int node_id = kEveryNode);

  SendResult send(int port, const BusFrame& frame, std::int64_t now_us);

  /// The next frame that reached this port by now; false when there is none.
  bool receive(int port, std::int64_t now_us, CarriedFrame& received);

  /// When the next frame reaches this port; the largest number when none is on its way.
  std::int64_t next_due_us(int port) const;

  PortFaults& faults(int port) { return ports_[static_cast<std::size_t>(port)].faults; }

  /// Stalled frames leave when the bus comes up again, unless purged.
  void set_condition(BusCondition condition, std::int64_t now_us);
  BusCondition condition() const { return condition_; }
  void purge(int port);
  int num_waiting(int port) const;

  /// Frames wait per port while stalled, then kNoBuffers.
  int queue_length = 40;

  /// Everything that left since the last call, for a monitor or a log.
  std::vector<CarriedFrame> take_carried();
  void record(bool on) { recording_ = on; }

 private:
  struct Delivery {
    std::int64_t due_us = 0;
    std::uint64_t sequence = 0;
    CarriedFrame carried;
  };
  struct Port {
    int node_id = kEveryNode;
    PortFaults faults;
    std::deque<Delivery> inbox;       ///< sorted by (due_us, sequence)
    std::deque<CarriedFrame> outbox;  ///< while stalled
  };

  void carry(const CarriedFrame& carried);
  void deliver(const CarriedFrame& carried, std::int64_t due_us);

  base::Rng rng_;
  std::int64_t latency_us_;
  BusCondition condition_ = BusCondition::kUp;
  std::uint64_t sequence_ = 0;
  bool recording_ = false;
  std::vector<Port> ports_;
  std::vector<CarriedFrame> carried_;
};

}  // namespace simulator
