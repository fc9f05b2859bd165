// SPDX-License-Identifier: BSD-3-Clause
#include "ladder/params.h"

#include <array>
#include <cmath>

namespace ladder {
namespace {

struct Relation {
  bool holds;
  const char* words;
};

template <std::size_t N>
std::string first_violated(const std::array<Relation, N>& relations) {
  for (const Relation& relation : relations) {
    if (!relation.holds) return relation.words;
  }
  return "";
}

// Written so that NaN violates them.
bool in(double low, double value, double high) {
  return value >= low && value <= high;
}

std::string check_capacities(const LadderParams& p) {
  return first_violated(std::array{
      Relation{p.max_nodes >= 16 && p.max_nodes <= 32768, "max_nodes must be in 16..32768"},
      Relation{p.max_cloud_nodes >= p.max_nodes && p.max_cloud_nodes <= 1 << 20,
               "max_cloud_nodes must be in max_nodes..2^20"},
      Relation{p.max_cloud_edges >= 16 && p.max_cloud_edges <= 1 << 24,
               "max_cloud_edges must be in 16..2^24"},
      Relation{p.max_bars >= 1 && p.max_bars <= 1024, "max_bars must be in 1..1024"},
      Relation{p.max_tracks >= 1 && p.max_tracks <= 256, "max_tracks must be in 1..256"},
  });
}

std::string check_bar(const BarParams& p) {
  return first_violated(std::array{
      Relation{in(0.001, p.narrow_half_height_m, 1.0),
               "bar.narrow_half_height_m must be in 0.001..1"},
      Relation{in(p.narrow_half_height_m, p.wide_half_height_m, 1.0),
               "bar.wide_half_height_m must be in narrow_half_height_m..1"},
      Relation{in(p.narrow_half_height_m, p.narrow_neighborhood_m, 1.0),
               "bar.narrow_neighborhood_m must be in narrow_half_height_m..1"},
      Relation{in(p.wide_half_height_m, p.wide_neighborhood_m, 1.0),
               "bar.wide_neighborhood_m must be in wide_half_height_m..1"},
      Relation{in(1.0, p.wide_gain, 100.0), "bar.wide_gain must be in 1..100"},
      Relation{in(1.0, p.seed_linearity, 1e6), "bar.seed_linearity must be in 1..1e6"},
      Relation{in(1.0, p.rung_linearity, 1e6), "bar.rung_linearity must be in 1..1e6"},
      Relation{in(1.0, p.rail_linearity, 1e6), "bar.rail_linearity must be in 1..1e6"},
      Relation{in(0.0, p.level_max_dz, 1.0), "bar.level_max_dz must be in 0..1"},
      Relation{in(p.level_max_dz, p.upright_min_dz, 1.0),
               "bar.upright_min_dz must be in level_max_dz..1"},
      Relation{in(0.0, p.noise_sigmas, 10.0), "bar.noise_sigmas must be in 0..10"},
      Relation{in(0.0, p.max_noise_share, 0.1), "bar.max_noise_share must be in 0..0.1"},
      Relation{in(0.001, p.gap_m, 10.0), "bar.gap_m must be in 0.001..10"},
      Relation{p.num_refits >= 1 && p.num_refits <= 100, "bar.num_refits must be in 1..100"},
      Relation{in(0.01, p.reach_m, 100.0), "bar.reach_m must be in 0.01..100"},
      Relation{in(0.01, p.min_rung_length_m, 10.0), "bar.min_rung_length_m must be in 0.01..10"},
      Relation{in(0.01, p.min_rail_length_m, 10.0), "bar.min_rail_length_m must be in 0.01..10"},
      Relation{p.min_rung_nodes >= 3, "bar.min_rung_nodes must be at least 3"},
      Relation{p.min_rail_nodes >= 3, "bar.min_rail_nodes must be at least 3"},
      Relation{in(0.0, p.min_weight, 1e9), "bar.min_weight must be in 0..1e9"},
      Relation{in(1e-6, p.min_node_weight, 1e9), "bar.min_node_weight must be in 1e-6..1e9"},
      Relation{in(p.min_node_weight, p.weight_without_moments, 1e9),
               "bar.weight_without_moments must be in min_node_weight..1e9"},
      Relation{in(0.0, p.flank_width_m, 1.0), "bar.flank_width_m must be in 0..1"},
      Relation{in(0.0, p.flank_depth_m, 1.0), "bar.flank_depth_m must be in 0..1"},
      Relation{in(0.0, p.flank_max, 1e9), "bar.flank_max must be in 0..1e9"},
      Relation{in(0.0, p.max_shared, 1.0), "bar.max_shared must be in 0..1"},
  });
}

std::string check_test(const LadderTestParams& p) {
  return first_violated(std::array{
      Relation{in(0.01, p.min_width_m, p.max_width_m),
               "test.min_width_m must be in 0.01..max_width_m"},
      Relation{in(p.min_width_m, p.max_width_m, 10.0),
               "test.max_width_m must be in min_width_m..10"},
      Relation{p.min_whole_rungs >= 1, "test.min_whole_rungs must be at least 1"},
      Relation{p.min_partial_rungs >= 2, "test.min_partial_rungs must be at least 2"},
      Relation{in(0.0, p.rail_unseen_m, 100.0), "test.rail_unseen_m must be in 0..100"},
      Relation{in(0.01, p.min_joint_distance_m, p.frame_max_spacing_m),
               "test.min_joint_distance_m must be in 0.01..frame_max_spacing_m"},
      Relation{in(0.01, p.frame_min_spacing_m, p.frame_max_spacing_m),
               "test.frame_min_spacing_m must be in 0.01..frame_max_spacing_m"},
      Relation{in(0.01, p.min_spacing_m, p.max_spacing_m),
               "test.min_spacing_m must be in 0.01..max_spacing_m"},
      Relation{in(p.min_spacing_m, p.max_spacing_m, 10.0),
               "test.max_spacing_m must be in min_spacing_m..10"},
      Relation{in(0.0, p.spacing_tolerance, 0.5), "test.spacing_tolerance must be in 0..0.5"},
      Relation{in(0.0, p.hole_max, 1e9), "test.hole_max must be in 0..1e9"},
      Relation{in(0.0, p.deep_max, 1e9), "test.deep_max must be in 0..1e9"},
      Relation{in(0.0, p.tread_from_m, p.tread_to_m), "test.tread_from_m must be in 0..tread_to_m"},
      Relation{in(p.tread_from_m, p.tread_to_m, 1.0), "test.tread_to_m must be in tread_from_m..1"},
      Relation{in(1e-4, p.tread_min_depth_m, 1e9), "test.tread_min_depth_m must be in 1e-4..1e9"},
      Relation{p.min_rungs >= 3, "test.min_rungs must be at least 3"},
      Relation{in(1e-6, p.max_spacing_sigma_m, 1.0), "test.max_spacing_sigma_m must be in 1e-6..1"},
      Relation{in(1e-6, p.height_sigma_m, 1.0), "test.height_sigma_m must be in 1e-6..1"},
  });
}

std::string check_measure_and_track(const MeasureParams& m, const TrackParams& t) {
  return first_violated(std::array{
      Relation{in(0.001, m.prior_radius_m, 1.0), "measure.prior_radius_m must be in 0.001..1"},
      Relation{in(0.0, m.edge_lost_px, 1.0), "measure.edge_lost_px must be in 0..1"},
      Relation{in(0.0, m.edge_gained_px, 1.0), "measure.edge_gained_px must be in 0..1"},
      Relation{in(0.0, m.radius_alike, 1e3), "measure.radius_alike must be in 0..1000"},
      Relation{in(1e-6, m.min_weight, 1e9), "measure.min_weight must be in 1e-6..1e9"},
      Relation{in(0.0, m.whole_height, 1.0), "measure.whole_height must be in 0..1"},
      Relation{in(0.001, m.stub_margin_m, 1.0), "measure.stub_margin_m must be in 0.001..1"},
      Relation{t.max_evidence >= 1, "track.max_evidence must be at least 1"},
      Relation{t.trust_evidence >= 1 && t.trust_evidence <= t.max_evidence,
               "track.trust_evidence must be in 1..max_evidence"},
      Relation{t.drop_evidence >= 1 && t.drop_evidence <= t.trust_evidence,
               "track.drop_evidence must be in 1..trust_evidence"},
      Relation{t.max_missed >= 1, "track.max_missed must be at least 1"},
      Relation{in(1e-3, t.min_gain, 1.0), "track.min_gain must be in 0.001..1"},
      Relation{in(1e-3, t.shape_gain, 1.0), "track.shape_gain must be in 0.001..1"},
      Relation{in(0.001, t.gate_across_m, 1.0), "track.gate_across_m must be in 0.001..1"},
      Relation{in(0.001, t.gate_along_m, 10.0), "track.gate_along_m must be in 0.001..10"},
  });
}

std::string check_align(const AlignParams& p) {
  return first_violated(std::array{
      Relation{in(1e-6, p.sigma_shift_m, 1.0), "align.sigma_shift_m must be in 1e-6..1"},
      Relation{in(1e-6, p.sigma_turn_rad, 1.0), "align.sigma_turn_rad must be in 1e-6..1"},
      Relation{in(1e-3, p.least_share, 1.0), "align.least_share must be in 0.001..1"},
      Relation{in(1e-6, p.sigma_range_m, 1.0), "align.sigma_range_m must be in 1e-6..1"},
      Relation{in(1e-6, p.sigma_gravity, 1.0), "align.sigma_gravity must be in 1e-6..1"},
      Relation{in(1e-4, p.sigma_plane_m, 1.0), "align.sigma_plane_m must be in 1e-4..1"},
      Relation{in(1e-4, p.sigma_bar_m, 1.0), "align.sigma_bar_m must be in 1e-4..1"},
      Relation{in(1.0, p.min_bar_weight, 1e9), "align.min_bar_weight must be in 1..1e9"},
      Relation{in(0.0, p.told_share, 1.0), "align.told_share must be in 0..1"},
      Relation{in(0.0, p.keep, 0.9999), "align.keep must be in 0..0.9999"},
      Relation{in(0.0, p.frame_share, 1.0), "align.frame_share must be in 0..1"},
      Relation{in(0.0, p.far_m, 10.0), "align.far_m must be in 0..10"},
      Relation{in(0.0, p.corner_m, 1.0), "align.corner_m must be in 0..1"},
      Relation{in(0.0, p.contested_m, 1.0), "align.contested_m must be in 0..1"},
      Relation{in(1.0, p.thick_max, 1e9), "align.thick_max must be in 1..1e9"},
      Relation{in(0.0, p.upright_max_sin, 0.5), "align.upright_max_sin must be in 0..0.5"},
      Relation{in(1.1, p.min_weight, 1e9), "align.min_weight must be in 1.1..1e9"},
      Relation{in(1.0, p.min_nodes, 1e6), "align.min_nodes must be in 1..1e6"},
      Relation{p.max_planes >= 1 && p.max_planes <= 1024, "align.max_planes must be in 1..1024"},
      Relation{in(0.0, p.gain, 1.0), "align.gain must be in 0..1"},
      Relation{in(0.0, p.begin_misfit_m, 1.0), "align.begin_misfit_m must be in 0..1"},
      Relation{in(0.0, p.end_misfit_m, p.begin_misfit_m),
               "align.end_misfit_m must be in 0..begin_misfit_m"},
      Relation{p.settle_frames >= 0 && p.settle_frames <= 100000,
               "align.settle_frames must be in 0..100000"},
      Relation{in(0.0, p.max_shift_m, 0.1), "align.max_shift_m must be in 0..0.1"},
      Relation{in(0.0, p.max_turn_rad, 0.1), "align.max_turn_rad must be in 0..0.1"},
      Relation{in(0.0, p.max_range_m, 0.1), "align.max_range_m must be in 0..0.1"},
  });
}

std::string check_affordance(const AffordanceParams& p) {
  return first_violated(std::array{
      Relation{in(0.001, p.step_m, 0.1), "affordance.step_m must be in 0.001..0.1"},
      Relation{in(0.0, p.clearance_m, 1.0), "affordance.clearance_m must be in 0..1"},
      Relation{in(0.0, p.claw_width_m, 1.0), "affordance.claw_width_m must be in 0..1"},
      Relation{in(0.0, p.claw_margin_m, 1.0), "affordance.claw_margin_m must be in 0..1"},
      Relation{in(0.0, p.margin_sigmas, 100.0), "affordance.margin_sigmas must be in 0..100"},
      Relation{in(0.0, p.max_wander_m, 10.0), "affordance.max_wander_m must be in 0..10"},
      Relation{in(0.0, p.max_side_sigma_m, 10.0), "affordance.max_side_sigma_m must be in 0..10"},
      Relation{in(p.claw_width_m, p.gripper_width_m, 1.0),
               "affordance.gripper_width_m must be in claw_width_m..1"},
      Relation{in(0.1, p.max_length_m, 10.0), "affordance.max_length_m must be in 0.1..10"},
  });
}

std::string check_paper(const PaperParams& p) {
  return first_violated(std::array{
      Relation{in(1e-4, p.inlier_m, p.outlier_m), "paper.inlier_m must be in 1e-4..outlier_m"},
      Relation{in(p.inlier_m, p.outlier_m, 1.0), "paper.outlier_m must be in inlier_m..1"},
      Relation{in(0.01, p.workspace_m, 100.0), "paper.workspace_m must be in 0.01..100"},
      Relation{p.tries >= 0 && p.tries <= 100000, "paper.tries must be in 0..100000"},
      Relation{p.min_inliers >= 1, "paper.min_inliers must be at least 1"},
      Relation{in(1e-3, p.min_length_m, 10.0), "paper.min_length_m must be in 0.001..10"},
      Relation{p.age_initial >= 0 && p.age_initial <= p.age_max,
               "paper.age_initial must be in 0..age_max"},
      Relation{p.age_trusted <= p.age_affordance && p.age_affordance < p.age_max,
               "paper ages must keep age_trusted <= age_affordance < age_max"},
      Relation{in(0.0, p.gamma, 1.0), "paper.gamma must be in 0..1"},
      Relation{in(0.0, p.rail_min_dz, 1.0), "paper.rail_min_dz must be in 0..1"},
  });
}

}  // namespace

LadderParams paper_params() {
  LadderParams params;
  params.mode = Mode::kPaper;
  return params;
}

std::string check(const LadderParams& params) {
  for (const std::string& violated :
       {check_capacities(params), check_bar(params.bar), check_test(params.test),
        check_measure_and_track(params.measure, params.track), check_align(params.align),
        check_affordance(params.affordance), check_paper(params.paper)}) {
    if (!violated.empty()) return violated;
  }
  return "";
}

}  // namespace ladder
