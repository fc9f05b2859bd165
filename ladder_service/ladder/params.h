// SPDX-License-Identifier: BSD-3-Clause
// Every constant of the ladder search, with its source: "recipe" = measured on simulated scenes
// (docs/EQUATIONS.md), "S19" = the first author's program, "own" = chosen here. Two modes share
// input, output and affordances: the default one and the paper's literal Algorithms 3 and 4.
#pragma once

#include <cstdint>
#include <string>

namespace ladder {

enum class Mode : std::uint8_t { kDefault, kPaper };

/// Bars and rails among the nodes off every plane (default mode).
struct BarParams {
  // Two bar heights; the better supported one wins per candidate.
  double narrow_half_height_m = 0.025;  ///< distance of an inlier to the axis, 28 mm rungs (recipe)
  double narrow_neighborhood_m = 0.06;  ///< radius of the local PCA (recipe)
  double wide_half_height_m = 0.05;     ///< 70-100 mm boards (recipe)
  double wide_neighborhood_m = 0.12;    ///< (recipe)
  double wide_gain = 1.2;               ///< weight within twice / once the narrow half height that
                                        ///< makes the height doubtful (own)
  double seed_linearity = 3.0;      ///< least ratio of the first two variances of a seed (recipe)
  double level_max_dz = 0.42;       ///< |d_z| below: rung (recipe)
  double upright_min_dz = 0.80;     ///< |d_z| above: rail; 0.87 at 60 deg (own)
  double noise_sigmas = 2.0;        ///< members lie so far from the axis along the view (own) ...
  double max_noise_share = 0.02;    ///< ... with at most this noise, of the range (quality)
  double gap_m = 0.08;              ///< a chain ends at a longer gap (recipe)
  int num_refits = 4;               ///< growth and fit alternate so often (recipe)
  double reach_m = 1.5;             ///< a rung candidate ends this far from its seed (own)
  double min_rung_length_m = 0.10;  ///< (recipe)
  double min_rail_length_m = 0.35;  ///< (recipe)
  int min_rung_nodes = 4;           ///< (recipe)
  int min_rail_nodes = 8;           ///< (recipe)
  double min_weight = 12.0;         ///< points on a bar (recipe)
  double min_node_weight = 0.5;     ///< a node with less is passed over (recipe)
  double weight_without_moments = 4.0;  ///< of a node when the cloud carries no moments (own)
  double rung_linearity = 6.0;          ///< least ratio of variances of a grown rung (recipe)
  double rail_linearity = 20.0;         ///< ... and of a rail (recipe)
  double flank_width_m = 0.04;          ///< band on either side of a candidate (recipe)
  double flank_depth_m = 0.045;         ///< ... this far in front of and behind it (recipe)
  double flank_max = 0.35;              ///< most weight of one flank / own weight (recipe)
  double max_shared = 0.5;        ///< a candidate sharing more of its nodes is a duplicate (recipe)
  double merge_min_cos = 0.97;    ///< collinear pieces are one bar: direction (recipe)
  double merge_offset_m = 0.03;   ///< ... distance across (recipe)
  double merge_gap_m = 0.20;      ///< ... gap along (recipe)
  double merge_overlap_m = 0.05;  ///< ... overlap along (recipe)
  double rail_merge_min_cos = 0.98;   ///< rails found twice (recipe)
  double rail_merge_offset_m = 0.05;  ///< (recipe)
};

/// Two rails and their rungs (default mode).
struct LadderTestParams {
  double rail_min_cos = 0.985;     ///< rails are parallel (recipe)
  double min_width_m = 0.25;       ///< clear width (quality.md: 0.25-0.65)
  double max_width_m = 0.65;       ///<
  double rung_min_cos = 0.93;      ///< rung against the direction from rail to rail (recipe)
  double attach_m = 0.05;          ///< distance of the axes at a joint (recipe)
  double attach_far_factor = 1.6;  ///< ... the worse of the two joints (recipe)
  double rail_overrun_m = 0.15;    ///< joint beyond the seen part of a rail (recipe)
  double rail_unseen_m = 1.0;      ///< ... of a rail that the bar does not reach (own)
  double rung_overrun_m = 0.08;    ///< a bar running further past a rail is no rung (recipe)
  double reach_rail_m = 0.07;      ///< seen end this near to a rail: reaches it (recipe)
  double half_score = 0.3;         ///< of a bar reaching one rail; a whole one scores 1 (recipe)
  int min_whole_rungs = 2;         ///< per frame (recipe)
  int min_partial_rungs = 3;       ///< or one whole one among so many that reach a rail (own)
  double min_joint_distance_m = 0.15;  ///< joints nearer to each other are one level (recipe)
  double frame_min_spacing_m = 0.19;   ///< per frame, coarse (recipe)
  double frame_max_spacing_m = 0.45;   ///<
  double spacing_tolerance = 0.2;      ///< distance from a whole multiple of the spacing (recipe)
  bool thick_rungs = true;             ///< also bars found at the wide height (100 mm)
  // Hole test: between rails and rungs there is nothing.
  double hole_max = 0.15;       ///< weight in the panel / weight on the rungs (recipe)
  double hole_rail_m = 0.06;    ///< panel begins this far from a rail's axis (recipe)
  double hole_rung_m = 0.05;    ///< ... and from a rung's axis (recipe)
  double on_rung_m = 0.045;     ///< (recipe)
  double hole_depth_m = 0.045;  ///< half thickness of the panel: what stands 60 mm behind is a
                                ///< pipe, no front (own; recipe 60 mm)
  double hole_margin_m = 0.05;  ///< panel above the top and below the lowest rung (recipe)
  // Depth test: a shelf board goes on behind its edge.
  double deep_max = 0.3;             ///< median weight behind / own weight (recipe)
  double deep_from_m = 0.06;         ///< (recipe)
  double deep_to_m = 0.30;           ///< (recipe)
  double deep_half_height_m = 0.03;  ///< (recipe)
  // Treads: level boards go on closely behind their front edges, no claw closes round them.
  double tread_from_m = 0.045;       ///< a claw's bars end before this (own)
  double tread_to_m = 0.105;         ///< (own)
  double tread_min_depth_m = 0.008;  ///< of a level surface between them: bars up to 7.2 mm, boards
                                     ///< 100 mm deep from 12.3 mm on (own)
  // Halves of a broken or V-bent rung.
  double v_height_m = 0.12;         ///< their outer ends differ less along the rails (recipe)
  double v_gap_m = 0.22;            ///< their inner ends are this near (recipe)
  double min_stub_length_m = 0.14;  ///< (recipe)
  double same_level_m = 0.09;  ///< two rungs nearer along the rails: the weaker one goes (recipe)
  // Confirmation, on the tracks.
  int min_rungs = 3;                   ///< (decisions)
  double min_spacing_m = 0.21;         ///< stairs have 0.19-0.20 (decisions)
  double max_spacing_m = 0.42;         ///< (decisions)
  double max_spacing_sigma_m = 0.005;  ///< standard error of the mean spacing (decisions)
  double height_sigma_m = 0.002;       ///< least error of one rung's height in it (own)
};

/// Axis, ends, radius and damage of one bar (default mode).
struct MeasureParams {
  double joint_trim_m = 0.03;          ///< members this near to a rail are left out (recipe)
  double rail_half_width_m = 0.005;    ///< of the front of a flat rail (own: 10 mm thick)
  double rail_width_switch_m = 0.010;  ///< an estimated half width is used above this (own)
  double prior_radius_m = 0.014;       ///< told in paper mode, which measures none (recipe)
  double edge_lost_px = 0.25;          ///< of a pixel at an edge before something: what mixes in
                                       ///< less of it than flying_step_m stays (own)
  double edge_gained_px = 0.25;        ///< ... gained before nothing: half of it suffices (own)
  double radius_alike = 0.4;           ///< rungs whose radii differ by a smaller share are pooled
  bool square_rungs = true;            ///< rungs may be square: rung_profile.h decides
  double head_min_weight = 10.0;       ///< a head's covariance counts from here (recipe)
  double head_min_share = 0.8;         ///< ... and such heads must carry this share (recipe)
  double head_linearity = 6.0;         ///< (recipe)
  double min_weight = 8.0;             ///< after the trim (recipe)
  double whole_height = 0.85;          ///< a head that sees less of a rung's height sees it cut off
                                       ///< by the edge of its image (own)
  double stub_gap_m = 0.06;            ///< seen end farther from the rail: stub (recipe)
  double stub_margin_m = 0.012;        ///< the stub's end beyond its last node (recipe)
  double sag_flag_m = 0.007;           ///< (recipe)
  double bent_flag_tan = 0.1405;       ///< tan 8 deg between the halves (own)
  double tilt_flag_sin = 0.0698;       ///< sin 4 deg off the right angle (recipe)
};

/// Where the heads sit and how they err in range, learnt while looking (default mode).
/// head_alignment.h.
struct AlignParams {
  bool enabled = true;
  double sigma_shift_m = 0.010;    ///< largest tolerance of a head's mounting per axis (quality)
  double sigma_turn_rad = 0.0175;  ///< 1 deg (quality)
  double least_share = 0.1;       ///< of both, where heads agree; else misfit / sigma_shift_m (own)
  double sigma_range_m = 0.003;   ///< error of the range that the heads share (quality)
  double sigma_gravity = 0.002;   ///< sine of the lean of walls and floors (own: builders' 8 mm on
                                  ///< 2.5 m, as 1.6 sigma)
  double sigma_plane_m = 0.003;   ///< a node's mean off a true plane (own)
  double sigma_bar_m = 0.0015;    ///< what a head sees of a rung off where it should be (own)
  double min_bar_weight = 30.0;   ///< points of a head on a rung, to be counted (own)
  double told_share = 0.1;        ///< of what is the same in every frame, told by one frame (own)
  double keep = 0.99;             ///< older frames count so much less, each (own)
  double frame_share = 0.2;       ///< of a frame's points are new: 1 - moment_forget
  double far_m = 0.08;            ///< planes most of whose nodes are farther off are none (own)
  double corner_m = 0.12;         ///< nodes this near to another plane are left out (own)
  double contested_m = 0.12;      ///< ... or this near to one off every plane: two gates of moments
  double thick_max = 1.5;         ///< nodes whose variance across a plane is larger than the
                                  ///< median by this factor are left out (own)
  double upright_max_sin = 0.14;  ///< planes leaning less are walls and floors: 8 deg (own)
  double min_weight = 3.0;        ///< points of a head in a node, to be counted, > 1 (own)
  double min_nodes = 3.0;         ///< such nodes of a head on a plane or bar (own)
  int max_planes = 16;            ///< more planes: no correction (own)
  double gain = 0.15;             ///< with which the misfit is averaged (own)
  double begin_misfit_m = 0.006;  ///< heads further apart than this are reported ... (own)
  double end_misfit_m = 0.0045;   ///< ... until they are nearer than this (own)
  int settle_frames = 15;         ///< nothing is offered sooner: corrections come (quality)
  double max_shift_m = 0.03;      ///< corrections end here (own: 3 sigma)
  double max_turn_rad = 0.0524;   ///< 3 deg (own)
  double max_range_m = 0.009;     ///< 3 sigma (own)
};

/// Evidence (default mode).
struct TrackParams {
  int trust_evidence = 3;  ///< matched frames until trusted (decisions)
  int drop_evidence = 1;   ///< below: no longer trusted (recipe: trust - 2)
  int max_evidence = 12;   ///< (decisions)
  int max_missed = 4;      ///< frames without a match until trust rests: 0.3 s at 15 Hz (quality)
  double gate_across_m = 0.06;   ///< (recipe)
  double gate_along_m = 0.20;    ///< (recipe)
  double min_gain = 0.1;         ///< positions are averaged with gain max(1/n, this) (recipe)
  double shape_gain = 0.2;       ///< ... sag and angles with this (recipe)
  double prior_sigma_m = 0.010;  ///< scatter of one frame's middle point before any is known (own)
  double systematic_sigma_m =
      0.003;  ///< extrinsics and wiggle: what averaging does not remove (recipe)
};

/// Where a gripper may close (both modes).
struct AffordanceParams {
  double step_m = 0.005;         ///< sampling along the axis (S19)
  double clearance_m = 0.020;    ///< along the rung, from an outlier or another rung (S19)
  double claw_width_m = 0.034;   ///< (physics.md)
  double claw_margin_m = 0.012;  ///< a stretch stays width + margin away from rails, whose place
                                 ///< is known so well (own) ...
  double margin_sigmas = 4.0;  ///< ... or so many times what it wanders or mountings move it (own)
  double max_wander_m = 0.02;  ///< a rung that wanders further is not offered (own)
  double max_side_sigma_m = 0.006;  ///< nor one that heads this badly mounted may misplace (own)
  double gripper_width_m = 0.040;   ///< least length of an offered stretch (S19: 2 d_clear)
  double outlier_reach_m = 0.05;  ///< a foreign node this near to the axis is attached to it (own)
  double outlier_min_weight = 3.0;  ///< ... when it holds so many points (own)
  double seen_reach_m = 0.015;      ///< a node supports its own extent and this much beyond (own)
  double max_tilt_sin = 0.2250;     ///< sin 13 deg: no offer on a rung tilted by 15 deg (quality),
                                    ///< two of which the direction may err by
  double max_length_m = 1.5;        ///< samples per rung are bounded by max_length / step (own)
};

/// Algorithms 3 and 4 (paper mode). Table "use" column of the reconstruction, mostly S19.
struct PaperParams {
  double inlier_m = 0.007;          ///< r_in (S19)
  double outlier_m = 0.015;         ///< r_out (S19)
  double box_margin_m = 0.02;       ///< m_s, around suspected boxes (S19)
  double workspace_m = 2.0;         ///< nodes eligible within this level distance of the body (own)
  int tries = 50;                   ///< random pairs per frame = tries / (rungs + 1) (S19)
  bool pair_gate = true;            ///< only near-level or near-upright pairs (S19)
  double pair_gate_m = 0.02;        ///< (S19)
  int min_inliers = 10;             ///< c_i (S19)
  double inlier_ratio = 3.0;        ///< c_i > ratio c_o (S19)
  double min_length_m = 0.10;       ///< L_min
  double xi = 1.0;                  ///< Eq. (7), nodes per decimetre (S19)
  double xi_age = 0.3;              ///< (S19)
  int min_surplus = 7;              ///< c_i - c_o below: the rung ages badly (S19)
  int age_initial = 20;             ///< g1 (S19)
  int age_trusted = 50;             ///< g2 (S19)
  int age_max = 150;                ///< g_cap (S19)
  int age_affordance = 130;         ///< (S19)
  double gamma = 0.49;              ///< Eq. (10)-(11) (S19)
  double merge_min_cos = 0.9;       ///< (S19)
  double merge_distance_m = 0.016;  ///< (S19)
  double rail_min_dz = 0.8;         ///< |n . up| above: a rail
};

struct LadderParams {
  Mode mode = Mode::kDefault;
  std::uint64_t seed = 1;  ///< of the paper's random pairs

  // Capacities: memory and time are bounded by them; what exceeds them is left out.
  int max_nodes = 4096;          ///< nodes off the planes (default mode) or eligible (paper mode)
  int max_cloud_nodes = 32768;   ///< nodes of a whole cloud: the message's limit
  int max_cloud_edges = 262144;  ///<
  int max_bars = 64;             ///< candidates of one kind in a frame
  int max_tracks = 64;           ///< 1..256, the message's limit

  BarParams bar;
  LadderTestParams test;
  MeasureParams measure;
  AlignParams align;
  TrackParams track;
  AffordanceParams affordance;
  PaperParams paper;
};

/// The paper's literal form.
LadderParams paper_params();

/// "" or the violated relation, naming the field.
std::string check(const LadderParams& params);

}  // namespace ladder
