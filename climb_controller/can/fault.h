// SPDX-License-Identifier: BSD-3-Clause
// What can go wrong on the bus, as values: a cause, the axis it concerns and one detail.
#pragma once

#include <cstdint>

namespace can {

enum class FaultCause : std::uint8_t {
  // One axis. The others are still served; this axis is never enabled again by itself.
  kSilent,                ///< three cycles without its state frame; detail: missed cycles
  kHeartbeatLost,         ///< detail: ms since the last
  kUnexpectedBootUp,      ///< it restarted: configuration and enabling are gone
  kLeftOperational,       ///< network state is not operational; detail: the state
  kLeftOperationEnabled,  ///< drive state is not the one it was brought to; detail: statusword
  kEmergency,             ///< error reported; detail: error code
  kWarning,               ///< supply voltage or temperature; still works; detail: error code
  kEnableTimeout,         ///< did not follow the walk to operation enabled; detail: statusword
  kTargetRefused,         ///< target not finite, not representable or too old; the last one is held
  kConfiguration,         ///< an object is missing or keeps another value; detail: index << 8 | sub
  // The whole bus. Latched: nothing is sent until rearm().
  kMalformedFrames,  ///< more than ten in one second with a wrong length, RTR, 29 bits or FD
  kForeignMaster,    ///< somebody else sends a master's frames; detail: its identifier
  kBusOff,           ///< the controller left the bus
  kErrorPassive,     ///< nobody acknowledges, or too many errors
  kTransmitStalled,  ///< two cycles in a row could not be handed over or did not leave
  kInterfaceLost,    ///< down, removed, or its peer is gone; detail: TransferStatus
};
inline constexpr int kNumFaultCauses = static_cast<int>(FaultCause::kInterfaceLost) + 1;

const char* name(FaultCause cause);

inline bool is_bus_fault(FaultCause cause) {
  return cause >= FaultCause::kMalformedFrames;
}

struct Fault {
  FaultCause cause{};
  int axis = -1;             ///< -1: the whole bus
  std::uint32_t detail = 0;  ///< see FaultCause
  std::int64_t time_us = 0;  ///< time handed in when it was seen
};

}  // namespace can
