// SPDX-License-Identifier: BSD-3-Clause
// ladder_plant: the robot on its ladder in real time, for a controller process that speaks CAN and
// reads lines. Prints its state once a second. Exit codes: 0 asked to stop, 2 wrong arguments, 3 a
// door (CAN, lines, LCM) cannot be opened.
#include <cstdio>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "runtime/bus.h"
#include "runtime/channels.h"
#include "simulator/plant/fault_script.h"
#include "simulator/plant/hardware_doors.h"
#include "simulator/plant/plant_process.h"
#include "simulator/plant/robot_plant.h"
#include "simulator/plant/truth_line.h"
#include "simulator/plant/truth_message.h"
#include "simulator/plant/truth_perception.h"

namespace {

constexpr std::int64_t kTruthPeriod_us = 100'000;
constexpr std::int64_t kRungsPeriod_us = 66'667;
constexpr std::int64_t kImuPeriod_us = 10'000;
constexpr std::int64_t kMaxCatchUp_us = 100'000;

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
                 "publish LADDER_RUNGS and LADDER_IMU on this LCM provider, the rungs as seen from "
                 "where LADDER_POSE says the body is");
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

class RunningPlant {
 public:
  explicit RunningPlant(const Arguments& arguments)
      : arguments_(arguments),
        plant_(arguments.plant, bus_),
        doors_(bus_, arguments.can, arguments.lines),
        player_(faults_of(arguments), bus_),
        odom_origin_m_(plant_.T_world_body().translation()) {
    if (!arguments.truth_url.empty()) truth_bus_.emplace(arguments.truth_url);
    if (arguments.rungs_url.empty()) return;
    rungs_bus_.emplace(arguments.rungs_url);
    poses_ = &rungs_bus_->newest(runtime::channels::kPose);
  }

  void run() {
    const auto end_us = static_cast<std::int64_t>(arguments_.seconds * 1e6);
    while (!signals_.is_stop_requested() && (end_us == 0 || clock_.now_us() < end_us)) {
      doors_.wait();
      step(clock_.advance());
    }
  }

 private:
  void step(std::int64_t now_us) {
    doors_.take_in(now_us, plant_);
    player_.apply(now_us, plant_, bus_);
    signals_.obey(plant_);
    plant_.advance(now_us);
    doors_.give_out(now_us, plant_);
    if (truth_bus_ && now_us >= truth_due_us_) publish_truth(now_us);
    if (rungs_bus_) publish_perception(now_us);
    const auto period_us = static_cast<std::int64_t>(arguments_.print_period_s * 1e6);
    if (period_us > 0 && now_us >= print_due_us_) {
      print_due_us_ = now_us + period_us;
      print(now_us);
    }
  }

  void publish_truth(std::int64_t now_us) {
    truth_due_us_ = now_us + kTruthPeriod_us;
    ladder_msgs::truth_t message = simulator::truth_message(plant_.truth(), plant_.world(),
                                                            odom_origin_m_, simulator::utime_us());
    message.seq = truth_seq_++;
    truth_bus_->publish(runtime::channels::kTruth, message);
  }

  void publish_perception(std::int64_t now_us) {
    if (now_us >= imu_due_us_) {
      imu_due_us_ = now_us + kImuPeriod_us;
      ladder_msgs::imu_t message = simulator::imu_message(plant_.imu(), simulator::utime_us());
      message.seq = imu_seq_++;
      rungs_bus_->publish(runtime::channels::kImu, message);
    }
    if (now_us >= rungs_due_us_) {
      rungs_due_us_ = now_us + kRungsPeriod_us;
      ladder_msgs::ladder_t message =
          simulator::true_rungs(plant_.world(), T_odom_world(), simulator::utime_us());
      message.seq = message.topology_seq = rungs_seq_++;
      rungs_bus_->publish(runtime::channels::kRungs, message);
    }
  }

  /// Rungs are seen from the body: where odometry has lost its way, they come along. Before a pose
  /// is told, odom begins where the body began.
  Eigen::Isometry3d T_odom_world() {
    rungs_bus_->drain();
    if (const ladder_msgs::pose_t* pose = poses_->take(0)) {
      T_odom_body_.emplace(Eigen::Translation3d(Eigen::Vector3d(pose->p_odom_body_m)) *
                           Eigen::Quaterniond(pose->q_odom_body[0], pose->q_odom_body[1],
                                              pose->q_odom_body[2], pose->q_odom_body[3]));
    }
    if (T_odom_body_) return *T_odom_body_ * plant_.T_world_body().inverse();
    return Eigen::Isometry3d(Eigen::Translation3d(-odom_origin_m_));
  }

  void print(std::int64_t now_us) {
    std::printf("%8.1f s  frames %lld in %lld out %lld lost  %s\n",
                1e-6 * static_cast<double>(now_us),
                static_cast<long long>(doors_.hub().num_taken()),
                static_cast<long long>(doors_.hub().num_given()),
                static_cast<long long>(doors_.hub().gateway().num_lost()),
                simulator::truth_line(plant_.truth()).c_str());
    std::fflush(stdout);
  }

  const Arguments& arguments_;
  simulator::HandSignals signals_;  // first: it may be asked to stop while it starts
  simulator::MemoryBus bus_;
  simulator::RobotPlant plant_;
  simulator::HardwareDoors doors_;
  simulator::PlantClock clock_{kMaxCatchUp_us};
  simulator::FaultPlayer player_;
  Eigen::Vector3d odom_origin_m_;
  std::optional<runtime::Bus> truth_bus_;
  std::optional<runtime::Bus> rungs_bus_;
  runtime::Mailbox<ladder_msgs::pose_t>* poses_ = nullptr;  ///< on rungs_bus_
  std::optional<Eigen::Isometry3d> T_odom_body_;            ///< as the controller told it last
  std::int64_t print_due_us_ = 0;
  std::int64_t truth_due_us_ = 0;
  std::int64_t truth_seq_ = 0;
  std::int64_t imu_due_us_ = 0;
  std::int64_t imu_seq_ = 0;
  std::int64_t rungs_due_us_ = 0;
  std::int64_t rungs_seq_ = 0;
};

int run(int argc, char** argv) {
  Arguments arguments;
  parse(argc, argv, arguments);
  simulator::stand_for_hardware();
  RunningPlant(arguments).run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return simulator::exit_code_of("ladder_plant", run, argc, argv);
}
