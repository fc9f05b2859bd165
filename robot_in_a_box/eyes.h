// SPDX-License-Identifier: BSD-3-Clause
// How the climbing robot in the box gets to know rungs: from truth with an error
// (perceived_ladder.h), or by heads and the perception services (full_perception.h).
#pragma once

#include <cstdint>

#include "climb_controller/control_cycle.h"
#include "simulator/plant/robot_plant.h"

namespace robot_in_a_box {

class Eyes {
 public:
  virtual ~Eyes() = default;
  /// Every millisecond, after the plant has moved. `told` is what the controller published last.
  virtual void look(std::int64_t now_us, simulator::RobotPlant& plant,
                    const climb_controller::CycleReport& told) = 0;
  virtual climb::LadderView view() const = 0;
  virtual std::int64_t received_us() const = 0;
};

}  // namespace robot_in_a_box
