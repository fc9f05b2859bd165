// SPDX-License-Identifier: BSD-3-Clause
// How two threads hand values to each other without waiting: the newest of a kind, or a bounded
// queue. One writer, one reader; neither ever blocks or allocates.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace climb_controller {

/// The newest value wins. Three buffers: one is written, one is read, one lies between.
template <class T>
class NewestSlot {
 public:
  /// For each of the three buffers, before the threads start: reserve capacities.
  template <class Prepare>
  void prepare(Prepare prepare) {
    for (T& buffer : buffers_) prepare(buffer);
  }

  /// Writer: to be filled, then publish(). Holds an older value.
  T& writing() { return buffers_[writing_]; }
  void publish() {
    const std::uint8_t old = between_.exchange(writing_ | kFresh, std::memory_order_acq_rel);
    writing_ = old & kIndex;
  }

  /// Reader: true if something was published since; newest() is new then.
  bool refresh() {
    if ((between_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    const std::uint8_t old = between_.exchange(reading_, std::memory_order_acq_rel);
    reading_ = old & kIndex;
    return true;
  }
  const T& newest() const { return buffers_[reading_]; }

 private:
  static constexpr std::uint8_t kFresh = 4;
  static constexpr std::uint8_t kIndex = 3;

  std::array<T, 3> buffers_{};
  std::uint8_t writing_ = 0;
  std::uint8_t reading_ = 1;
  std::atomic<std::uint8_t> between_{2};
};

/// First in, first out. What finds it full is refused.
template <class T, std::size_t kCapacity>
class BoundedQueue {
 public:
  bool push(const T& value) {
    const std::size_t at = written_.load(std::memory_order_relaxed);
    if (at - read_.load(std::memory_order_acquire) == kCapacity) return false;
    values_[at % kCapacity] = value;
    written_.store(at + 1, std::memory_order_release);
    return true;
  }
  bool pop(T& value) {
    const std::size_t at = read_.load(std::memory_order_relaxed);
    if (at == written_.load(std::memory_order_acquire)) return false;
    value = values_[at % kCapacity];
    read_.store(at + 1, std::memory_order_release);
    return true;
  }

 private:
  std::array<T, kCapacity> values_{};
  std::atomic<std::size_t> written_{0};
  std::atomic<std::size_t> read_{0};
};

}  // namespace climb_controller
