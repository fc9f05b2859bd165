// SPDX-License-Identifier: BSD-3-Clause
// ladder_plant: the robot on its ladder in real time, for a controller process that speaks CAN and
// reads lines. Prints its state once a second. Exit codes: 0 asked to stop, 2 wrong arguments, 3 a
// door (CAN, lines, LCM) cannot be opened.
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <poll.h>
#include <sched.h>

#include "runtime/bus.h"
#include "runtime/channels.h"
#include "simulator/plant/bus_hub.h"
#include "simulator/plant/fault_script.h"
#include "simulator/plant/line_hub.h"
#include "simulator/plant/robot_plant.h"
#include "simulator/plant/truth_line.h"
#include "simulator/plant/truth_message.h"
#include "simulator/plant/truth_perception.h"

namespace {

constexpr int kExitArguments = 2;
constexpr int kExitNoDoor = 3;
constexpr int kPriority = 40;
constexpr std::int64_t kTruthPeriod_us = 100'000;
constexpr std::int64_t kRungsPeriod_us = 66'667;
constexpr std::int64_t kImuPeriod_us = 10'000;
/// A process that was held up goes on from where it is, it does not run after lost seconds.
constexpr std::int64_t kMaxCatchUp_us = 100'000;

volatile std::sig_atomic_t stop_requested = 0;
void request_stop(int) {
  stop_requested = 1;
}
volatile std::sig_atomic_t dock_signal = 0;
void toggle_dock(int) {
  dock_signal = 1 - dock_signal;
}
volatile std::sig_atomic_t estop_pressed = 0;
void toggle_estop(int) {
  estop_pressed = 1 - estop_pressed;
}

struct Arguments {
  std::string can = "unix:/tmp/ladder_can";
  std::string lines;
  std::string faults_path;
  std::vector<std::string> faults;
  std::string truth_url;
  std::string rungs_url;
  double seconds = 0.0;
  double undock_s = -1.0;
  double print_period_s = 1.0;
  bool without_hold_on_loss = false;
  simulator::PlantParams plant;
};

/// Throws CLI::ParseError.
void parse(int argc, char** argv, Arguments& arguments) {
  CLI::App app(
      "The robot on its ladder: sixteen drives, claws, rungs, lines. "
      "SIGUSR1 releases the dock and holds the body again where it is, "
      "SIGUSR2 presses and releases the E-stop.",
      "ladder_plant");
  bool gripping = false;
  app.add_option("--can", arguments.can, "unix:PATH (served here) or a CAN interface");
  app.add_option("--lines", arguments.lines,
                 "unix:PATH (served here) or the sysfs folder of a gpio-sim chip");
  app.add_option("--faults", arguments.faults_path, "file: TIME_S KIND [TARGET [VALUE [FOR_S]]]");
  app.add_option("--fault", arguments.faults, "one such line; may be repeated")
      ->allow_extra_args(false);
  app.add_option("--truth", arguments.truth_url, "publish LADDER_TRUTH on this LCM provider");
  app.add_option("--rungs-from-truth", arguments.rungs_url,
                 "publish LADDER_RUNGS and LADDER_IMU on this LCM provider");
  app.add_option("--seconds", arguments.seconds, "stop after this time");
  app.add_option("--undock_s", arguments.undock_s, "release the dock at this time");
  app.add_option("--print_period_s", arguments.print_period_s, "0: print nothing");
  app.add_option("--seed", arguments.plant.seed);
  app.add_flag("--gripping", gripping, "start with four claws on their rungs, no dock");
  app.add_flag("--force_nodes", arguments.plant.has_force_nodes, "I/O nodes 0x21..0x24");
  app.add_flag("--without_hold_on_loss", arguments.without_hold_on_loss,
               "drives without 6007h, 6072h and 6077h");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    app.exit(help);
    throw;
  }
  if (gripping) arguments.plant.start = simulator::PlantStart::kGripping;
  for (simulator::DriveParams& drive : arguments.plant.drives) {
    if (!arguments.without_hold_on_loss) continue;
    drive.objects.abort_connection_option = false;
    drive.objects.max_torque = false;
    drive.objects.torque_actual = false;
  }
}

/// Throws std::invalid_argument.
std::vector<simulator::Fault> faults_of(const Arguments& arguments) {
  std::ostringstream text;
  if (!arguments.faults_path.empty()) {
    std::ifstream file(arguments.faults_path);
    if (!file) throw std::invalid_argument("cannot read " + arguments.faults_path);
    text << file.rdbuf() << '\n';
  }
  for (const std::string& line : arguments.faults) text << line << '\n';
  if (arguments.undock_s >= 0.0) text << arguments.undock_s << " undock\n";
  simulator::ParsedFaults parsed = simulator::parse_faults(text.str());
  if (!parsed.problem.empty()) throw std::invalid_argument("faults: " + parsed.problem);
  return parsed.faults;
}

std::int64_t monotonic_us() {
  using std::chrono::steady_clock;
  return std::chrono::duration_cast<std::chrono::microseconds>(
             steady_clock::now().time_since_epoch())
      .count();
}

std::int64_t utime_us() {
  using std::chrono::system_clock;
  return std::chrono::duration_cast<std::chrono::microseconds>(
             system_clock::now().time_since_epoch())
      .count();
}

/// Drives do not wait for other programs: real-time where permitted, below the controller's.
void stand_for_hardware() {
  sched_param priority{};
  priority.sched_priority = kPriority;
  static_cast<void>(sched_setscheduler(0, SCHED_FIFO, &priority));
}

class RunningPlant {
 public:
  explicit RunningPlant(const Arguments& arguments)
      : arguments_(arguments),
        plant_(arguments.plant, bus_),
        hub_(bus_, simulator::open_gateway(arguments.can)),
        player_(faults_of(arguments), bus_),
        odom_origin_m_(plant_.T_world_body().translation()) {
    const std::string prefix = "unix:";
    if (arguments.lines.rfind(prefix, 0) == 0) {
      lines_.emplace(arguments.lines.substr(prefix.size()));
    } else if (!arguments.lines.empty()) {
      chip_.emplace(arguments.lines, std::array<int, simulator::kNumLines>{0, 1, 2, 3, 4});
    }
    if (!arguments.truth_url.empty()) truth_bus_.emplace(arguments.truth_url);
    if (!arguments.rungs_url.empty()) rungs_bus_.emplace(arguments.rungs_url);
  }

  void run() {
    const std::int64_t start_us = monotonic_us();
    const auto end_us = static_cast<std::int64_t>(arguments_.seconds * 1e6);
    std::int64_t skipped_us = 0;
    while (stop_requested == 0) {
      wait();
      std::int64_t now_us = monotonic_us() - start_us - skipped_us;
      if (now_us - last_us_ > kMaxCatchUp_us) {
        skipped_us += now_us - last_us_ - kMaxCatchUp_us;
        now_us = last_us_ + kMaxCatchUp_us;
      }
      step(now_us);
      last_us_ = now_us;
      if (end_us > 0 && now_us >= end_us) return;
    }
  }

 private:
  /// Until a frame or a record comes, at most one step.
  void wait() {
    descriptors_.clear();
    hub_.gateway().add_to_poll(descriptors_);
    if (lines_) lines_->add_to_poll(descriptors_);
    ::poll(descriptors_.data(), descriptors_.size(), 1);
  }

  void step(std::int64_t now_us) {
    hub_.take_in(now_us);
    if (lines_) {
      for (const auto& hand : lines_->receive()) plant_.set_wire_fault(hand.line, hand.fault);
    }
    player_.apply(now_us, plant_, bus_);
    obey_hand();
    plant_.advance(now_us);
    hub_.give_out(now_us);
    if (lines_) lines_->publish(plant_.lines());
    if (chip_ && !chip_->publish(plant_.lines())) ++num_line_failures_;
    if (truth_bus_ && now_us >= truth_due_us_) publish_truth(now_us);
    if (rungs_bus_) publish_perception(now_us);
    const auto period_us = static_cast<std::int64_t>(arguments_.print_period_s * 1e6);
    if (period_us > 0 && now_us >= print_due_us_) {
      print_due_us_ = now_us + period_us;
      print(now_us);
    }
  }

  /// What a tester does by signals; a script may do the same at its times.
  void obey_hand() {
    if (dock_signal != hand_dock_signal_) plant_.set_docked(!plant_.is_docked());
    hand_dock_signal_ = dock_signal;
    if (estop_pressed == hand_pressed_) return;
    hand_pressed_ = estop_pressed;
    plant_.press_estop(hand_pressed_ != 0);
  }

  void publish_truth(std::int64_t now_us) {
    truth_due_us_ = now_us + kTruthPeriod_us;
    ladder_msgs::truth_t message =
        simulator::truth_message(plant_.truth(), plant_.world(), odom_origin_m_, utime_us());
    message.seq = truth_seq_++;
    truth_bus_->publish(runtime::channels::kTruth, message);
  }

  void publish_perception(std::int64_t now_us) {
    if (now_us >= imu_due_us_) {
      imu_due_us_ = now_us + kImuPeriod_us;
      ladder_msgs::imu_t message = simulator::imu_message(plant_.imu(), utime_us());
      message.seq = imu_seq_++;
      rungs_bus_->publish(runtime::channels::kImu, message);
    }
    if (now_us >= rungs_due_us_) {
      rungs_due_us_ = now_us + kRungsPeriod_us;
      ladder_msgs::ladder_t message =
          simulator::true_rungs(plant_.world(), odom_origin_m_, utime_us());
      message.seq = message.topology_seq = rungs_seq_++;
      rungs_bus_->publish(runtime::channels::kRungs, message);
    }
  }

  void print(std::int64_t now_us) {
    std::printf("%8.1f s  frames %lld in %lld out %lld lost  %s\n",
                1e-6 * static_cast<double>(now_us), static_cast<long long>(hub_.num_taken()),
                static_cast<long long>(hub_.num_given()),
                static_cast<long long>(hub_.gateway().num_lost()),
                simulator::truth_line(plant_.truth()).c_str());
    std::fflush(stdout);
  }

  const Arguments& arguments_;
  simulator::MemoryBus bus_;
  simulator::RobotPlant plant_;
  simulator::BusHub hub_;
  simulator::FaultPlayer player_;
  Eigen::Vector3d odom_origin_m_;
  std::optional<simulator::LineHub> lines_;
  std::optional<simulator::SimulatedChip> chip_;
  std::optional<runtime::Bus> truth_bus_;
  std::optional<runtime::Bus> rungs_bus_;
  std::vector<pollfd> descriptors_;
  std::int64_t last_us_ = 0;
  int hand_dock_signal_ = 0;
  int hand_pressed_ = 0;
  std::int64_t print_due_us_ = 0;
  std::int64_t truth_due_us_ = 0;
  std::int64_t truth_seq_ = 0;
  std::int64_t imu_due_us_ = 0;
  std::int64_t imu_seq_ = 0;
  std::int64_t rungs_due_us_ = 0;
  std::int64_t rungs_seq_ = 0;
  std::int64_t num_line_failures_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGTERM, request_stop);
  std::signal(SIGINT, request_stop);
  std::signal(SIGUSR1, toggle_dock);
  std::signal(SIGUSR2, toggle_estop);
  Arguments arguments;
  try {
    parse(argc, argv, arguments);
    stand_for_hardware();
    RunningPlant(arguments).run();
    return 0;
  } catch (const CLI::CallForHelp&) {
    return 0;
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "ladder_plant: %s\n", error.what());
    return kExitArguments;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "ladder_plant: %s\n", error.what());
    return kExitArguments;
  } catch (const simulator::DoorError& error) {
    std::fprintf(stderr, "ladder_plant: %s\n", error.what());
    return kExitNoDoor;
  } catch (const runtime::BusError& error) {
    std::fprintf(stderr, "ladder_plant: %s\n", error.what());
    return kExitNoDoor;
  }
}
