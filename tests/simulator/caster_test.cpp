// SPDX-License-Identifier: BSD-3-Clause
// The ray caster against MuJoCo's own rays, and the culling against no culling.
#include "simulator/caster.h"

#include <cmath>
#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "base/rng.h"
#include "simulator/head_layout.h"
#include "simulator/world.h"

namespace simulator {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kDepthBound_m = 3e-4;
using RowMajor3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Vector3d random_direction(base::Rng& rng) {
  return Vector3d(rng.gaussian(), rng.gaussian(), rng.gaussian()).normalized();
}

Pinhole pico() {
  return Pinhole::from_field_of_view(224, 171, 62.0, 45.0);
}

/// A single geom with the head at the origin.
struct Alone {
  Primitive primitive;
  Vector3d center_m = Vector3d::Zero();
  RowMajor3d axes = RowMajor3d::Identity();
  Vector3d size_m = Vector3d::Zero();
  int type = mjGEOM_BOX;

  Alone(int geom_type, const Vector3d& center, const Eigen::Matrix3d& rotation,
        const Vector3d& size)
      : center_m(center), axes(rotation), size_m(size), type(geom_type) {
    primitive.kind = type == mjGEOM_PLANE      ? Primitive::Kind::kPlane
                     : type == mjGEOM_CYLINDER ? Primitive::Kind::kCylinder
                     : type == mjGEOM_BOX      ? Primitive::Kind::kBox
                                               : Primitive::Kind::kCapsule;
    primitive.center_m = center.cast<float>();
    primitive.R_head_geom = rotation.cast<float>();
    primitive.half_size_m = size.cast<float>();
    if (type == mjGEOM_SPHERE) primitive.half_size_m.y() = 0.0F;
  }

  /// kMiss or the distance, by MuJoCo.
  double oracle(const Vector3d& v) const {
    const Vector3d origin = Vector3d::Zero();
    const double range =
        mju_rayGeom(center_m.data(), axes.data(), size_m.data(), origin.data(), v.data(), type);
    return range < 0.0 ? static_cast<double>(kMiss) : range;
  }
  double range(const Vector3d& v) const {
    return static_cast<double>(range_along(primitive, v.cast<float>()));
  }
};

// Random bodies of each kind, seen from outside and from within: the same range as MuJoCo, or both
// miss; disagreement only where the ray grazes the surface.
TEST(Primitive, AgreesWithMuJoCo) {
  base::Rng rng(3);
  for (const int type : {mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_CYLINDER, mjGEOM_BOX}) {
    int num_hits = 0, num_disagreements = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vector3d size(0.01 + 0.1 * rng.uniform(), 0.02 + 0.5 * rng.uniform(),
                          0.01 + 0.3 * rng.uniform());
      const double reach = size.norm();
      const Eigen::Matrix3d rotation =
          Eigen::Quaterniond(rng.gaussian(), rng.gaussian(), rng.gaussian(), rng.gaussian())
              .normalized()
              .toRotationMatrix();
      const bool near = i % 4 == 0;  // often around or inside the body
      const Vector3d center =
          (near ? reach : 0.5 + 3.0 * rng.uniform()) * rng.uniform() * random_direction(rng);
      const Alone body(type, center, rotation, size);
      // Half of the rays are aimed at the body.
      const Vector3d aim = center + reach * rng.uniform() * random_direction(rng);
      const Vector3d v = i % 2 == 0 ? random_direction(rng) : aim.normalized();
      const double expected = body.oracle(v);
      const double actual = body.range(v);
      if (std::isfinite(expected)) ++num_hits;
      if (std::isfinite(expected) != std::isfinite(actual) ||
          (std::isfinite(expected) && std::abs(expected - actual) > kDepthBound_m)) {
        ++num_disagreements;
      }
    }
    EXPECT_GT(num_hits, 3000) << type;
    EXPECT_LE(num_disagreements, num_hits / 1000) << type;
  }
}

// A plane is seen from above alone; a ray parallel to it or away from it misses.
TEST(Primitive, PlaneFromAboveOnly) {
  const Alone floor(mjGEOM_PLANE, {0.0, 0.0, -0.5}, Eigen::Matrix3d::Identity(), {0.0, 0.0, 1.0});
  EXPECT_EQ(range_along(floor.primitive, Vector3f::UnitX()), kMiss);
  EXPECT_EQ(range_along(floor.primitive, Vector3f::UnitZ()), kMiss);
  EXPECT_FLOAT_EQ(range_along(floor.primitive, -Vector3f::UnitZ()), 0.5F);
  const Alone ceiling(mjGEOM_PLANE, {0.0, 0.0, 0.5}, Eigen::Matrix3d::Identity(), {0.0, 0.0, 1.0});
  EXPECT_EQ(range_along(ceiling.primitive, Vector3f::UnitZ()), kMiss);
}

// Rays exactly along an axis of a body divide by zero nowhere.
TEST(Primitive, RaysAlongTheAxes) {
  for (const int type : {mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_CYLINDER, mjGEOM_BOX}) {
    for (const Vector3d& v :
         {Vector3d(Vector3d::UnitX()), Vector3d(Vector3d::UnitY()), Vector3d(Vector3d::UnitZ())}) {
      for (const double aside : {0.0, 0.05, 0.0999, 0.1001, 0.3}) {
        const Vector3d center = 2.0 * v + aside * Vector3d(v.y(), v.z(), v.x());
        const Alone body(type, center, Eigen::Matrix3d::Identity(), {0.1, 0.2, 0.3});
        EXPECT_NEAR(std::min(body.range(v), 99.0), std::min(body.oracle(v), 99.0), kDepthBound_m)
            << type << " along " << v.transpose() << " aside " << aside;
      }
    }
  }
}

// The incidence is 1 head on and falls to 0 at the rim.
TEST(Primitive, IncidenceOfACapsule) {
  const Alone rung(mjGEOM_CAPSULE, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity(), {0.014, 0.2, 0.0});
  EXPECT_NEAR(incidence_cosine(rung.primitive, Vector3f::UnitX(), 0.986F), 1.0F, 1e-4F);
  const Vector3f rim = Vector3f(1.0F, 0.01399F, 0.0F).normalized();
  EXPECT_LT(incidence_cosine(rung.primitive, rim, range_along(rung.primitive, rim)), 0.1F);
}

// Without any geom nothing is hit, and nothing crashes.
TEST(Caster, EmptyWorld) {
  Caster caster(pico());
  caster.cull();
  std::vector<Hit> hits(caster.rays().size());
  caster.cast(hits);
  for (const Hit& hit : hits) ASSERT_EQ(hit.primitive, -1);
}

// A sensor of a single pixel is a tile, too.
TEST(Caster, OnePixel) {
  Caster caster(Pinhole::from_field_of_view(1, 1, 10.0, 10.0));
  caster.primitives().push_back(
      Alone(mjGEOM_SPHERE, {0.0, 0.0, 1.0}, Eigen::Matrix3d::Identity(), {0.1, 0.0, 0.0})
          .primitive);
  caster.cull();
  std::vector<Hit> hits(1);
  caster.cast(hits);
  EXPECT_NEAR(hits[0].range_m, 0.9F, 1e-6F);
}

class CasterInScene : public ::testing::TestWithParam<SceneName> {
 protected:
  CasterInScene() : world_(make_scene(params())) {}

  static SceneParams params() {
    SceneParams params;
    params.kind = GetParam().kind;
    params.yaw_deg = 15.0;
    return params;
  }
  /// Into the caster, for a head at that height.
  void look(Caster& caster, int head, double height_m) const {
    Eigen::Isometry3d T_world_body = Eigen::Isometry3d::Identity();
    T_world_body.translation() = Vector3d(0.0, 0.0, height_m);
    T_world_head_ = T_world_body * T_body_head(heads_still()[static_cast<std::size_t>(head)]);
    collect_primitives(world_.model(), world_.state(), T_world_head_, caster.primitives());
    caster.cull();
  }

  World world_;
  mutable Eigen::Isometry3d T_world_head_ = Eigen::Isometry3d::Identity();
};

// Culling changes no bit of any pixel, nor of the rays between pixels.
TEST_P(CasterInScene, CullingChangesNothing) {
  Caster caster(pico());
  std::vector<Hit> hits(caster.rays().size());
  for (int head = 0; head < kNumHeads; ++head) {
    look(caster, head, 0.55);
    caster.cast(hits);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Hit expected = caster.cast_unculled(caster.rays()[i]);
      ASSERT_EQ(hits[i].primitive, expected.primitive) << "head " << head << " pixel " << i;
      ASSERT_EQ(hits[i].range_m, expected.range_m);
      const int x = static_cast<int>(i) % 224, y = static_cast<int>(i) / 224;
      const Vector3f between =
          caster.ray_through(static_cast<float>(x) - 0.5F, static_cast<float>(y) + 0.5F);
      ASSERT_EQ(caster.cast_near(x, y, between).range_m, caster.cast_unculled(between).range_m);
    }
  }
}

// A whole image agrees with mj_ray: depth within 0.3 mm on the same geom, another geom on a few
// pixels at most, where two surfaces meet.
TEST_P(CasterInScene, AgreesWithMjRay) {
  Caster caster(pico());
  std::vector<Hit> hits(caster.rays().size());
  look(caster, 0, 0.55);
  caster.cast(hits);
  const Vector3d origin = T_world_head_.translation();
  constexpr double kFarthest_m = 8.0;  // the endless floor goes on to the horizon; heads see 4 m
  int num_other_geom = 0;
  double worst_m = 0.0;
  for (std::size_t i = 0; i < hits.size(); i += 3) {
    const Vector3d v = T_world_head_.linear() * caster.rays()[i].cast<double>();
    int geom = -1;
    const double expected =
        mj_ray(&world_.model(), &world_.state(), origin.data(), v.data(), nullptr, 1, -1, &geom);
    const int actual = hits[i].primitive < 0 ? -1 : caster.primitives()[hits[i].primitive].geom;
    if (actual != geom) {
      ++num_other_geom;
    } else if (geom >= 0 && expected < kFarthest_m) {
      worst_m = std::max(worst_m, std::abs(expected - static_cast<double>(hits[i].range_m)));
    }
  }
  EXPECT_LE(num_other_geom, 40);
  EXPECT_LE(worst_m, kDepthBound_m);
}

// A head inside a solid (the lower wall, the floor, a box) still gives an image.
TEST_P(CasterInScene, HeadInsideSolids) {
  Caster caster(pico());
  std::vector<Hit> hits(caster.rays().size());
  for (const double height_m : {0.0, -0.5, 2.5}) {
    look(caster, 2, height_m);
    caster.cast(hits);
    for (std::size_t i = 0; i < hits.size(); i += 7) {
      ASSERT_EQ(hits[i].range_m, caster.cast_unculled(caster.rays()[i]).range_m);
      ASSERT_GE(hits[i].range_m, 0.0F);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CasterInScene, ::testing::ValuesIn(kSceneNames),
                         [](const auto& kind) { return std::string(kind.param.name); });

}  // namespace
}  // namespace simulator
