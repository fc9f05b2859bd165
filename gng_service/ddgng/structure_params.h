// SPDX-License-Identifier: BSD-3-Clause
// Every constant of triangulation, segmentation, classification, planes, objects and attention.
// Angles are written in degrees and compared as cosines (cosine_of_degrees), never through libm.
// Sources: "paper" = the IROS 2019 text or its author's program; "measured" = docs/EQUATIONS.md.
#pragma once

#include <cstdint>
#include <string>

namespace ddgng {

/// Where the attention signals of the next frame are drawn from.
enum class AttentionMode : std::uint8_t {
  kBoxes,     ///< paper, Alg. 1: the boxes of the suspected objects
  kOffPlanes  ///< measured: everything in the workspace that lies off the large planes
};

struct StructureParams {
  // --- modes ---
  AttentionMode attention = AttentionMode::kOffPlanes;
  bool complete_quadrilaterals_and_pentagons = true;  ///< supplementary edges c' (paper)
  bool refit_planes = true;  ///< nodes are classed by refitted planes (measured), else by labels
  int min_nodes = 10;        ///< theta_r [nodes], > 0: at or below it no structure is made
  std::uint64_t seed = 1;    ///< of the point sample that planes are refitted to

  // --- capacities: what exceeds them is left out and counted ---
  int max_faces_per_node = 32;  ///< [faces per node], > 0; a plane has 2

  // --- segmentation (Eq. 2) ---
  float segment_angle_deg = 10.0F;  ///< theta_seg [deg], (0, 90)

  // --- classification (Eq. 4, 5) ---
  float small_area_m2 = 0.01F;       ///< A_small [m2]: smaller labels are obstacle parts
  int small_faces = 5;               ///< n_small [faces]: so are labels of at most so many faces
  float large_area_m2 = 0.07F;       ///< A_gnd [m2]: ground, walls and planes are larger
  int large_faces = 15;              ///< n_gnd [faces]: and have at least so many faces
  float safe_ground_slope_deg = 15;  ///< theta_safe [deg] from level, (0, 45)
  float wall_half_width_deg = 10;    ///< theta_wall [deg] about vertical, (0, 45)

  // --- planes (measured) ---
  int plane_sample_points = 600;          ///< [points] of the cloud that planes are refitted to
  int max_planes = 5;                     ///< [planes], largest label first
  int plane_min_points = 20;              ///< [points of the sample] a refit needs
  float plane_refit_distance_m = 0.05F;   ///< [m] points nearer than this take part in a refit
  float plane_on_distance_m = 0.03F;      ///< [m] points nearer than this support a plane
  float plane_min_support = 0.05F;        ///< [share of the sample] that a plane needs
  float plane_behind_distance_m = 0.08F;  ///< [m] points farther behind count against opaqueness
  float plane_max_behind = 0.5F;          ///< [share of the supporting points] behind at most
  float ground_max_below = 0.1F;          ///< [share of the supporting points] below ground at most
  float duplicate_angle_deg = 10.0F;      ///< [deg] planes closer in angle
  float duplicate_distance_m = 0.06F;     ///< [m] and in distance are the same plane
  float node_plane_distance_m = 0.025F;   ///< [m] a node belongs to a plane nearer than this
  float node_plane_per_range = 0.01F;     ///< [m per m range] added to it
  float level_within_deg = 8.0F;          ///< [deg] a plane so near to level is tried level
  float upright_within_deg = 20.0F;       ///< [deg] a plane so near to upright is tried upright
  float aligned_min_support = 0.8F;  ///< [share of the tilted one's support] both win from here
  float level_min_spread_m = 0.1F;   ///< [m] deviation across a level plane found by height
  bool floor_height_known = false;   ///< a level plane at floor_height_m comes first
  float floor_height_m = 0.0F;       ///< [m] in the odom frame

  // --- objects and suspicion (paper, section II-B) ---
  float space_ahead_m = 0.0F;       ///< [m] moving space ahead of the heads; 0 = range of the heads
  float space_lateral_m = 0.8F;     ///< [m] to either side
  float max_object_width_m = 3.0F;  ///< [m] wider objects are not suspected (paper 0.8)
  float static_speed_m_s = 0.05F;   ///< [m/s] slower objects count as static
  float sweep_time_s = 2.0F;        ///< tau [s]: moving objects are looked ahead so far

  // --- attention ---
  float sample_margin_m = 0.02F;             ///< m_s [m] added to suspected boxes for sampling
  float strength_margin_m = 0.05F;           ///< m_d [m] added to them for the strength (Alg. 2)
  float workspace_near_m = 0.15F;            ///< [m] workspace begins so far ahead of the heads
  float workspace_ahead_m = 0.0F;            ///< [m] and ends here; 0 = range of the heads
  float workspace_lateral_m = 0.8F;          ///< [m] to either side
  float workspace_above_floor_m = 0.06F;     ///< [m] above the floor, where a floor is known
  float attention_plane_distance_m = 0.03F;  ///< [m] points nearer to a plane are left out
  float attention_plane_per_range = 0.025F;  ///< [m per m range] added to it
};

/// The paper's literal form: boxes, classes by labels, moving space and width limit of its program.
StructureParams paper_structure_params();

/// "" or the violated relation in words.
std::string check(const StructureParams& params);

/// Cosine by its Taylor series to the 20th power, |error| < 1e-15 for 0..180 deg: the same bits
/// everywhere.
constexpr double cosine_of_degrees(double angle_deg) {
  constexpr double kPi = 3.141592653589793;
  const bool obtuse = angle_deg > 90.0;
  const double angle_rad = (obtuse ? 180.0 - angle_deg : angle_deg) * (kPi / 180.0);
  double term = 1.0;
  double sum = 1.0;
  for (int k = 2; k <= 20; k += 2) {
    term *= -angle_rad * angle_rad / ((k - 1) * k);
    sum += term;
  }
  return obtuse ? -sum : sum;
}

}  // namespace ddgng
