// SPDX-License-Identifier: BSD-3-Clause
// Four depth heads on the moving body: they flash one after the other and see scene and robot as
// both are at that moment. They keep a copy of what they look at, so that another thread may render
// while physics goes on. No clock: the caller asks what is due.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "ladder_msgs/tof_frame_t.hpp"
#include "ladder_msgs/truth_t.hpp"
#include "simulator/head_renderer.h"
#include "simulator/physics/physics_model.h"
#include "simulator/visibility.h"

namespace simulator {

struct BodyHeadsParams {
  SensorParams sensor;
  HeadLayout layout = heads_climb();
  std::array<bool, kNumHeads> dead{};  ///< true: this head sends nothing
  double rate_hz = 15.0;               ///< (0, 60] frames of each head
  std::uint64_t seed = 1;              ///< of mounting errors and noise
};

class BodyHeads {
 public:
  /// The scene is the model's. `T_odom_world` is for truth alone.
  BodyHeads(const BodyHeadsParams& params, const Scene& scene, const PhysicsModel& model,
            const Eigen::Isometry3d& T_odom_world);

  /// When the next head flashes, since the start.
  std::int64_t due_us() const;
  /// Flashes that were missed by a whole round are left out.
  void skip_to(std::int64_t now_us);
  /// Copies what the next head will see.
  void look(const PhysicsModel& model, const Eigen::Isometry3d& T_world_body);
  /// The next head's image of it, or nothing from a dead head. Valid until the next call.
  const ladder_msgs::tof_frame_t* flash(std::int64_t utime_us);
  /// After the last head of a round: the truth at the newest frame's time.
  const ladder_msgs::truth_t* truth() const { return next_head_ == 0 ? &truth_ : nullptr; }
  const std::array<bool, kNumHeads>& dead() const { return params_.dead; }
  void set_dead(int head, bool dead) { params_.dead[static_cast<std::size_t>(head)] = dead; }

 private:
  void end_round(std::int64_t utime_us);

  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* state) const { mj_deleteData(state); }
  };
  BodyHeadsParams params_;
  const Scene scene_;
  std::vector<int> rung_of_geom_;
  Eigen::Isometry3d T_odom_world_;
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> state_;
  Eigen::Isometry3d T_world_body_ = Eigen::Isometry3d::Identity();
  std::vector<HeadRenderer> heads_;
  HeadImage image_;
  RungVisibility visibility_;
  ladder_msgs::tof_frame_t frame_{};
  ladder_msgs::truth_t truth_{};
  std::int64_t round_ = 0;
  std::int64_t newest_utime_us_ = 0;
  int next_head_ = 0;
};

}  // namespace simulator
