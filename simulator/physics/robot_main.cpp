// SPDX-License-Identifier: BSD-3-Clause
// ladder_robot: robot and ladder in physics and in real time. Speaks what hardware speaks: drives
// on CAN, touch switches and E-stop on lines, depth heads and inertial unit on LCM; beside it the
// truth and, at the end, the figures of the climb. Signals as with ladder_plant: SIGUSR1 dock,
// SIGUSR2 E-stop; --hand takes these and every fault as lines. Exit codes: 0 done or asked to stop,
// 2 wrong arguments, 3 a door is shut.
#include <cstdio>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "runtime/channels.h"
#include "simulator/physics/before_ladder.h"
#include "simulator/physics/climb_witness.h"
#include "simulator/physics/head_thread.h"
#include "simulator/physics/physics_mechanics.h"
#include "simulator/plant/fault_script.h"
#include "simulator/plant/hardware_doors.h"
#include "simulator/plant/line_reader.h"
#include "simulator/plant/plant_process.h"
#include "simulator/plant/truth_line.h"
#include "simulator/plant/truth_perception.h"

namespace {

constexpr std::int64_t kImuPeriod_us = 10'000;
constexpr std::int64_t kMaxCatchUp_us = 50'000;

struct Arguments {
  std::string can = "unix:/tmp/ladder_can";
  std::string lines = "unix:/tmp/ladder_lines";
  std::string url;
  std::string json_path;
  std::vector<std::string> faults;
  std::string scene = "plain";
  simulator::SceneParams ladder;
  std::vector<int> dead_heads;
  double seconds = 0.0;
  double print_period_s = 0.0;
  bool has_hand = false;
};

/// Throws CLI::ParseError and std::invalid_argument.
void parse(int argc, char** argv, Arguments& arguments) {
  CLI::App app("Robot and ladder in physics, in real time.", "ladder_robot");
  arguments.ladder.num_rungs = 13;
  std::optional<int> damaged_rung;
  app.add_option("--can", arguments.can, "unix:PATH (served here) or a CAN interface");
  app.add_option("--lines", arguments.lines,
                 "unix:PATH (served here) or the sysfs folder of a gpio-sim chip");
  app.add_option("--url", arguments.url, "LCM provider, default LCM_DEFAULT_URL");
  app.add_option("--scene", arguments.scene, "a ladder; a wrong name lists the kinds");
  app.add_option("--seed", arguments.ladder.seed, "of ladder, mounting errors and noise");
  app.add_option("--num_rungs", arguments.ladder.num_rungs);
  app.add_option("--spacing_m", arguments.ladder.spacing_m);
  app.add_option("--damaged_rung", damaged_rung, "which rung is missing, bent or broken, from 0");
  app.add_option("--dead_heads", arguments.dead_heads, "heads that send nothing")->delimiter(',');
  app.add_option("--fault", arguments.faults, "TIME_S KIND [TARGET [VALUE [FOR_S]]]; repeatable")
      ->allow_extra_args(false);
  app.add_flag("--hand", arguments.has_hand,
               "obey lines on standard input at once: a fault's KIND [TARGET [VALUE [FOR_S]]], "
               "head_dead N, head_back N, dock, undock");
  app.add_option("--print_period_s", arguments.print_period_s, "0: only rungs climbed are told");
  app.add_option("--seconds", arguments.seconds, "stop after this time");
  app.add_option("--json", arguments.json_path, "write the climb's figures at the end");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& help) {
    app.exit(help);
    throw;
  }
  arguments.ladder.kind = simulator::scene_kind_from_string(arguments.scene);
  if (damaged_rung) arguments.ladder.damaged_rung = *damaged_rung;
}

std::vector<simulator::Fault> faults_of(const Arguments& arguments) {
  std::ostringstream text;
  for (const std::string& line : arguments.faults) text << line << '\n';
  simulator::ParsedFaults parsed = simulator::parse_faults(text.str());
  if (!parsed.problem.empty()) throw std::invalid_argument("faults: " + parsed.problem);
  return parsed.faults;
}

simulator::BodyHeadsParams heads_of(const Arguments& arguments) {
  simulator::BodyHeadsParams heads;
  heads.seed = arguments.ladder.seed;
  for (const int head : arguments.dead_heads) {
    if (head < 0 || head >= simulator::kNumHeads) {
      throw std::invalid_argument("--dead_heads: a head is 0, 1, 2 or 3");
    }
    heads.dead[static_cast<std::size_t>(head)] = true;
  }
  return heads;
}

std::vector<int> unsafe_rungs(const simulator::Scene& scene) {
  std::vector<int> unsafe;
  for (std::size_t i = 0; i < scene.rungs.size(); ++i) {
    if (scene.rungs[i].kind != simulator::RungKind::kSound) unsafe.push_back(static_cast<int>(i));
  }
  return unsafe;
}

/// Odom begins where the body is in the dock; its axes are the world's.
Eigen::Isometry3d odom_at(const Eigen::Isometry3d& T_world_body) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = -T_world_body.translation();
  return pose;
}

class RunningRobot {
 public:
  explicit RunningRobot(const Arguments& arguments)
      : arguments_(arguments),
        scene_(simulator::make_scene(arguments.ladder)),
        model_(scene_),
        plant_(simulator::before_ladder(scene_), memory_,
               [this](const simulator::PlantParams& plant) {
                 return std::make_unique<simulator::PhysicsMechanics>(plant, model_);
               }),
        doors_(memory_, arguments.can, arguments.lines),
        player_(faults_of(arguments), memory_),
        imu_bus_(arguments.url),
        heads_(simulator::BodyHeads(heads_of(arguments), scene_, model_,
                                    odom_at(plant_.T_world_body())),
               arguments.url),
        witness_(arguments.url, unsafe_rungs(scene_)) {
    if (arguments.has_hand) hand_.emplace(STDIN_FILENO);
    std::printf("ladder %s, seed %llu, %d rungs; servo bus %s, lines %s\n", arguments.scene.c_str(),
                static_cast<unsigned long long>(arguments.ladder.seed), arguments.ladder.num_rungs,
                arguments.can.c_str(), arguments.lines.c_str());
    std::fflush(stdout);
  }

  void run() {
    const auto end_us = static_cast<std::int64_t>(arguments_.seconds * 1e6);
    while (!signals_.is_stop_requested() && (end_us == 0 || clock_.now_us() < end_us)) {
      doors_.wait();
      step(clock_.advance());
    }
  }
  const simulator::ClimbWitness& witness() const { return witness_; }

 private:
  void step(std::int64_t now_us) {
    doors_.take_in(now_us, plant_);
    if (hand_) {
      for (const std::string& line : hand_->take()) obey(line, now_us);
    }
    player_.apply(now_us, plant_, memory_);
    signals_.obey(plant_);
    plant_.advance(now_us);
    doors_.give_out(now_us, plant_);
    heads_.offer(now_us, model_, plant_.T_world_body());
    print(now_us);
    if (now_us < imu_due_us_) return;
    imu_due_us_ = now_us + kImuPeriod_us;
    ladder_msgs::imu_t imu = simulator::imu_message(plant_.imu(), simulator::utime_us());
    imu.seq = imu_seq_++;
    imu_bus_.publish(runtime::channels::kImu, imu);
    witness_.see(plant_.truth(), 1e-6 * static_cast<double>(clock_.wall_us()));
  }

  void obey(const std::string& line, std::int64_t now_us) {
    std::istringstream words(line);
    std::string what;
    int head = -1;
    words >> what;
    if (what == "dock") return plant_.set_docked(true);
    if (what == "head_dead" || what == "head_back") {
      words >> head;
      if (head >= 0 && head < simulator::kNumHeads)
        return heads_.set_dead(head, what == "head_dead");
    }
    const simulator::ParsedFaults parsed = simulator::parse_faults(std::string("0 ").append(line));
    if (!parsed.problem.empty()) {
      std::fprintf(stderr, "ladder_robot: not understood: %s\n", line.c_str());
    }
    for (simulator::Fault fault : parsed.faults) {
      fault.time_us = now_us;
      player_.add(fault);
    }
  }

  void print(std::int64_t now_us) {
    if (arguments_.print_period_s <= 0.0 || now_us < print_due_us_) return;
    print_due_us_ = now_us + static_cast<std::int64_t>(arguments_.print_period_s * 1e6);
    std::printf("%8.2f s  truth  %s\n", 1e-6 * static_cast<double>(now_us),
                simulator::truth_line(plant_.truth()).c_str());
    std::fflush(stdout);
  }

  const Arguments& arguments_;
  simulator::HandSignals signals_;  // first: it may be asked to stop while it starts
  simulator::Scene scene_;
  simulator::PhysicsModel model_;
  simulator::MemoryBus memory_;
  simulator::RobotPlant plant_;
  simulator::HardwareDoors doors_;
  simulator::PlantClock clock_{kMaxCatchUp_us};
  simulator::FaultPlayer player_;
  runtime::Bus imu_bus_;
  simulator::HeadThread heads_;
  simulator::ClimbWitness witness_;
  std::optional<simulator::LineReader> hand_;
  std::int64_t imu_due_us_ = 0;
  std::int64_t imu_seq_ = 0;
  std::int64_t print_due_us_ = 0;
};

int run(int argc, char** argv) {
  Arguments arguments;
  parse(argc, argv, arguments);
  RunningRobot robot(arguments);
  simulator::stand_for_hardware();
  robot.run();
  if (arguments.json_path.empty() || robot.witness().write(arguments.json_path)) return 0;
  std::fprintf(stderr, "ladder_robot: cannot write %s\n", arguments.json_path.c_str());
  return simulator::kExitNoDoor;
}

}  // namespace

int main(int argc, char** argv) {
  return simulator::exit_code_of("ladder_robot", run, argc, argv);
}
