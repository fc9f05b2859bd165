// SPDX-License-Identifier: BSD-3-Clause
#include "climb_controller/fault_map.h"

#include <array>

namespace climb_controller {
namespace {

using Cause = can::FaultCause;
using Fault = climb::Fault;

struct Row {
  Cause cause;
  Fault meaning;
};

constexpr std::array<Row, can::kNumFaultCauses> kMeanings = {{
    {Cause::kSilent, Fault::kServoSilent},
    {Cause::kHeartbeatLost, Fault::kHeartbeatLost},
    {Cause::kUnexpectedBootUp, Fault::kServoState},
    {Cause::kLeftOperational, Fault::kServoState},
    {Cause::kLeftOperationEnabled, Fault::kServoState},
    {Cause::kEmergency, Fault::kServoFault},
    {Cause::kWarning, Fault::kServoWarning},
    {Cause::kEnableTimeout, Fault::kServoState},
    {Cause::kTargetRefused, Fault::kUnsafeCommand},
    {Cause::kConfiguration, Fault::kConfiguration},
    {Cause::kMalformedFrames, Fault::kMalformedFrames},
    {Cause::kForeignMaster, Fault::kSecondController},
    {Cause::kBusOff, Fault::kBusDown},
    {Cause::kErrorPassive, Fault::kBusDown},
    {Cause::kTransmitStalled, Fault::kTransmitStalled},
    {Cause::kInterfaceLost, Fault::kBusDown},
}};

constexpr bool rows_in_order() {
  for (int i = 0; i < can::kNumFaultCauses; ++i) {
    if (static_cast<int>(kMeanings[i].cause) != i) return false;
  }
  return true;
}
static_assert(rows_in_order(), "a cause is its row's number");

}  // namespace

climb::Fault meaning_of(can::FaultCause cause) {
  return kMeanings[static_cast<std::size_t>(cause)].meaning;
}

climb::FaultFlags flags_of(std::span<const can::Fault> faults) {
  climb::FaultFlags flags = 0;
  for (const can::Fault& fault : faults) flags |= climb::flag(meaning_of(fault.cause));
  return flags;
}

}  // namespace climb_controller
