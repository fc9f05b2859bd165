// SPDX-License-Identifier: BSD-3-Clause
#include "ddgng/structure_params.h"

#include <array>

namespace ddgng {
namespace {

struct Relation {
  bool holds;  // written so that NaN fails
  const char* text;
};

}  // namespace

StructureParams paper_structure_params() {
  StructureParams params;
  params.attention = AttentionMode::kBoxes;
  params.refit_planes = false;
  params.space_ahead_m = 2.5F;
  params.space_lateral_m = 0.3F;
  params.max_object_width_m = 0.8F;
  return params;
}

std::string check(const StructureParams& p) {
  const std::array relations = {
      Relation{p.min_nodes > 0, "min_nodes > 0"},
      Relation{p.max_faces_per_node > 0, "max_faces_per_node > 0"},
      Relation{p.segment_angle_deg > 0 && p.segment_angle_deg < 90, "0 < segment_angle_deg < 90"},
      Relation{p.small_area_m2 >= 0, "small_area_m2 >= 0"},
      Relation{p.small_faces >= 0, "small_faces >= 0"},
      Relation{p.large_area_m2 >= p.small_area_m2, "large_area_m2 >= small_area_m2"},
      Relation{p.large_faces > p.small_faces, "large_faces > small_faces"},
      Relation{p.safe_ground_slope_deg > 0 && p.safe_ground_slope_deg < 45,
               "0 < safe_ground_slope_deg < 45"},
      Relation{p.wall_half_width_deg > 0 && p.wall_half_width_deg < 45,
               "0 < wall_half_width_deg < 45"},
      Relation{p.plane_sample_points >= p.plane_min_points,
               "plane_sample_points >= plane_min_points"},
      Relation{p.plane_sample_points <= 100000, "plane_sample_points <= 100000"},
      Relation{p.max_planes >= 0, "max_planes >= 0"},
      Relation{p.plane_min_points >= 3, "plane_min_points >= 3"},
      Relation{p.plane_refit_distance_m > 0, "plane_refit_distance_m > 0"},
      Relation{p.plane_on_distance_m > 0, "plane_on_distance_m > 0"},
      Relation{p.plane_min_support > 0 && p.plane_min_support <= 1, "0 < plane_min_support <= 1"},
      Relation{p.plane_behind_distance_m >= p.plane_on_distance_m,
               "plane_behind_distance_m >= plane_on_distance_m"},
      Relation{p.plane_max_behind >= 0, "plane_max_behind >= 0"},
      Relation{p.ground_max_below >= 0, "ground_max_below >= 0"},
      Relation{p.duplicate_angle_deg > 0 && p.duplicate_angle_deg < 90,
               "0 < duplicate_angle_deg < 90"},
      Relation{p.duplicate_distance_m >= 0, "duplicate_distance_m >= 0"},
      Relation{p.node_plane_distance_m >= 0, "node_plane_distance_m >= 0"},
      Relation{p.node_plane_per_range >= 0, "node_plane_per_range >= 0"},
      Relation{p.level_within_deg >= 0 && p.level_within_deg < 45, "0 <= level_within_deg < 45"},
      Relation{p.upright_within_deg >= 0 && p.upright_within_deg < 45,
               "0 <= upright_within_deg < 45"},
      Relation{p.aligned_min_support >= 0, "aligned_min_support >= 0"},
      Relation{p.level_min_spread_m >= 0, "level_min_spread_m >= 0"},
      Relation{p.floor_height_m >= -1e3F && p.floor_height_m <= 1e3F,
               "-1000 <= floor_height_m <= 1000"},
      Relation{p.attention == AttentionMode::kBoxes || p.refit_planes,
               "attention off planes needs refit_planes"},
      Relation{p.space_ahead_m >= 0, "space_ahead_m >= 0"},
      Relation{p.space_lateral_m > 0, "space_lateral_m > 0"},
      Relation{p.max_object_width_m > 0, "max_object_width_m > 0"},
      Relation{p.static_speed_m_s >= 0, "static_speed_m_s >= 0"},
      Relation{p.sweep_time_s >= 0, "sweep_time_s >= 0"},
      Relation{p.sample_margin_m >= 0, "sample_margin_m >= 0"},
      Relation{p.strength_margin_m >= 0, "strength_margin_m >= 0"},
      Relation{p.workspace_near_m >= 0, "workspace_near_m >= 0"},
      Relation{p.workspace_ahead_m == 0 || p.workspace_ahead_m > p.workspace_near_m,
               "workspace_ahead_m = 0 or > workspace_near_m"},
      Relation{p.workspace_lateral_m > 0, "workspace_lateral_m > 0"},
      Relation{p.workspace_above_floor_m >= 0, "workspace_above_floor_m >= 0"},
      Relation{p.attention_plane_distance_m >= 0, "attention_plane_distance_m >= 0"},
      Relation{p.attention_plane_per_range >= 0, "attention_plane_per_range >= 0"},
  };
  for (const Relation& relation : relations) {
    if (!relation.holds) return relation.text;
  }
  return "";
}

}  // namespace ddgng
