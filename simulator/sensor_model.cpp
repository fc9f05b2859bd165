// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/sensor_model.h"

#include <algorithm>
#include <cmath>

namespace simulator {
namespace {

/// The surface on which noise_share holds: mid-grey, frontal.
constexpr float kReferenceAmplitude = 0.5F;
constexpr float kMaxNoiseFactor = 4.0F;
/// Four waves per 2.49 m, as the fourth harmonic of a 60 MHz modulation has.
constexpr float kWiggleWaves_per_m = 4.0F / 2.49F;

/// Mean 0, standard deviation 1: sum of eight 16-bit numbers out of two draws.
float fast_gaussian(base::Rng& rng) {
  std::int64_t sum = 0;
  for (int draw = 0; draw < 2; ++draw) {
    const std::uint64_t bits = rng.next();
    for (int part = 0; part < 4; ++part) {
      sum += static_cast<std::int64_t>((bits >> (16 * part)) & 0xFFFFU);
    }
  }
  constexpr float kMean = 8.0F * 32767.5F;
  constexpr float kSigma = 53509.9F;  // sqrt(8 (65536^2 - 1) / 12)
  return (static_cast<float>(sum) - kMean) / kSigma;
}

std::uint32_t to_q32(double probability) {
  return static_cast<std::uint32_t>(std::clamp(probability * 0x1p32, 0.0, 0x1p32 - 1.0));
}

}  // namespace

std::string check(const SensorParams& params) {
  if (params.width_px < 1 || params.width_px > 1024) return "width_px must be in [1, 1024]";
  if (params.height_px < 1 || params.height_px > 1024) return "height_px must be in [1, 1024]";
  if (!(params.horizontal_deg > 1.0 && params.horizontal_deg < 150.0)) {
    return "horizontal_deg must be in (1, 150)";
  }
  if (!(params.vertical_deg > 1.0 && params.vertical_deg < 150.0)) {
    return "vertical_deg must be in (1, 150)";
  }
  if (!(params.range_min_m >= 0.0 && params.range_min_m < params.range_max_m)) {
    return "range_min_m must be in [0, range_max_m)";
  }
  if (!(params.range_max_m <= 30.0)) return "range_max_m must be at most 30";
  if (params.wrap_range_m != 0.0 && !(params.wrap_range_m > params.range_min_m)) {
    return "wrap_range_m must be 0 or above range_min_m";
  }
  for (const double share :
       {params.noise_share, params.edge_dropout, params.random_dropout, params.noise_floor_m,
        params.wiggle_m, params.pixel_bias_m, params.extrinsic_sigma_m}) {
    if (!(share >= 0.0 && share <= 1.0)) {
      return "noise_share, noise_floor_m, wiggle_m, pixel_bias_m, edge_dropout, random_dropout and "
             "extrinsic_sigma_m must be in [0, 1]";
    }
  }
  if (!(params.extrinsic_sigma_deg >= 0.0 && params.extrinsic_sigma_deg <= 45.0)) {
    return "extrinsic_sigma_deg must be in [0, 45]";
  }
  return "";
}

SensorModel::SensorModel(const SensorParams& params)
    : noise_share_(static_cast<float>(params.noise_share)),
      noise_floor_m_(static_cast<float>(params.noise_floor_m)),
      wiggle_amplitude_m_(static_cast<float>(params.wiggle_m)),
      range_min_m_(static_cast<float>(params.range_min_m)),
      range_max_m_(static_cast<float>(params.range_max_m)),
      wrap_range_m_(static_cast<float>(params.wrap_range_m)),
      edge_dropout_q32_(to_q32(params.edge_dropout)),
      random_dropout_q32_(to_q32(params.random_dropout)) {}

float SensorModel::sigma_m(const Return& light) const {
  // Shot noise: the standard deviation goes with 1 / sqrt(amplitude).
  const float least = kReferenceAmplitude / (kMaxNoiseFactor * kMaxNoiseFactor);
  const float factor = std::sqrt(kReferenceAmplitude / std::max(light.amplitude, least));
  return std::max(noise_floor_m_, noise_share_ * light.range_m * factor);
}

float SensorModel::wiggle_m(float range_m) const {
  // Two parabolas per wave instead of a sine: no libm.
  const float waves = range_m * kWiggleWaves_per_m;
  const float phase = waves - std::floor(waves);
  const float half = phase < 0.5F ? phase : phase - 0.5F;
  const float bow = 16.0F * half * (0.5F - half);
  return wiggle_amplitude_m_ * (phase < 0.5F ? bow : -bow);
}

float SensorModel::measure(const Return& light, bool on_edge, base::Rng& rng) const {
  const std::uint64_t bits = rng.next();
  const float gaussian = fast_gaussian(rng);
  const auto low = static_cast<std::uint32_t>(bits);
  const auto high = static_cast<std::uint32_t>(bits >> 32);
  if (light.amplitude <= 0.0F || light.range_m > range_max_m_) return 0.0F;
  if (low < random_dropout_q32_ || (on_edge && high < edge_dropout_q32_)) return 0.0F;
  float range_m = light.range_m + wiggle_m(light.range_m) + sigma_m(light) * gaussian;
  if (wrap_range_m_ > 0.0F) range_m -= wrap_range_m_ * std::floor(range_m / wrap_range_m_);
  return range_m < range_min_m_ || range_m > range_max_m_ ? 0.0F : range_m;
}

std::uint8_t SensorModel::confidence(const Return& light) {
  if (light.amplitude <= 0.0F) return 0;
  constexpr float kHalf_per_m2 = 0.05F;  // mid-grey at 3.2 m has half of the greatest confidence
  const float share =
      light.amplitude / (light.amplitude + kHalf_per_m2 * light.range_m * light.range_m);
  return static_cast<std::uint8_t>(255.0F * share);
}

}  // namespace simulator
