// SPDX-License-Identifier: BSD-3-Clause
// One ray per pixel against all primitives, made fast by culling: a tile of 16 x 16 pixels is a
// cone, and only primitives whose bounding spheres touch the cone are tried. Culled and unculled
// images are equal bit for bit.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "simulator/primitive.h"

namespace simulator {

/// Pinhole model; pixel centres at integers, x right, y down, z forward.
struct Pinhole {
  int width_px = 224;
  int height_px = 171;
  double fx_px = 0.0, fy_px = 0.0, cx_px = 0.0, cy_px = 0.0;

  /// Fields of view in degrees, principal point in the middle.
  static Pinhole from_field_of_view(int width_px, int height_px, double horizontal_deg,
                                    double vertical_deg);
  std::size_t num_pixels() const {
    return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px);
  }
};

struct Hit {
  float range_m = kMiss;
  int primitive = -1;  ///< index into Caster::primitives(), -1 = nothing
};

class Caster {
 public:
  static constexpr int kTile_px = 16;

  explicit Caster(const Pinhole& pinhole);

  const Pinhole& pinhole() const { return pinhole_; }
  /// Unit rays, row by row.
  const std::vector<Eigen::Vector3f>& rays() const { return rays_; }
  /// Unit ray through a point between the pixel centres.
  Eigen::Vector3f ray_through(float x_px, float y_px) const;

  /// The geometry of this frame in the head's frame; after changing it call cull().
  std::vector<Primitive>& primitives() { return primitives_; }
  const std::vector<Primitive>& primitives() const { return primitives_; }
  void cull();

  /// hits: one per pixel. cull() first.
  void cast(std::span<Hit> hits) const;
  /// One ray within half a pixel of pixel (x, y), against that pixel's tile.
  Hit cast_near(int x_px, int y_px, const Eigen::Vector3f& ray) const;
  /// One ray against everything: slow, the oracle.
  Hit cast_unculled(const Eigen::Vector3f& ray) const;

 private:
  struct Cone {
    Eigen::Vector3f axis;
    float cosine, sine;  ///< of the half angle
  };
  /// Spheres in a row along a primitive's longest axis, which together contain it.
  struct SphereChain {
    Eigen::Vector3f first, step;
    int num_spheres = 1;
    float radius_m = kMiss;  ///< kMiss = everywhere
  };

  static SphereChain chain_around(const Primitive& primitive);
  static bool touches(const Cone& cone, const SphereChain& chain);
  int tile_of(int x_px, int y_px) const {
    return (y_px / kTile_px) * tiles_across_ + x_px / kTile_px;
  }
  std::span<const int> candidates(int tile) const;
  Hit nearest(std::span<const int> candidates, const Eigen::Vector3f& ray) const;

  Pinhole pinhole_;
  float inverse_fx_, inverse_fy_, cx_px_, cy_px_;
  int tiles_across_ = 0;
  std::vector<Eigen::Vector3f> rays_;
  std::vector<Cone> cones_;  ///< one per tile
  std::vector<Primitive> primitives_;
  std::vector<int> candidates_;       ///< primitive indices of all tiles in a row
  std::vector<int> candidate_begin_;  ///< per tile, and one more
};

}  // namespace simulator
