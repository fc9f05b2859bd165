// SPDX-License-Identifier: BSD-3-Clause
// One depth head: the caster's exact image through the sensor model. Pixels on a depth edge are
// mixed from extra rays (flying pixels). Renders the geoms of any MuJoCo model.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

#include "simulator/caster.h"
#include "simulator/head_layout.h"
#include "simulator/sensor_model.h"

namespace simulator {

/// Parallel, row by row; width_px x height_px.
struct HeadImage {
  std::vector<std::int16_t> depth_mm;  ///< 0 = no return
  std::vector<std::uint8_t> confidence;
  /// Geom id of a clean pixel: returned, and all its light came from one surface. Else -1.
  std::vector<int> clean_geom;
  std::vector<float> true_range_m;  ///< along the pixel's central ray; kMiss = nothing there
};

class HeadRenderer {
 public:
  /// The mounting error is drawn from (seed, head index).
  HeadRenderer(const SensorParams& params, const HeadMount& mount, int head_index,
               std::uint64_t seed);

  const Pinhole& pinhole() const { return caster_.pinhole(); }
  /// As the robot believes it to be.
  const Eigen::Isometry3d& T_body_head_nominal() const { return T_body_head_nominal_; }
  /// As it is.
  const Eigen::Isometry3d& T_body_head_true() const { return T_body_head_true_; }
  /// Unit ray of a pixel in the head's frame.
  const Eigen::Vector3f& ray(std::size_t pixel) const { return caster_.rays()[pixel]; }

  /// The noise depends on (seed, head index, frame) alone.
  void render(const mjModel& model, const mjData& state, const Eigen::Isometry3d& T_world_body,
              std::uint64_t frame, HeadImage& image);

 private:
  struct PixelLight {
    Return light;
    int geom = -1;  ///< -1: nothing, or light of two surfaces
    bool mixed = false;
  };

  void find_edges();
  PixelLight light_of_ray(std::size_t pixel) const;
  PixelLight light_of_edge(int x_px, int y_px) const;
  Return returned(const Hit& hit, const Eigen::Vector3f& ray) const;

  SensorModel sensor_;
  bool radial_;
  std::uint64_t noise_seed_;
  Eigen::Isometry3d T_body_head_nominal_;
  Eigen::Isometry3d T_body_head_true_;
  Caster caster_;
  std::vector<Hit> hits_;
  std::vector<std::uint8_t> on_edge_;
  std::vector<float> pixel_bias_m_;  ///< empty: none
};

}  // namespace simulator
