// SPDX-License-Identifier: BSD-3-Clause
// Every constant of the growing part (Algorithms 1 and 2 and the GNG-U core). The defaults are the
// set that was measured best; paper_params() gives the paper's own numbers. Sources: "paper" = the
// IROS 2019 text, "T16" = Toda et al. 2016 (GNG with utility), "measured" = docs/EQUATIONS.md.
#pragma once

#include <cstdint>
#include <string>

namespace ddgng {

struct GrowingParams {
  std::uint64_t seed = 1;  ///< of all random numbers, together with the cloud's sequence number

  // Algorithm 1: the signals of one frame.
  int uniform_signals = 1000;     ///< per frame, drawn from all points; 0..1e6 (measured)
  int attention_signals = 4000;   ///< per frame, drawn from the suspected area, else from all
                                  ///< points; 0..1e6; 0 = no density control at all (measured)
  int insertion_interval = 10;    ///< signals between insertion rounds, >= 1 (measured)
  int plain_insertion_every = 4;  ///< every so many rounds also one insertion by error alone, >= 1
                                  ///< (measured)

  // Bounds.
  int max_nodes = 1000;       ///< 2..32767 (paper's program)
  int max_plane_nodes = 200;  ///< no insertion by error alone from this many nodes outside the
                              ///< suspected area on, >= 2; max_nodes = no bound (measured)
  int max_degree = 24;        ///< edges of one node, 2..kDegreeLimit; the oldest gives way (ours)

  // Boot: planes must be known before the first suspected area can be.
  int boot_signals =
      1000;  ///< uniform signals before the first segmentation; 0 = no boot (measured)
  int max_boot_nodes = 200;  ///< 2..max_nodes (measured)

  // GNG-U core.
  float winner_rate = 0.08F;      ///< eta1, 0..1 (T16)
  float neighbour_rate = 0.008F;  ///< eta2, 0..winner_rate (T16)
  int max_edge_age = 88;          ///< g_max, 1..kAgeLimit, wins of an end without the other (T16)
  float error_cut = 0.5F;         ///< alpha, share taken from both parents at insertion, 0..1 (T16)
  float error_decay = 1e-3F;      ///< beta, per signal, 0..0.1 (measured; paper .005)
  float utility_decay_outside = 1e-4F;  ///< chi outside the suspected area, per signal, 0..0.1
                                        ///< (measured; T16 .005)
  float utility_decay_inside = 1e-4F;   ///< chi inside, 0..0.1 (measured; paper's program 2.56e-4)
  float utility_threshold = 1000.0F;    ///< k, on E_u / U_l, > 0 (T16)
  int utility_interval = 10;            ///< kappa, signals between utility checks, >= 1 (T16)
  int min_utility_nodes =
      10;  ///< theta_r: utility removal needs more nodes than this, >= 2 (paper)

  // Algorithm 2: strength.
  float strength_outside = 1.0F;  ///< delta of a node outside the suspected area, > 0 (paper)
  float strength_inside = 3.71F;  ///< delta inside, >= strength_outside; equal = insertion without
                                  ///< density (paper's program)
  int strength_exponent = 4;      ///< p of E delta^p at insertion, 0..8 (paper's program)

  // Points won by each node.
  float moment_gate_m = 0.06F;  ///< points farther from the winner are not counted, > 0 (measured)
  float moment_forget = 0.8F;   ///< weight left after each frame, 0..1 (measured)
  float min_moment_weight = 0.05F;  ///< lighter moments are dropped, > 0 (ours)
};

/// The paper's literal numbers: 500 signals of which every second from the suspected area, one
/// insertion by error and one by strength at the end of the frame, decays .005 and 9.5e-4 / delta.
GrowingParams paper_params();

/// "" or the violated relation in words, naming the field.
std::string check(const GrowingParams& params);

}  // namespace ddgng
