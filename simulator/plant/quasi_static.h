// SPDX-License-Identifier: BSD-3-Clause
// Mechanics without masses, and honest about it. Modelled: claws that catch and lose rungs; forces
// as stiffness times what the commanded foot lies off its contact, plus its share of the weight;
// joints that bend under them; a body that goes where its feet hold it; rungs that break; a fall
// when fewer than two feet hold. NOT modelled: inertia and swing of the body, sag under weight,
// slip, friction, fingers or knees bumping into rungs, self-collision, bending rungs, servo heat,
// ground contact.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "simulator/plant/mechanics.h"
#include "simulator/plant/plant_params.h"

namespace simulator {

class QuasiStatic : public Mechanics {
 public:
  /// The starting angles of params.drives are where the legs are (see place_legs()).
  explicit QuasiStatic(const PlantParams& params);

  void take_over(std::span<Drive>) override {}  // the motors move by themselves
  void step(std::int64_t now_us, std::span<Drive> drives, RungWorld& world) override;
  const BodyMotion& body() const override { return body_; }
  const LegTruth& leg(int leg) const override { return legs_[static_cast<std::size_t>(leg)]; }
  bool fallen() const override { return fallen_; }
  void set_docked(bool docked) override;
  bool docked() const override { return docked_; }

 private:
  void step_claws(std::span<Drive> drives, const RungWorld& world);
  void step_body(std::span<const Drive> drives);
  void weigh(unsigned bearing);
  void step_loads(std::span<Drive> drives);
  void load_leg(int leg, std::span<Drive> drives);
  void step_rungs(RungWorld& world) const;
  void fall();
  void tell(std::span<const Drive> drives);
  bool bears(int leg, std::span<const Drive> drives) const;

  PlantParams params_;
  std::vector<Claw> claws_;
  BodyMotion body_;
  std::array<LegTruth, kNumLegs> legs_;
  std::array<Eigen::Vector3d, kNumLegs> force_on_rung_N_;
  std::array<Eigen::Vector3d, kNumLegs> weight_share_N_;
  std::array<bool, kNumLegs> bearing_{};
  unsigned weighed_legs_ = ~0U;  ///< bearing legs for which weight_share_N_ was computed, by bits
  std::int64_t weighed_us_ = 0;
  std::int64_t now_us_ = 0;
  Eigen::Isometry3d T_world_dock_ = Eigen::Isometry3d::Identity();
  bool docked_ = false;
  bool fallen_ = false;
  double fall_m_s_ = 0.0;
};

/// For RobotPlant.
std::unique_ptr<Mechanics> make_quasi_static(const PlantParams& params);

}  // namespace simulator
