// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/caster.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/check.h"

namespace simulator {

using Eigen::Vector3f;

Pinhole Pinhole::from_field_of_view(int width_px, int height_px, double horizontal_deg,
                                    double vertical_deg) {
  const auto focal_px = [](int size_px, double angle_deg) {
    return 0.5 * size_px / std::tan(0.5 * angle_deg * std::numbers::pi / 180.0);
  };
  Pinhole pinhole;
  pinhole.width_px = width_px;
  pinhole.height_px = height_px;
  pinhole.fx_px = focal_px(width_px, horizontal_deg);
  pinhole.fy_px = focal_px(height_px, vertical_deg);
  pinhole.cx_px = 0.5 * (width_px - 1);
  pinhole.cy_px = 0.5 * (height_px - 1);
  return pinhole;
}

Caster::Caster(const Pinhole& pinhole)
    : pinhole_(pinhole),
      inverse_fx_(static_cast<float>(1.0 / pinhole.fx_px)),
      inverse_fy_(static_cast<float>(1.0 / pinhole.fy_px)),
      cx_px_(static_cast<float>(pinhole.cx_px)),
      cy_px_(static_cast<float>(pinhole.cy_px)),
      tiles_across_((pinhole.width_px + kTile_px - 1) / kTile_px) {
  CHECK(pinhole.width_px > 0 && pinhole.height_px > 0, "a head has pixels");
  rays_.reserve(pinhole.num_pixels());
  for (int y = 0; y < pinhole.height_px; ++y) {
    for (int x = 0; x < pinhole.width_px; ++x) {
      rays_.push_back(ray_through(static_cast<float>(x), static_cast<float>(y)));
    }
  }
  // The rays of a tile lie within the cone through its corners, half a pixel further out for the
  // rays between pixel centres.
  for (int top = 0; top < pinhole.height_px; top += kTile_px) {
    for (int left = 0; left < pinhole.width_px; left += kTile_px) {
      const auto x0 = static_cast<float>(left) - 0.5F;
      const auto y0 = static_cast<float>(top) - 0.5F;
      const auto x1 = static_cast<float>(std::min(left + kTile_px, pinhole.width_px)) - 0.5F;
      const auto y1 = static_cast<float>(std::min(top + kTile_px, pinhole.height_px)) - 0.5F;
      Cone cone;
      cone.axis = ray_through(0.5F * (x0 + x1), 0.5F * (y0 + y1));
      cone.cosine = 1.0F;
      for (const float x : {x0, x1}) {
        for (const float y : {y0, y1}) {
          cone.cosine = std::min(cone.cosine, cone.axis.dot(ray_through(x, y)));
        }
      }
      cone.cosine -= 1e-4F;  // far more than rounding
      cone.sine = std::sqrt(1.0F - cone.cosine * cone.cosine);
      cones_.push_back(cone);
    }
  }
}

Vector3f Caster::ray_through(float x_px, float y_px) const {
  const Vector3f v((x_px - cx_px_) * inverse_fx_, (y_px - cy_px_) * inverse_fy_, 1.0F);
  return v / std::sqrt(v.squaredNorm());
}

Caster::SphereChain Caster::chain_around(const Primitive& primitive) {
  SphereChain chain;
  if (primitive.kind == Primitive::Kind::kPlane) return chain;
  constexpr float kSlack = 1.001F;
  Vector3f half = primitive.half_size_m;
  int longest = 2;
  if (primitive.kind == Primitive::Kind::kBox) {
    half.maxCoeff(&longest);
  } else {
    const float radius = half.x();
    const float cap = primitive.kind == Primitive::Kind::kCapsule ? radius : 0.0F;
    half = {radius, 0.0F, primitive.half_length_m() + cap};
  }
  const float length = half[longest];
  half[longest] = 0.0F;
  const float thickness = half.norm();
  chain.num_spheres =
      std::clamp(static_cast<int>(std::ceil(length / std::max(2.0F * thickness, 0.05F))), 1, 64);
  const float half_step = length / static_cast<float>(chain.num_spheres);
  chain.radius_m = kSlack * std::sqrt(half_step * half_step + thickness * thickness);
  const Vector3f axis = primitive.R_head_geom.col(longest);
  chain.first = primitive.center_m - (length - half_step) * axis;
  chain.step = 2.0F * half_step * axis;
  return chain;
}

bool Caster::touches(const Cone& cone, const SphereChain& chain) {
  if (chain.radius_m == kMiss) return true;
  Vector3f center = chain.first;
  for (int i = 0; i < chain.num_spheres; ++i, center += chain.step) {
    const float square = center.squaredNorm();
    if (square <= chain.radius_m * chain.radius_m) return true;
    // The angle from the cone's axis to the centre is at most half angle plus apparent radius.
    const float distance = std::sqrt(square);
    const float sine = chain.radius_m / distance;
    const float cosine = std::sqrt(1.0F - sine * sine);
    if (center.dot(cone.axis) >= distance * (cone.cosine * cosine - cone.sine * sine)) return true;
  }
  return false;
}

void Caster::cull() {
  std::vector<SphereChain> chains;
  chains.reserve(primitives_.size());
  for (const Primitive& primitive : primitives_) chains.push_back(chain_around(primitive));
  candidates_.clear();
  candidate_begin_.clear();
  for (const Cone& cone : cones_) {
    candidate_begin_.push_back(static_cast<int>(candidates_.size()));
    for (std::size_t i = 0; i < chains.size(); ++i) {
      if (touches(cone, chains[i])) candidates_.push_back(static_cast<int>(i));
    }
  }
  candidate_begin_.push_back(static_cast<int>(candidates_.size()));
}

std::span<const int> Caster::candidates(int tile) const {
  return std::span(candidates_)
      .subspan(static_cast<std::size_t>(candidate_begin_[tile]),
               static_cast<std::size_t>(candidate_begin_[tile + 1] - candidate_begin_[tile]));
}

Hit Caster::nearest(std::span<const int> candidates, const Vector3f& ray) const {
  Hit hit;
  for (const int i : candidates) {
    const float range = range_along(primitives_[i], ray);
    if (range < hit.range_m) hit = {range, i};
  }
  return hit;
}

void Caster::cast(std::span<Hit> hits) const {
  CHECK(hits.size() == rays_.size(), "one hit per pixel");
  CHECK(candidate_begin_.size() == cones_.size() + 1, "cull() comes before cast()");
  for (int y = 0; y < pinhole_.height_px; ++y) {
    for (int left = 0; left < pinhole_.width_px; left += kTile_px) {
      const auto tried = candidates(tile_of(left, y));
      const int right = std::min(left + kTile_px, pinhole_.width_px);
      for (int x = left; x < right; ++x) {
        const auto i = static_cast<std::size_t>(y * pinhole_.width_px + x);
        hits[i] = nearest(tried, rays_[i]);
      }
    }
  }
}

Hit Caster::cast_near(int x_px, int y_px, const Vector3f& ray) const {
  return nearest(candidates(tile_of(x_px, y_px)), ray);
}

Hit Caster::cast_unculled(const Vector3f& ray) const {
  Hit hit;
  for (std::size_t i = 0; i < primitives_.size(); ++i) {
    const float range = range_along(primitives_[i], ray);
    if (range < hit.range_m) hit = {range, static_cast<int>(i)};
  }
  return hit;
}

}  // namespace simulator
