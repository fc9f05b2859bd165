// SPDX-License-Identifier: BSD-3-Clause
// What a time-of-flight pixel makes of a distance: noise, phase wiggle, wrapping, drop-outs,
// confidence. Only + - * / sqrt and comparisons, so that the bits are the same on every CPU.
#pragma once

#include <cstdint>
#include <string>

#include "base/rng.h"

namespace simulator {

/// Defaults: pmd pico flexx, with noise on the hard side.
struct SensorParams {
  int width_px = 224;
  int height_px = 171;
  double horizontal_deg = 62.0;  ///< fields of view
  double vertical_deg = 45.0;
  double range_min_m = 0.1;
  double range_max_m = 4.0;
  double wrap_range_m = 0.0;         ///< 2.49 for a single-frequency mode; 0 = does not wrap
  double noise_share = 0.01;         ///< standard deviation / range on a mid-grey frontal surface
  double noise_floor_m = 0.002;      ///< least standard deviation
  double wiggle_m = 0.003;           ///< amplitude of the periodic phase error
  double pixel_bias_m = 0.0;         ///< standard deviation of an error that stays: blots over the
                                     ///< image, drawn per head and seed
  double edge_dropout = 0.4;         ///< probability that a pixel on a depth edge returns nothing
  double random_dropout = 0.03;      ///< the same for every pixel
  double extrinsic_sigma_m = 0.002;  ///< mounting error per axis, fixed per head and seed
  double extrinsic_sigma_deg = 0.2;
  bool radial = true;  ///< DEPTH_RADIAL, else DEPTH_Z
};

/// "" or the violated relation.
std::string check(const SensorParams& params);

/// Light that one or several rays of a pixel brought back.
struct Return {
  float range_m = 0.0F;
  float amplitude = 0.0F;  ///< reflectance times cosine of incidence, 0 = no return, 1 = most
};

class SensorModel {
 public:
  explicit SensorModel(const SensorParams& params);

  /// Standard deviation of the range noise.
  float sigma_m(const Return& light) const;
  /// Periodic error of the phase measurement at that range.
  float wiggle_m(float range_m) const;
  /// Measured range, 0 = out of range or dropped. Takes a fixed number of random numbers.
  float measure(const Return& light, bool on_edge, base::Rng& rng) const;
  /// 0 = worthless .. 255 = certain: falls with the square of the range.
  static std::uint8_t confidence(const Return& light);

 private:
  float noise_share_, noise_floor_m_, wiggle_amplitude_m_;
  float range_min_m_, range_max_m_, wrap_range_m_;
  std::uint32_t edge_dropout_q32_, random_dropout_q32_;
};

}  // namespace simulator
