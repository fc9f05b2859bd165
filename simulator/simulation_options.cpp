// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/simulation_options.h"

#include <stdexcept>

#include <CLI/CLI.hpp>

namespace simulator {

SimulationOptions::SimulationOptions(CLI::App& app) {
  SimulationParams& s = simulation_;
  app.add_option("--scene", scene_, "what stands before the robot; a wrong name lists the kinds");
  app.add_option("--seed", s.scene.seed, "of scene, mounting errors and noise");
  app.add_option("--distance_m", s.scene.distance_m);
  app.add_option("--yaw_deg", s.scene.yaw_deg);
  app.add_option("--rung_diameter_m", diameter_m_);
  app.add_option("--spacing_m", s.scene.spacing_m);
  app.add_option("--clear_width_m", s.scene.clear_width_m);
  app.add_option("--num_rungs", s.scene.num_rungs);
  app.add_option("--rung_section", section_, "round, oval, flat_top or tread");
  app.add_option("--rail_diameter_m", rail_diameter_m_, "round rails instead of flat bars");
  app.add_option("--rail_width_m", s.scene.rail_width_m, "of flat bars, seen from before");
  app.add_option("--wall_reflectance", wall_reflectance_, "0 = black .. 1 = white");
  app.add_option("--layout", layout_, "heads_still or heads_climb");
  app.add_option("--body_height_m", s.body_height_m);
  app.add_option("--dead_heads", dead_heads_, "heads that send nothing")->delimiter(',');
  app.add_option("--rate_hz", s.rate_hz, "of each head");
  app.add_option("--stagger_hz", s.stagger_hz, "of the heads of one round");
  app.add_option("--width_px", s.sensor.width_px, "of a head's image");
  app.add_option("--height_px", s.sensor.height_px);
  app.add_option("--horizontal_deg", s.sensor.horizontal_deg, "field of view");
  app.add_option("--vertical_deg", s.sensor.vertical_deg);
  app.add_option("--range_max_m", s.sensor.range_max_m);
  app.add_option("--noise_share", s.sensor.noise_share, "sigma / range");
  app.add_option("--noise_floor_m", s.sensor.noise_floor_m, "least sigma");
  app.add_option("--pixel_bias_m", s.sensor.pixel_bias_m, "sigma of an error that stays");
  app.add_option("--edge_dropout", s.sensor.edge_dropout, "share of edge pixels that are lost");
  app.add_option("--random_dropout", s.sensor.random_dropout, "share of all pixels");
  app.add_option("--wiggle_m", s.sensor.wiggle_m, "periodic error of the distance");
  app.add_option("--wrap_range_m", s.sensor.wrap_range_m, "2.49: single frequency");
  app.add_option("--extrinsic_sigma_m", s.sensor.extrinsic_sigma_m);
  app.add_option("--extrinsic_sigma_deg", s.sensor.extrinsic_sigma_deg);
  app.add_option("--depth", depth_, "radial or z")->check(CLI::IsMember({"radial", "z"}));
  app.add_option("--sway_m", s.motion.sway_m, "the body sways so far");
  app.add_option("--sway_deg", s.motion.sway_deg);
  app.add_option("--sway_hz", s.motion.sway_hz);
  app.add_option("--climb_m_s", s.motion.climb_m_s, "the body rises");
  app.add_option("--remove_rung_s", removal_s_, "a rung is taken away then");
  app.add_option("--removed_rung", removed_rung_, "which one, counted from below from 0");
}

SimulationParams SimulationOptions::params() const {
  SimulationParams params = simulation_;
  params.scene.kind = scene_kind_from_string(scene_);
  params.scene.rung_diameter_m = diameter_m_;
  params.scene.rung_section = rung_section_from_string(section_);
  params.scene.rail_diameter_m = rail_diameter_m_;
  params.scene.wall_reflectance = wall_reflectance_;
  params.layout = head_layout_from_string(layout_);
  params.sensor.radial = depth_ == "radial";
  if (removal_s_) params.removal = Removal{removed_rung_, *removal_s_};
  for (const int head : dead_heads_) {
    if (head < 0 || head >= kNumHeads) {
      throw std::invalid_argument("--dead_heads: a head is 0, 1, 2 or 3");
    }
    params.head_dead[static_cast<std::size_t>(head)] = true;
  }
  return params;
}

}  // namespace simulator
