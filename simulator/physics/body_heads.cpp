// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/physics/body_heads.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "simulator/sensor_messages.h"

namespace simulator {
namespace {

constexpr double kStagger_hz = 60.0;  // the heads do not blind each other

std::int64_t period_us(std::int64_t index, double rate_hz) {
  return static_cast<std::int64_t>(std::floor(static_cast<double>(index) * 1e6 / rate_hz + 0.5));
}

}  // namespace

BodyHeads::BodyHeads(const BodyHeadsParams& params, const Scene& scene, const PhysicsModel& model,
                     const Eigen::Isometry3d& T_odom_world)
    : params_(params),
      scene_(scene),
      rung_of_geom_(model.rung_of_geom()),
      T_odom_world_(T_odom_world),
      model_(mj_copyModel(nullptr, &model.model())),
      state_(mj_makeData(model_.get())),
      visibility_(scene.rungs.size()) {
  CHECK(model_ != nullptr && state_ != nullptr, "MuJoCo has no memory for the heads' copy");
  for (int head = 0; head < kNumHeads; ++head) {
    heads_.emplace_back(params.sensor, params.layout[static_cast<std::size_t>(head)], head,
                        params.seed);
  }
}

std::int64_t BodyHeads::due_us() const {
  const double stagger_hz = std::max(kStagger_hz, kNumHeads * params_.rate_hz);
  return period_us(round_, params_.rate_hz) + period_us(next_head_, stagger_hz);
}

void BodyHeads::skip_to(std::int64_t now_us) {
  while (due_us() + period_us(1, params_.rate_hz) <= now_us) ++round_;
}

void BodyHeads::look(const PhysicsModel& model, const Eigen::Isometry3d& T_world_body) {
  const auto num_geoms = model.model().ngeom;
  std::copy_n(model.model().geom_rgba, 4 * num_geoms, model_->geom_rgba);
  std::copy_n(model.state().geom_xpos, 3 * num_geoms, state_->geom_xpos);
  std::copy_n(model.state().geom_xmat, 9 * num_geoms, state_->geom_xmat);
  T_world_body_ = T_world_body;
}

const ladder_msgs::tof_frame_t* BodyHeads::flash(std::int64_t utime_us) {
  const auto head = static_cast<std::size_t>(next_head_);
  if (head == 0) {
    visibility_.clear();
    newest_utime_us_ = 0;
  }
  const bool is_alive = !params_.dead[head];
  if (is_alive) {
    heads_[head].render(*model_, *state_, T_world_body_, static_cast<std::uint64_t>(round_),
                        image_);
    visibility_.add({scene_, rung_of_geom_}, heads_[head], T_world_body_, image_);
    frame_ = frame_message(heads_[head], params_.sensor, image_);
    frame_.utime = utime_us;
    frame_.seq = round_;
    frame_.head = static_cast<std::int8_t>(next_head_);
    newest_utime_us_ = utime_us;
  }
  next_head_ = (next_head_ + 1) % kNumHeads;
  if (next_head_ == 0) end_round(newest_utime_us_ != 0 ? newest_utime_us_ : utime_us);
  return is_alive ? &frame_ : nullptr;
}

void BodyHeads::end_round(std::int64_t utime_us) {
  truth_ = scene_truth(scene_, visibility_, T_odom_world_, T_world_body_);
  truth_.utime = utime_us;
  truth_.seq = round_;
  ++round_;
}

}  // namespace simulator
