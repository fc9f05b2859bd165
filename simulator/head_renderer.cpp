// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/head_renderer.h"

#include <cmath>
#include <numbers>

namespace simulator {
namespace {

using Eigen::Vector3f;

/// Two surfaces this far apart along the ray make a flying pixel.
constexpr float kEdgeStep_m = 0.01F;

Eigen::Vector3d gaussian3(base::Rng& rng, double sigma) {
  const double x = rng.gaussian();
  const double y = rng.gaussian();
  const double z = rng.gaussian();
  return sigma * Eigen::Vector3d(x, y, z);
}

/// The small rotation of a mounting error, by its rotation vector.
Eigen::Matrix3d small_rotation(const Eigen::Vector3d& angles_rad) {
  const Eigen::Quaterniond q(1.0, 0.5 * angles_rad.x(), 0.5 * angles_rad.y(), 0.5 * angles_rad.z());
  return q.normalized().toRotationMatrix();
}

/// One value per pixel: drawn at every kBlot_px-th, straight lines between.
std::vector<float> smooth_error(const Pinhole& pinhole, double sigma, base::Rng rng) {
  constexpr int kBlot_px = 16;
  const int columns = pinhole.width_px / kBlot_px + 2;
  const int rows = pinhole.height_px / kBlot_px + 2;
  std::vector<float> knots(static_cast<std::size_t>(columns * rows));
  for (float& knot : knots) knot = static_cast<float>(sigma * rng.gaussian());
  std::vector<float> error;
  error.reserve(static_cast<std::size_t>(pinhole.width_px * pinhole.height_px));
  for (int y = 0; y < pinhole.height_px; ++y) {
    for (int x = 0; x < pinhole.width_px; ++x) {
      const float right = static_cast<float>(x % kBlot_px) / kBlot_px;
      const float down = static_cast<float>(y % kBlot_px) / kBlot_px;
      const float* knot = &knots[static_cast<std::size_t>(y / kBlot_px * columns + x / kBlot_px)];
      const float above = knot[0] + right * (knot[1] - knot[0]);
      const float below = knot[columns] + right * (knot[columns + 1] - knot[columns]);
      error.push_back(above + down * (below - above));
    }
  }
  return error;
}

bool is_edge(const Hit& a, const Hit& b) {
  if (a.primitive == b.primitive) return false;  // convex bodies have no steps of their own
  if (a.primitive < 0 || b.primitive < 0) return true;
  return std::abs(a.range_m - b.range_m) > kEdgeStep_m;
}

}  // namespace

HeadRenderer::HeadRenderer(const SensorParams& params, const HeadMount& mount, int head_index,
                           std::uint64_t seed)
    : sensor_(params),
      radial_(params.radial),
      noise_seed_(base::Rng(seed, static_cast<std::uint64_t>(head_index)).next()),
      T_body_head_nominal_(T_body_head(mount)),
      T_body_head_true_(T_body_head_nominal_),
      caster_(Pinhole::from_field_of_view(params.width_px, params.height_px, params.horizontal_deg,
                                          params.vertical_deg)),
      hits_(caster_.rays().size()),
      on_edge_(caster_.rays().size()) {
  base::Rng rng(~noise_seed_);
  const double sigma_rad = params.extrinsic_sigma_deg * std::numbers::pi / 180.0;
  T_body_head_true_.translation() += gaussian3(rng, params.extrinsic_sigma_m);
  T_body_head_true_.linear() =
      T_body_head_nominal_.linear() * small_rotation(gaussian3(rng, sigma_rad));
  if (params.pixel_bias_m > 0.0) {
    pixel_bias_m_ = smooth_error(pinhole(), params.pixel_bias_m, rng);
  }
}

void HeadRenderer::render(const mjModel& model, const mjData& state,
                          const Eigen::Isometry3d& T_world_body, std::uint64_t frame,
                          HeadImage& image) {
  collect_primitives(model, state, T_world_body * T_body_head_true_, caster_.primitives());
  caster_.cull();
  caster_.cast(hits_);
  find_edges();

  const std::size_t num_pixels = hits_.size();
  image.depth_mm.resize(num_pixels);
  image.confidence.resize(num_pixels);
  image.clean_geom.resize(num_pixels);
  image.true_range_m.resize(num_pixels);
  base::Rng rng(noise_seed_, frame);
  const int width = pinhole().width_px;
  for (std::size_t i = 0; i < num_pixels; ++i) {
    const int x = static_cast<int>(i) % width;
    const int y = static_cast<int>(i) / width;
    const PixelLight pixel = on_edge_[i] != 0 ? light_of_edge(x, y) : light_of_ray(i);
    float range_m = sensor_.measure(pixel.light, pixel.mixed, rng);
    if (range_m > 0.0F && !pixel_bias_m_.empty()) range_m += pixel_bias_m_[i];
    const float depth_m = radial_ ? range_m : range_m * ray(i).z();
    image.depth_mm[i] = static_cast<std::int16_t>(depth_m * 1000.0F + 0.5F);
    image.confidence[i] = range_m > 0.0F ? SensorModel::confidence(pixel.light) : std::uint8_t{0};
    image.clean_geom[i] = range_m > 0.0F && !pixel.mixed ? pixel.geom : -1;
    image.true_range_m[i] = hits_[i].range_m;
  }
}

void HeadRenderer::find_edges() {
  const int width = pinhole().width_px;
  const int height = pinhole().height_px;
  std::fill(on_edge_.begin(), on_edge_.end(), std::uint8_t{0});
  const auto compare = [this](int i, int j) {
    if (is_edge(hits_[i], hits_[j])) on_edge_[i] = on_edge_[j] = 1;
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int i = y * width + x;
      if (x + 1 < width) compare(i, i + 1);
      if (y + 1 >= height) continue;
      compare(i, i + width);
      if (x + 1 < width) compare(i, i + width + 1);
      if (x > 0) compare(i, i + width - 1);
    }
  }
}

Return HeadRenderer::returned(const Hit& hit, const Vector3f& ray) const {
  if (hit.primitive < 0) return {};
  const Primitive& primitive = caster_.primitives()[hit.primitive];
  return {hit.range_m, primitive.reflectance * incidence_cosine(primitive, ray, hit.range_m)};
}

HeadRenderer::PixelLight HeadRenderer::light_of_ray(std::size_t pixel) const {
  const Hit& hit = hits_[pixel];
  PixelLight result;
  result.light = returned(hit, caster_.rays()[pixel]);
  if (hit.primitive >= 0) result.geom = caster_.primitives()[hit.primitive].geom;
  return result;
}

HeadRenderer::PixelLight HeadRenderer::light_of_edge(int x_px, int y_px) const {
  // Four rays; the range is the mean weighted with the light received, amplitude / range^2.
  PixelLight result;
  float weight_sum = 0.0F, range_sum = 0.0F, nearest_m = kMiss, farthest_m = 0.0F;
  for (const float dy : {-0.25F, 0.25F}) {
    for (const float dx : {-0.25F, 0.25F}) {
      const Vector3f ray =
          caster_.ray_through(static_cast<float>(x_px) + dx, static_cast<float>(y_px) + dy);
      const Hit hit = caster_.cast_near(x_px, y_px, ray);
      const Return part = returned(hit, ray);
      if (part.amplitude <= 0.0F) continue;
      const float weight = part.amplitude / (part.range_m * part.range_m);
      weight_sum += weight;
      range_sum += weight * part.range_m;
      result.light.amplitude += 0.25F * part.amplitude;
      if (part.range_m < nearest_m) result.geom = caster_.primitives()[hit.primitive].geom;
      nearest_m = std::min(nearest_m, part.range_m);
      farthest_m = std::max(farthest_m, part.range_m);
    }
  }
  if (!(weight_sum > 0.0F)) return {};
  result.light.range_m = range_sum / weight_sum;
  result.mixed = farthest_m - nearest_m > kEdgeStep_m;
  if (result.mixed) result.geom = -1;
  return result;
}

}  // namespace simulator
