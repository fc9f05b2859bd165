// SPDX-License-Identifier: BSD-3-Clause
// What a servo bus needs of a CAN line. Nothing here blocks or asks a clock, so that a bus runs the
// same on a socket and, in virtual time, on a line inside the process.
#pragma once

#include <cstdint>

#include "can/can_frame.h"

namespace can {

enum class TransferStatus : std::uint8_t {
  kDone,
  kWouldBlock,   ///< receive: nothing waits; send: the socket's own buffer is full (EAGAIN)
  kNoBuffers,    ///< the interface's transmit queue is full (ENOBUFS)
  kNetworkDown,  ///< the interface is down (ENETDOWN); reported once, then latched by the transport
  kGone,         ///< the interface or the peer was removed (ENXIO, ENODEV, EPIPE)
  kRefused,      ///< the line cannot carry this frame, or the system said something else
};

const char* name(TransferStatus status);

/// What purge_transmit_queue() obtained.
enum class PurgeResult : std::uint8_t {
  kPurged,        ///< no frame handed over earlier can leave any more
  kNotPermitted,  ///< taking the interface down and up needs CAP_NET_ADMIN
  kFailed,
};

class Transport {
 public:
  virtual ~Transport() = default;

  /// Hands one frame over, now or never: nothing is queued above the kernel.
  virtual TransferStatus send(const CanFrame& frame) = 0;

  /// kDone and `received` filled, or kWouldBlock when nothing waits, or why the line is lost.
  virtual TransferStatus receive(ReceivedFrame& received) = 0;

  /// Some frame handed over earlier has not yet left this host.
  virtual bool has_unsent_frames() const = 0;

  /// To be called every cycle: re-opens a lost line by name, with backoff. True while it is usable.
  virtual bool maintain(std::int64_t now_us) = 0;

  /// Throws away what was handed over and has not left: before any re-arming.
  virtual PurgeResult purge_transmit_queue() = 0;
};

}  // namespace can
