// SPDX-License-Identifier: BSD-3-Clause
// A drive's side of expedited SDO (CiA 301, 7.2.4.3): reads and writes of 1..4 bytes, an abort with
// its reason for everything else. Segmented and block transfers are refused.
#pragma once

#include <cstdint>
#include <optional>

#include "simulator/plant/bus_frame.h"
#include "simulator/plant/object_dictionary.h"

namespace simulator {

/// The answer, or none to a frame that is no request (wrong length, an abort by the master).
std::optional<BusFrame> answer_sdo(ObjectDictionary& dictionary, std::uint8_t node_id,
                                   const BusFrame& request);

}  // namespace simulator
