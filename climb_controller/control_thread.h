// SPDX-License-Identifier: BSD-3-Clause
// The control cycle in its own thread: absolute deadlines on CLOCK_MONOTONIC, real-time priority
// and locked memory where permitted, the servo bus and the lines its own. Nothing in the loop
// waits, allocates, logs or touches LCM: everything goes in and out through slots and queues.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "can/can_socket.h"
#include "can/flight_recorder.h"
#include "can/servo_bus.h"
#include "climb_controller/config.h"
#include "climb_controller/control_cycle.h"
#include "climb_controller/cycle_clock.h"
#include "climb_controller/host_lock.h"
#include "climb_controller/perception_inbox.h"
#include "climb_controller/slots.h"
#include "gpio/lines.h"

namespace climb_controller {

/// What one cycle tells the other thread.
struct CycleNews {
  CycleReport report;
  std::int64_t utime_us = 0;
  std::int64_t num_cycles = 0;
  std::int64_t num_overruns = 0;
};

struct CycleTiming {
  std::int32_t work_us = 0;  ///< from begin to end
  std::int32_t late_us = 0;  ///< begun so long after its deadline
};

class ControlThread {
 public:
  /// Opens nothing. `params.cycle.controller.session_id` is set.
  explicit ControlThread(const ServiceParams& params);
  /// Ends the loop at once; drives hold by their own watch over the master.
  ~ControlThread();
  ControlThread(const ControlThread&) = delete;
  ControlThread& operator=(const ControlThread&) = delete;

  /// Throws runtime::DeviceError: another controller is here, no bus, no lines.
  void start();

  // --- from the thread of messages ---------------------------------------------------------------
  NewestSlot<RungsSnapshot>& rungs() { return rungs_; }
  NewestSlot<ImuSnapshot>& imu() { return imu_; }
  BoundedQueue<climb::OperatorCommand, 16>& orders() { return orders_; }
  /// The service is asked to end: the step in the air is finished.
  void terminate() { terminating_.store(true, std::memory_order_relaxed); }
  /// Drives stop and hold by themselves; has_handed_over() some cycles later.
  void hand_over() { handing_over_.store(true, std::memory_order_relaxed); }
  void want_flight() { flight_wanted_.store(true, std::memory_order_relaxed); }

  // --- to it -------------------------------------------------------------------------------------
  /// Readable when there is news.
  int news_fd() const { return news_fd_; }
  /// To be called when it was readable, or at any time.
  void forget_wake_up();
  NewestSlot<CycleNews>& news() { return news_; }
  BoundedQueue<CycleTiming, 256>& timings() { return timings_; }
  bool has_handed_over() const { return handed_over_.load(std::memory_order_relaxed); }
  /// The last frames and events, once after each want_flight(); until release_flight().
  const can::FlightRecorder* flight() const;
  void release_flight();
  /// "SCHED_FIFO 80, memory locked", or what was not permitted.
  const std::string& rights() const { return rights_; }

 private:
  void settle_lines();
  void run();
  void wait_until(std::int64_t deadline_us);
  void cycle(std::int64_t deadline_us);
  void fill_inbox(std::int64_t now_us, CycleInbox& inbox);
  void serve_requests();

  ServiceParams params_;
  std::int64_t period_us_;
  std::optional<HostLock> lock_;
  can::CanSocket socket_;
  can::FlightRecorder recorder_;
  can::FlightRecorder flight_;  ///< a copy for the other thread
  std::unique_ptr<can::ServoBus> bus_;
  std::unique_ptr<gpio::LineChip> chip_;
  gpio::Lines lines_;
  ControlCycle cycle_;
  CycleClock clock_;

  NewestSlot<RungsSnapshot> rungs_;
  NewestSlot<ImuSnapshot> imu_;
  BoundedQueue<climb::OperatorCommand, 16> orders_;
  NewestSlot<CycleNews> news_;
  BoundedQueue<CycleTiming, 256> timings_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> terminating_{false};
  std::atomic<bool> handing_over_{false};
  std::atomic<bool> handed_over_{false};
  std::atomic<bool> flight_wanted_{false};
  std::atomic<bool> flight_ready_{false};
  int cycles_since_hand_over_ = 0;

  int timer_fd_ = -1;
  int news_fd_ = -1;
  std::string rights_;
  std::thread thread_;
};

}  // namespace climb_controller
