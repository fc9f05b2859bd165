// SPDX-License-Identifier: BSD-3-Clause
// climb_controller and the plant as processes on vcan0 and a gpio-sim chip, rungs and IMU over LCM:
// the robot as it is started, but for its drives.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <poll.h>

#include "runtime/bus.h"
#include "runtime/clock.h"
#include "tests/support/child_process.h"

namespace hardware {

class ProcessBench {
 public:
  using State = ladder_msgs::climb_state_t;

  /// `bin` holds the programs; `chip_folder` is gpio-sim's in sysfs.
  ProcessBench(std::string bin, const std::string& chip_folder)
      : bin_(std::move(bin)),
        bus_(kUrl),
        states_(bus_.newest(runtime::channels::kClimb)),
        plant_(bin_ + "/ladder_plant", {"--can", "vcan0", "--lines", chip_folder,
                                        "--rungs-from-truth", kUrl, "--print_period_s", "0.2"}),
        controller_(start_controller()) {}

  std::unique_ptr<support::ChildProcess> start_controller() const {
    return std::make_unique<support::ChildProcess>(
        bin_ + "/climb_controller",
        std::vector<std::string>{"--url", kUrl, "--set", "climb.can.interface=vcan0", "--set",
                                 "climb.power_off_hold=brake"});
  }

  /// Exit code of ladder-command, or -1 when it does not end.
  int command(std::vector<std::string> words) {
    words.insert(words.end(), {"--url", kUrl});
    support::ChildProcess tool(bin_ + "/ladder-command", words);
    const int code = tool.wait(std::chrono::seconds(240)).value_or(-1);
    said_ = tool.output();
    return code;
  }

  void send(std::int64_t session_id, std::int64_t seq, std::int8_t order) {
    ladder_msgs::command_t message{};
    message.utime = runtime::clock_now().utime_us;
    message.seq = seq;
    message.session_id = session_id;
    message.order = order;
    bus_.publish(runtime::channels::kCommand, message);
  }

  /// The time [us] that it took until a state satisfied the condition; none within `limit_s`.
  template <class Condition>
  std::optional<std::int64_t> wait_for(Condition condition, double limit_s = 60.0) {
    const std::int64_t start_us = monotonic_us();
    while (static_cast<double>(monotonic_us() - start_us) < 1e6 * limit_s) {
      pollfd waiting{bus_.file_descriptor(), POLLIN, 0};
      ::poll(&waiting, 1, 10);
      bus_.drain();
      if (const State* state = states_.take(0)) now_ = *state;
      if (now_.session_id != 0 && condition(now_)) return monotonic_us() - start_us;
    }
    return std::nullopt;
  }

  /// Configured and not armed. The chip's bias lets the E-stop open for a moment when the lines are
  /// taken: that is acknowledged.
  bool bring_to_disarmed() {
    const auto configured = [](const State& m) {
      return m.bus_phase == State::BUS_READY &&
             (m.state == State::STATE_DISARMED || m.state == State::STATE_ESTOP);
    };
    if (!wait_for(configured)) return false;
    if (now_.state == State::STATE_ESTOP) command({"reset"});
    return wait_for([](const State& m) { return m.state == State::STATE_DISARMED; }, 10.0)
        .has_value();
  }

  static std::int64_t monotonic_us() { return runtime::clock_now().monotonic_us; }

  const State& now() const { return now_; }
  runtime::Bus& bus() { return bus_; }
  support::ChildProcess& plant() { return plant_; }
  support::ChildProcess& controller() { return *controller_; }
  std::string problems() const {
    return "ladder-command: " + said_ + "\ncontroller: " + controller_->output() +
           "\nplant: " + plant_.last_line();
  }

  static constexpr const char* kUrl = runtime::Bus::kDefaultUrl;

 private:
  std::string bin_;
  runtime::Bus bus_;
  runtime::Mailbox<State>& states_;
  support::ChildProcess plant_;
  std::unique_ptr<support::ChildProcess> controller_;
  State now_{};
  std::string said_;
};

}  // namespace hardware
