// SPDX-License-Identifier: BSD-3-Clause
// Messages with random content that obey every documented rule, for tests, fuzz seeds and the spy.
#pragma once

#include "runtime/base/rng.h"
#include "tests/lcmtypes/all_types.h"

namespace lcmtypes {

/// A sound message; `size` (0..) scales its arrays: about size rungs, 10 size nodes, 100 size
/// points. size 0 = everything empty.
void fill_sample(ladder_msgs::climb_state_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::command_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::config_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::event_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::health_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::imu_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::ladder_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::point_cloud_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::pose_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::tof_frame_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::topology_t& m, int size, base::Rng& rng);
void fill_sample(ladder_msgs::truth_t& m, int size, base::Rng& rng);

template <class Msg>
Msg sample(int size, std::uint64_t seed) {
  Msg message{};
  base::Rng rng(seed);
  fill_sample(message, size, rng);
  return message;
}

}  // namespace lcmtypes
