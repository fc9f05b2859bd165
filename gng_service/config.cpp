// SPDX-License-Identifier: BSD-3-Clause
#include "gng_service/config.h"

#include <string>

namespace gng_service {
namespace {

enum class Mode { kDefault, kPaper };

void read(runtime::ConfigTable table, ddgng::GrowingParams& params) {
  table.read("seed", params.seed);
  table.read("uniform_signals", params.uniform_signals);
  table.read("attention_signals", params.attention_signals);
  table.read("insertion_interval", params.insertion_interval);
  table.read("plain_insertion_every", params.plain_insertion_every);
  table.read("max_nodes", params.max_nodes);
  table.read("max_plane_nodes", params.max_plane_nodes);
  table.read("max_degree", params.max_degree);
  table.read("boot_signals", params.boot_signals);
  table.read("max_boot_nodes", params.max_boot_nodes);
  table.read("winner_rate", params.winner_rate);
  table.read("neighbour_rate", params.neighbour_rate);
  table.read("max_edge_age", params.max_edge_age);
  table.read("error_cut", params.error_cut);
  table.read("error_decay", params.error_decay);
  table.read("utility_decay_outside", params.utility_decay_outside);
  table.read("utility_decay_inside", params.utility_decay_inside);
  table.read("utility_threshold", params.utility_threshold);
  table.read("utility_interval", params.utility_interval);
  table.read("min_utility_nodes", params.min_utility_nodes);
  table.read("strength_outside", params.strength_outside);
  table.read("strength_inside", params.strength_inside);
  table.read("strength_exponent", params.strength_exponent);
  table.read("moment_gate_m", params.moment_gate_m);
  table.read("moment_forget", params.moment_forget);
  table.read("min_moment_weight", params.min_moment_weight);
  table.require(check(params));
}

void read(runtime::ConfigTable table, ddgng::StructureParams& params) {
  table.read(
      "attention", params.attention,
      {{"off_planes", ddgng::AttentionMode::kOffPlanes}, {"boxes", ddgng::AttentionMode::kBoxes}});
  table.read("complete_quadrilaterals_and_pentagons", params.complete_quadrilaterals_and_pentagons);
  table.read("refit_planes", params.refit_planes);
  table.read("min_nodes", params.min_nodes);
  table.read("seed", params.seed);
  table.read("max_faces_per_node", params.max_faces_per_node);
  table.read("segment_angle_deg", params.segment_angle_deg);
  table.read("small_area_m2", params.small_area_m2);
  table.read("small_faces", params.small_faces);
  table.read("large_area_m2", params.large_area_m2);
  table.read("large_faces", params.large_faces);
  table.read("safe_ground_slope_deg", params.safe_ground_slope_deg);
  table.read("wall_half_width_deg", params.wall_half_width_deg);
  table.read("plane_sample_points", params.plane_sample_points);
  table.read("max_planes", params.max_planes);
  table.read("plane_min_points", params.plane_min_points);
  table.read("plane_refit_distance_m", params.plane_refit_distance_m);
  table.read("plane_on_distance_m", params.plane_on_distance_m);
  table.read("plane_min_support", params.plane_min_support);
  table.read("plane_behind_distance_m", params.plane_behind_distance_m);
  table.read("plane_max_behind", params.plane_max_behind);
  table.read("ground_max_below", params.ground_max_below);
  table.read("duplicate_angle_deg", params.duplicate_angle_deg);
  table.read("duplicate_distance_m", params.duplicate_distance_m);
  table.read("node_plane_distance_m", params.node_plane_distance_m);
  table.read("node_plane_per_range", params.node_plane_per_range);
  table.read("level_within_deg", params.level_within_deg);
  table.read("upright_within_deg", params.upright_within_deg);
  table.read("aligned_min_support", params.aligned_min_support);
  table.read("level_min_spread_m", params.level_min_spread_m);
  table.read("floor_height_known", params.floor_height_known);
  table.read("floor_height_m", params.floor_height_m);
  table.read("space_ahead_m", params.space_ahead_m);
  table.read("space_lateral_m", params.space_lateral_m);
  table.read("max_object_width_m", params.max_object_width_m);
  table.read("static_speed_m_s", params.static_speed_m_s);
  table.read("sweep_time_s", params.sweep_time_s);
  table.read("sample_margin_m", params.sample_margin_m);
  table.read("strength_margin_m", params.strength_margin_m);
  table.read("workspace_near_m", params.workspace_near_m);
  table.read("workspace_ahead_m", params.workspace_ahead_m);
  table.read("workspace_lateral_m", params.workspace_lateral_m);
  table.read("workspace_above_floor_m", params.workspace_above_floor_m);
  table.read("attention_plane_distance_m", params.attention_plane_distance_m);
  table.read("attention_plane_per_range", params.attention_plane_per_range);
  table.require(check(params));
}

}  // namespace

ddgng::DdgngParams read_params(runtime::ConfigTable table) {
  Mode mode = Mode::kDefault;
  table.read("mode", mode, {{"default", Mode::kDefault}, {"paper", Mode::kPaper}});
  ddgng::DdgngParams params;
  if (mode == Mode::kPaper) {
    params.growing = ddgng::paper_params();
    params.structure = ddgng::paper_structure_params();
  }
  table.read("max_points", params.max_points);
  read(table.table("growing"), params.growing);
  read(table.table("structure"), params.structure);
  table.require(check(params));
  return params;
}

}  // namespace gng_service
