// SPDX-License-Identifier: BSD-3-Clause
// The controller climbs on kernel devices: sixteen axes on vcan at 100 Hz, touch and E-stop on a
// gpio-sim chip, the plant on the other side of both.
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "tests/hardware/bus_log.h"
#include "tests/hardware/kernel_box.h"

namespace {

using climb::CommandVerdict;
using climb::ControllerState;
using climb::Order;
using hardware::KernelBox;
using hardware::KernelBoxParams;

KernelBoxParams box_params() {
  KernelBoxParams params;
  const char* folder = std::getenv("LADDER_GPIO_SIM");
  params.chip_folder = folder != nullptr ? folder : "";
  return params;
}

double seconds(const KernelBox& box) {
  return 1e-6 * static_cast<double>(box.now_us());
}

int num_held(KernelBox& box) {
  int count = 0;
  for (const simulator::LegTruth& leg : box.plant().truth().legs) count += leg.holds ? 1 : 0;
  return count;
}

/// True once some claw holds a higher rung than at the start and all four hold.
bool climbs_a_step(KernelBox& box, double within_s) {
  const simulator::PlantTruth start = box.plant().truth();
  const std::int64_t end_us = box.now_us() + static_cast<std::int64_t>(1e6 * within_s);
  while (box.now_us() < end_us) {
    box.cycle();
    const simulator::PlantTruth now = box.plant().truth();
    for (std::size_t leg = 0; leg < now.legs.size(); ++leg) {
      const bool is_higher = now.legs[leg].rung_index > start.legs[leg].rung_index;
      if (is_higher && num_held(box) == 4 &&
          box.report().output.limbs[leg] == climb::LimbState::kLoaded) {
        return true;
      }
    }
  }
  return false;
}

// From power-up in the dock: armed, four claws gripped, one limb to a new rung, held, disarmed; and
// the monitor, which sees only frames, lines and truth, has nothing to say.
TEST(ClimbOnKernel, PowerUpGripStepDisarm) {
  hardware::BusLog log("vcan0");
  KernelBox box(box_params());
  ASSERT_TRUE(box.reach(ControllerState::kDisarmed, 20.0)) << box.problems();
  std::printf("disarmed, configured after %.1f s\n", seconds(box));
  box.run_s(3.0);
  ASSERT_EQ(box.order(Order::kArm), CommandVerdict::kAccepted) << box.problems();
  ASSERT_TRUE(box.reach(ControllerState::kHold, 120.0)) << box.problems();
  EXPECT_EQ(num_held(box), 4);
  std::printf("four claws hold after %.1f s\n", seconds(box));
  box.plant().set_docked(false);
  ASSERT_EQ(box.order(Order::kClimb), CommandVerdict::kAccepted) << box.problems();
  EXPECT_TRUE(climbs_a_step(box, 60.0)) << box.problems();
  std::printf("one limb on a new rung after %.1f s\n", seconds(box));
  ASSERT_EQ(box.order(Order::kHold), CommandVerdict::kAccepted) << box.problems();
  ASSERT_TRUE(box.reach(ControllerState::kHold, 60.0)) << box.problems();
  ASSERT_EQ(box.order(Order::kDisarm), CommandVerdict::kAccepted) << box.problems();
  EXPECT_TRUE(box.reach(ControllerState::kDisarmed, 20.0)) << box.problems();
  EXPECT_EQ(num_held(box), 4);
  EXPECT_TRUE(box.monitor().violations().empty()) << box.problems();
  log.keep(LADDER_BUS_LOG);
  std::printf("%d cycles, %d overruns, worst %.1f ms late, %.1f s\n", box.num_cycles,
              box.num_overruns, 1e-3 * static_cast<double>(box.worst_late_us), seconds(box));
}

}  // namespace
