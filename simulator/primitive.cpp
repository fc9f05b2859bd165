// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/primitive.h"

#include <algorithm>
#include <cmath>

namespace simulator {
namespace {

using Eigen::Vector3f;

constexpr float kParallel = 1e-9F;

/// The part of the ray inside a convex body.
struct Interval {
  float enter = -kMiss;
  float leave = kMiss;
};

float first_surface(const Interval& inside) {
  if (inside.enter > inside.leave || inside.leave < 0.0F) return kMiss;
  return inside.enter >= 0.0F ? inside.enter : inside.leave;
}

/// |offset + t * speed| <= half
void clip_slab(float offset, float speed, float half, Interval& inside) {
  if (std::abs(speed) < kParallel) {
    if (std::abs(offset) > half) inside.enter = kMiss;
    return;
  }
  const float a = (-half - offset) / speed;
  const float b = (half - offset) / speed;
  inside.enter = std::max(inside.enter, std::min(a, b));
  inside.leave = std::min(inside.leave, std::max(a, b));
}

float plane_range(const Primitive& plane, const Vector3f& v) {
  const float downward = v.dot(plane.axis());
  if (downward >= 0.0F) return kMiss;
  const float range = plane.center_m.dot(plane.axis()) / downward;
  if (!(range >= 0.0F)) return kMiss;
  const Vector3f hit = plane.R_head_geom.transpose() * (range * v - plane.center_m);
  for (int k = 0; k < 2; ++k) {
    if (plane.half_size_m[k] > 0.0F && std::abs(hit[k]) > plane.half_size_m[k]) return kMiss;
  }
  return range;
}

float box_range(const Primitive& box, const Vector3f& v) {
  const Vector3f offset = -(box.R_head_geom.transpose() * box.center_m);
  const Vector3f speed = box.R_head_geom.transpose() * v;
  Interval inside;
  for (int k = 0; k < 3; ++k) clip_slab(offset[k], speed[k], box.half_size_m[k], inside);
  return first_surface(inside);
}

/// A ray in the coordinates of a round body, starting from its point next to the body's centre, so
/// that only small numbers are subtracted from each other.
struct NearRay {
  float start = 0.0F;         ///< range of that point
  Vector3f offset, v;         ///< from the centre; direction
  float along, along_speed;   ///< offset and v along the axis
  Vector3f across, sideways;  ///< offset and v across the axis

  NearRay(const Primitive& body, const Vector3f& direction)
      : start(body.center_m.dot(direction)),
        offset(start * direction - body.center_m),
        v(direction),
        along(offset.dot(body.axis())),
        along_speed(v.dot(body.axis())),
        across(offset - along * body.axis()),
        sideways(v - along_speed * body.axis()) {}
};

/// Where the ray is within radius of the infinite axis.
Interval infinite_cylinder(const NearRay& ray, float radius) {
  const float a = ray.sideways.squaredNorm();
  const float c = ray.across.squaredNorm() - radius * radius;
  if (a < kParallel) return c > 0.0F ? Interval{kMiss, -kMiss} : Interval{};
  const float b = ray.across.dot(ray.sideways);
  const float discriminant = b * b - a * c;
  if (discriminant < 0.0F) return {kMiss, -kMiss};
  const float root = std::sqrt(discriminant);
  return {(-b - root) / a, (-b + root) / a};
}

float cylinder_range(const Primitive& cylinder, const Vector3f& v) {
  const NearRay ray(cylinder, v);
  Interval inside = infinite_cylinder(ray, cylinder.half_size_m.x());
  if (inside.enter > inside.leave) return kMiss;
  clip_slab(ray.along, ray.along_speed, cylinder.half_length_m(), inside);
  return first_surface({ray.start + inside.enter, ray.start + inside.leave});
}

/// Where the ray is inside the cap's sphere at `height` on the axis.
Interval cap(const NearRay& ray, const Primitive& capsule, float height) {
  const Vector3f offset = ray.offset - height * capsule.axis();
  const float radius = capsule.half_size_m.x();
  const float b = offset.dot(ray.v);
  const Vector3f nearest = offset - b * ray.v;
  const float discriminant = radius * radius - nearest.squaredNorm();
  if (discriminant < 0.0F) return {kMiss, -kMiss};
  const float root = std::sqrt(discriminant);
  return {-b - root, -b + root};
}

float capsule_range(const Primitive& capsule, const Vector3f& v) {
  const NearRay ray(capsule, v);
  Interval inside = infinite_cylinder(ray, capsule.half_size_m.x());
  if (inside.enter > inside.leave) return kMiss;
  // Where an end of the stretch lies beyond the axis' end, the cap's sphere bounds it instead.
  const float half = capsule.half_length_m();
  const float toward = ray.along_speed > 0.0F ? 1.0F : -1.0F;
  const float z_enter =
      inside.enter == -kMiss ? -toward * kMiss : ray.along + inside.enter * ray.along_speed;
  const float z_leave =
      inside.leave == kMiss ? toward * kMiss : ray.along + inside.leave * ray.along_speed;
  if (std::abs(z_enter) > half) inside.enter = cap(ray, capsule, z_enter > 0 ? half : -half).enter;
  if (std::abs(z_leave) > half) inside.leave = cap(ray, capsule, z_leave > 0 ? half : -half).leave;
  return first_surface({ray.start + inside.enter, ray.start + inside.leave});
}

bool supported(int type) {
  return type == mjGEOM_PLANE || type == mjGEOM_SPHERE || type == mjGEOM_CAPSULE ||
         type == mjGEOM_CYLINDER || type == mjGEOM_BOX;
}

Primitive::Kind kind_of(int type) {
  if (type == mjGEOM_PLANE) return Primitive::Kind::kPlane;
  if (type == mjGEOM_CYLINDER) return Primitive::Kind::kCylinder;
  if (type == mjGEOM_BOX) return Primitive::Kind::kBox;
  return Primitive::Kind::kCapsule;
}

}  // namespace

float range_along(const Primitive& primitive, const Vector3f& v) {
  switch (primitive.kind) {
    case Primitive::Kind::kPlane:
      return plane_range(primitive, v);
    case Primitive::Kind::kCapsule:
      return capsule_range(primitive, v);
    case Primitive::Kind::kCylinder:
      return cylinder_range(primitive, v);
    case Primitive::Kind::kBox:
      return box_range(primitive, v);
  }
  return kMiss;
}

float incidence_cosine(const Primitive& primitive, const Vector3f& v, float range_m) {
  if (primitive.kind == Primitive::Kind::kPlane) return std::abs(v.dot(primitive.axis()));
  const Vector3f hit = range_m * v - primitive.center_m;
  if (primitive.kind == Primitive::Kind::kBox) {
    const Vector3f local =
        (primitive.R_head_geom.transpose() * hit).cwiseAbs().cwiseQuotient(primitive.half_size_m);
    int face = 0;
    local.maxCoeff(&face);
    return std::abs(v.dot(primitive.R_head_geom.col(face)));
  }
  const float height = hit.dot(primitive.axis());
  const float half = primitive.half_length_m();
  constexpr float kOnCap_m = 1e-5F;
  if (primitive.kind == Primitive::Kind::kCylinder && std::abs(height) >= half - kOnCap_m) {
    return std::abs(v.dot(primitive.axis()));
  }
  const Vector3f normal = hit - std::clamp(height, -half, half) * primitive.axis();
  return std::min(1.0F, std::abs(v.dot(normal)) / primitive.half_size_m.x());
}

void collect_primitives(const mjModel& model, const mjData& state,
                        const Eigen::Isometry3d& T_world_head, std::vector<Primitive>& primitives) {
  using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Isometry3d T_head_world = T_world_head.inverse();
  primitives.clear();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (!supported(model.geom_type[geom]) || model.geom_rgba[4 * geom + 3] == 0.0F) continue;
    Primitive primitive;
    primitive.kind = kind_of(model.geom_type[geom]);
    primitive.geom = geom;
    primitive.reflectance = model.geom_rgba[4 * geom];
    const Eigen::Vector3d center(Eigen::Map<const Eigen::Vector3d>(state.geom_xpos + 3 * geom));
    const Eigen::Matrix3d axes(Eigen::Map<const RowMajor3d>(state.geom_xmat + 9 * geom));
    primitive.center_m = (T_head_world * center).cast<float>();
    primitive.R_head_geom = (T_head_world.linear() * axes).cast<float>();
    const Eigen::Vector3d size(Eigen::Map<const Eigen::Vector3d>(model.geom_size + 3 * geom));
    primitive.half_size_m = size.cast<float>();
    if (model.geom_type[geom] == mjGEOM_SPHERE) primitive.half_size_m.y() = 0.0F;
    primitives.push_back(primitive);
  }
}

}  // namespace simulator
