// SPDX-License-Identifier: BSD-3-Clause
#include "ladder_service/config.h"

namespace ladder_service {
namespace {

using runtime::ConfigTable;

void read(ConfigTable table, ladder::BarParams& params) {
  table.read("narrow_half_height_m", params.narrow_half_height_m);
  table.read("narrow_neighborhood_m", params.narrow_neighborhood_m);
  table.read("wide_half_height_m", params.wide_half_height_m);
  table.read("wide_neighborhood_m", params.wide_neighborhood_m);
  table.read("wide_gain", params.wide_gain);
  table.read("seed_linearity", params.seed_linearity);
  table.read("level_max_dz", params.level_max_dz);
  table.read("upright_min_dz", params.upright_min_dz);
  table.read("noise_sigmas", params.noise_sigmas);
  table.read("max_noise_share", params.max_noise_share);
  table.read("gap_m", params.gap_m);
  table.read("num_refits", params.num_refits);
  table.read("reach_m", params.reach_m);
  table.read("min_rung_length_m", params.min_rung_length_m);
  table.read("min_rail_length_m", params.min_rail_length_m);
  table.read("min_rung_nodes", params.min_rung_nodes);
  table.read("min_rail_nodes", params.min_rail_nodes);
  table.read("min_weight", params.min_weight);
  table.read("min_node_weight", params.min_node_weight);
  table.read("weight_without_moments", params.weight_without_moments);
  table.read("rung_linearity", params.rung_linearity);
  table.read("rail_linearity", params.rail_linearity);
  table.read("flank_width_m", params.flank_width_m);
  table.read("flank_depth_m", params.flank_depth_m);
  table.read("flank_max", params.flank_max);
  table.read("max_shared", params.max_shared);
  table.read("merge_min_cos", params.merge_min_cos);
  table.read("merge_offset_m", params.merge_offset_m);
  table.read("merge_gap_m", params.merge_gap_m);
  table.read("merge_overlap_m", params.merge_overlap_m);
  table.read("rail_merge_min_cos", params.rail_merge_min_cos);
  table.read("rail_merge_offset_m", params.rail_merge_offset_m);
}

void read(ConfigTable table, ladder::LadderTestParams& params) {
  table.read("rail_min_cos", params.rail_min_cos);
  table.read("min_width_m", params.min_width_m);
  table.read("max_width_m", params.max_width_m);
  table.read("rung_min_cos", params.rung_min_cos);
  table.read("attach_m", params.attach_m);
  table.read("attach_far_factor", params.attach_far_factor);
  table.read("rail_overrun_m", params.rail_overrun_m);
  table.read("rail_unseen_m", params.rail_unseen_m);
  table.read("rung_overrun_m", params.rung_overrun_m);
  table.read("reach_rail_m", params.reach_rail_m);
  table.read("half_score", params.half_score);
  table.read("min_whole_rungs", params.min_whole_rungs);
  table.read("min_partial_rungs", params.min_partial_rungs);
  table.read("min_joint_distance_m", params.min_joint_distance_m);
  table.read("frame_min_spacing_m", params.frame_min_spacing_m);
  table.read("frame_max_spacing_m", params.frame_max_spacing_m);
  table.read("spacing_tolerance", params.spacing_tolerance);
  table.read("thick_rungs", params.thick_rungs);
  table.read("hole_max", params.hole_max);
  table.read("hole_rail_m", params.hole_rail_m);
  table.read("hole_rung_m", params.hole_rung_m);
  table.read("on_rung_m", params.on_rung_m);
  table.read("hole_depth_m", params.hole_depth_m);
  table.read("hole_margin_m", params.hole_margin_m);
  table.read("deep_max", params.deep_max);
  table.read("deep_from_m", params.deep_from_m);
  table.read("deep_to_m", params.deep_to_m);
  table.read("deep_half_height_m", params.deep_half_height_m);
  table.read("tread_from_m", params.tread_from_m);
  table.read("tread_to_m", params.tread_to_m);
  table.read("tread_min_depth_m", params.tread_min_depth_m);
  table.read("v_height_m", params.v_height_m);
  table.read("v_gap_m", params.v_gap_m);
  table.read("min_stub_length_m", params.min_stub_length_m);
  table.read("same_level_m", params.same_level_m);
  table.read("min_rungs", params.min_rungs);
  table.read("min_spacing_m", params.min_spacing_m);
  table.read("max_spacing_m", params.max_spacing_m);
  table.read("max_spacing_sigma_m", params.max_spacing_sigma_m);
  table.read("height_sigma_m", params.height_sigma_m);
}

void read(ConfigTable table, ladder::MeasureParams& params) {
  table.read("joint_trim_m", params.joint_trim_m);
  table.read("rail_half_width_m", params.rail_half_width_m);
  table.read("rail_width_switch_m", params.rail_width_switch_m);
  table.read("prior_radius_m", params.prior_radius_m);
  table.read("edge_lost_px", params.edge_lost_px);
  table.read("edge_gained_px", params.edge_gained_px);
  table.read("radius_alike", params.radius_alike);
  table.read("square_rungs", params.square_rungs);
  table.read("head_min_weight", params.head_min_weight);
  table.read("head_min_share", params.head_min_share);
  table.read("head_linearity", params.head_linearity);
  table.read("min_weight", params.min_weight);
  table.read("whole_height", params.whole_height);
  table.read("stub_gap_m", params.stub_gap_m);
  table.read("stub_margin_m", params.stub_margin_m);
  table.read("sag_flag_m", params.sag_flag_m);
  table.read("bent_flag_tan", params.bent_flag_tan);
  table.read("tilt_flag_sin", params.tilt_flag_sin);
}

void read(ConfigTable table, ladder::AlignParams& params) {
  table.read("enabled", params.enabled);
  table.read("sigma_shift_m", params.sigma_shift_m);
  table.read("sigma_turn_rad", params.sigma_turn_rad);
  table.read("least_share", params.least_share);
  table.read("sigma_range_m", params.sigma_range_m);
  table.read("sigma_gravity", params.sigma_gravity);
  table.read("sigma_plane_m", params.sigma_plane_m);
  table.read("sigma_bar_m", params.sigma_bar_m);
  table.read("min_bar_weight", params.min_bar_weight);
  table.read("told_share", params.told_share);
  table.read("keep", params.keep);
  table.read("frame_share", params.frame_share);
  table.read("far_m", params.far_m);
  table.read("corner_m", params.corner_m);
  table.read("contested_m", params.contested_m);
  table.read("thick_max", params.thick_max);
  table.read("upright_max_sin", params.upright_max_sin);
  table.read("min_weight", params.min_weight);
  table.read("min_nodes", params.min_nodes);
  table.read("max_planes", params.max_planes);
  table.read("gain", params.gain);
  table.read("begin_misfit_m", params.begin_misfit_m);
  table.read("end_misfit_m", params.end_misfit_m);
  table.read("settle_frames", params.settle_frames);
  table.read("max_shift_m", params.max_shift_m);
  table.read("max_turn_rad", params.max_turn_rad);
  table.read("max_range_m", params.max_range_m);
}

void read(ConfigTable table, ladder::TrackParams& params) {
  table.read("trust_evidence", params.trust_evidence);
  table.read("drop_evidence", params.drop_evidence);
  table.read("max_evidence", params.max_evidence);
  table.read("max_missed", params.max_missed);
  table.read("gate_across_m", params.gate_across_m);
  table.read("gate_along_m", params.gate_along_m);
  table.read("min_gain", params.min_gain);
  table.read("shape_gain", params.shape_gain);
  table.read("prior_sigma_m", params.prior_sigma_m);
  table.read("systematic_sigma_m", params.systematic_sigma_m);
}

void read(ConfigTable table, ladder::AffordanceParams& params) {
  table.read("step_m", params.step_m);
  table.read("clearance_m", params.clearance_m);
  table.read("claw_width_m", params.claw_width_m);
  table.read("claw_margin_m", params.claw_margin_m);
  table.read("margin_sigmas", params.margin_sigmas);
  table.read("max_wander_m", params.max_wander_m);
  table.read("max_side_sigma_m", params.max_side_sigma_m);
  table.read("gripper_width_m", params.gripper_width_m);
  table.read("outlier_reach_m", params.outlier_reach_m);
  table.read("outlier_min_weight", params.outlier_min_weight);
  table.read("seen_reach_m", params.seen_reach_m);
  table.read("max_tilt_sin", params.max_tilt_sin);
  table.read("max_length_m", params.max_length_m);
}

void read(ConfigTable table, ladder::PaperParams& params) {
  table.read("inlier_m", params.inlier_m);
  table.read("outlier_m", params.outlier_m);
  table.read("box_margin_m", params.box_margin_m);
  table.read("workspace_m", params.workspace_m);
  table.read("tries", params.tries);
  table.read("pair_gate", params.pair_gate);
  table.read("pair_gate_m", params.pair_gate_m);
  table.read("min_inliers", params.min_inliers);
  table.read("inlier_ratio", params.inlier_ratio);
  table.read("min_length_m", params.min_length_m);
  table.read("xi", params.xi);
  table.read("xi_age", params.xi_age);
  table.read("min_surplus", params.min_surplus);
  table.read("age_initial", params.age_initial);
  table.read("age_trusted", params.age_trusted);
  table.read("age_max", params.age_max);
  table.read("age_affordance", params.age_affordance);
  table.read("gamma", params.gamma);
  table.read("merge_min_cos", params.merge_min_cos);
  table.read("merge_distance_m", params.merge_distance_m);
  table.read("rail_min_dz", params.rail_min_dz);
}

}  // namespace

ladder::LadderParams read_params(ConfigTable table) {
  ladder::Mode mode = ladder::Mode::kDefault;
  table.read("mode", mode, {{"default", ladder::Mode::kDefault}, {"paper", ladder::Mode::kPaper}});
  ladder::LadderParams params =
      mode == ladder::Mode::kPaper ? ladder::paper_params() : ladder::LadderParams{};
  table.read("seed", params.seed);
  table.read("max_nodes", params.max_nodes);
  table.read("max_cloud_nodes", params.max_cloud_nodes);
  table.read("max_cloud_edges", params.max_cloud_edges);
  table.read("max_bars", params.max_bars);
  table.read("max_tracks", params.max_tracks);
  read(table.table("bar"), params.bar);
  read(table.table("test"), params.test);
  read(table.table("measure"), params.measure);
  read(table.table("align"), params.align);
  read(table.table("track"), params.track);
  read(table.table("affordance"), params.affordance);
  read(table.table("paper"), params.paper);
  table.require(check(params));
  return params;
}

}  // namespace ladder_service
