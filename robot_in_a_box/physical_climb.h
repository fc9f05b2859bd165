// SPDX-License-Identifier: BSD-3-Clause
// One climb of the robot in physics, in virtual time: the real controller and CAN master, MuJoCo's
// contacts, rungs from truth with perception's error. Dock, arming, up, and down again if wanted.
// The heads and the services of perception are not in it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "robot_in_a_box/climb_box.h"
#include "simulator/physics/climb_figures.h"
#include "simulator/physics/physics_mechanics.h"

namespace robot_in_a_box {

struct WeakRung {
  int index = -1;
  double break_load_N = 0.0;
};

struct PhysicalClimbParams {
  simulator::SceneParams scene;
  PerceptionParams perception;
  climb_controller::CycleParams cycle = cycle_with_brakes();
  std::vector<WeakRung> weak_rungs;  ///< they look sound
  std::uint64_t seed = 1;
  bool attitude_from_samples = false;  ///< ClimbBoxParams has it
};

enum class ClimbEnd : std::uint8_t {
  kTop,
  kDock,    ///< come down again
  kHeld,    ///< no way on; the reason is told
  kFault,   ///< FAULT_HOLD or E-stop
  kFallen,  ///< off the ladder
  kTooLong
};
const char* name(ClimbEnd end);

class PhysicalClimb : private BoxWatcher {
 public:
  explicit PhysicalClimb(const PhysicalClimbParams& params);

  /// Power-up, arming in the dock, four claws closed, the dock lets go and it has settled. False:
  /// that did not come about.
  bool hang();
  /// Climbs until it holds, stops or falls.
  ClimbEnd climb(bool upwards, double within_s);
  /// At the dock's place: the dock takes it again, and it is disarmed. False: it was not.
  bool back_into_dock();
  /// Why it does not go on: the fault, or why no rung may be taken.
  std::string reason() const;

  void run_s(double duration_s);
  /// Called once per simulated second.
  void each_second(std::function<void()> call) { each_second_ = std::move(call); }
  bool reach(climb::ControllerState state, double within_s);
  int num_held() const;
  double height_m() const { return box_.plant().T_world_body().translation().z(); }
  ClimbBox& box() { return box_; }
  const ClimbBox& box() const { return box_; }
  const simulator::Figures& figures() const { return figures_.told(); }
  const simulator::Scene& scene() const { return scene_; }
  const simulator::PhysicsModel& model() const { return model_; }

 private:
  void before(std::int64_t now_us) override {
    if (each_second_ && now_us % 1'000'000 == 0) each_second_();
  }
  void on_frame(const simulator::CarriedFrame&) override {}
  void on_truth(const simulator::PlantTruth& truth) override;
  void on_report(const climb_controller::CycleReport&) override {}

  simulator::Scene scene_;
  simulator::PhysicsModel model_;
  ClimbBox box_;
  simulator::ClimbFigures figures_;
  std::function<void()> each_second_;
};

}  // namespace robot_in_a_box
