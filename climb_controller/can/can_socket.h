// SPDX-License-Identifier: BSD-3-Clause
// A CAN line of the system: a raw SocketCAN interface by name, or a local line "unix:PATH"
// (SOCK_SEQPACKET, one struct can_frame per message) where a machine has no CAN. Non-blocking;
// the first error that loses the line is latched, and maintain() opens it again by name.
#pragma once

#include <cstdint>
#include <string>

#include "can/transport.h"

namespace can {

struct CanSocketParams {
  std::string interface = "can0";            ///< "can0" or "unix:PATH"
  std::int64_t first_reopen_us = 50'000;     ///< wait before the second attempt; doubles
  std::int64_t longest_reopen_us = 800'000;  ///< re-opened within 1 s of its return
};

class CanSocket : public Transport {
 public:
  /// Opens nothing yet: maintain() does, or open() for the reason in words.
  explicit CanSocket(CanSocketParams params);

  /// Takes over a connected SOCK_SEQPACKET (tests: socketpair). Cannot be opened again once lost.
  explicit CanSocket(int fd);

  ~CanSocket() override;
  CanSocket(const CanSocket&) = delete;
  CanSocket& operator=(const CanSocket&) = delete;

  /// "" or what failed and how to mend it.
  std::string open();

  /// For poll(2); -1 while the line is lost.
  int fd() const { return fd_; }

  TransferStatus send(const CanFrame& frame) override;
  TransferStatus receive(ReceivedFrame& received) override;
  bool has_unsent_frames() const override;
  bool maintain(std::int64_t now_us) override;
  PurgeResult purge_transmit_queue() override;

 private:
  bool is_unix() const;
  std::string open_raw();
  std::string open_unix();
  TransferStatus lose(TransferStatus status);
  TransferStatus failed(int error);

  CanSocketParams params_;
  int fd_ = -1;
  TransferStatus lost_ = TransferStatus::kGone;  ///< why, while fd_ is -1
  std::int64_t next_attempt_us_ = 0;
  std::int64_t backoff_us_ = 0;
};

/// errno of send() or recv() on a CAN line.
TransferStatus classify_errno(int error);

}  // namespace can
