// SPDX-License-Identifier: BSD-3-Clause
// Where received messages wait for the work step: the newest of a stream, or a bounded
// first-in-first-out queue of commands. LCM's own queue keeps the oldest when it is full, which is
// the wrong end for a stream (docs/ARCHITECTURE.md, "Mailboxes").
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/quantiles.h"

namespace runtime {

/// What happened to the messages of one subscribed channel since the start.
struct InputCounts {
  std::int64_t received = 0;  ///< rejected ones included
  std::int64_t lost = 0;      ///< gaps in seq
  std::int64_t overwritten =
      0;  ///< replaced by a newer one before it was used, or refused by a full queue
  std::int64_t rejected = 0;
  std::int64_t restarts = 0;  ///< seq or utime began anew: another sender or another recording
  base::Quantiles age_us;     ///< now - utime when work on it starts
};

/// Holds the newest message only.
template <class Msg>
class Mailbox {
 public:
  explicit Mailbox(InputCounts& counts) : counts_(counts) {}

  /// The newest message if it was not taken before, else nullptr. Valid until the next drain of the
  /// bus.
  const Msg* take(std::int64_t now_utime_us) {
    if (!fresh_) return nullptr;
    fresh_ = false;
    counts_.age_us.add(now_utime_us - message_.utime);
    return &message_;
  }
  bool fresh() const { return fresh_; }

  /// Takes over the content of the message, gives back an old one to decode the next into (its
  /// capacity is reused).
  void put(Msg& message) {
    if (fresh_) ++counts_.overwritten;
    std::swap(message_, message);
    fresh_ = true;
  }

 private:
  InputCounts& counts_;
  Msg message_{};
  bool fresh_ = false;
};

/// Keeps up to a fixed number of messages in order of arrival; a message that finds it full is
/// dropped and counted.
template <class Msg>
class Queue {
 public:
  Queue(InputCounts& counts, std::size_t capacity) : counts_(counts), messages_(capacity) {}

  /// The oldest waiting message, or nullptr. Valid until the next drain of the bus.
  const Msg* take(std::int64_t now_utime_us) {
    if (size_ == 0) return nullptr;
    const Msg& message = messages_[first_];
    first_ = (first_ + 1) % messages_.size();
    --size_;
    counts_.age_us.add(now_utime_us - message.utime);
    return &message;
  }

  void put(Msg& message) {
    if (size_ == messages_.size()) {
      ++counts_.overwritten;
      return;
    }
    std::swap(messages_[(first_ + size_) % messages_.size()], message);
    ++size_;
  }

 private:
  InputCounts& counts_;
  std::vector<Msg> messages_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace runtime
