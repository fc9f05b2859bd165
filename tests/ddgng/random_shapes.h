// SPDX-License-Identifier: BSD-3-Clause
// Random points of awkward distributions, shared by the tests of the growing part.
#pragma once

#include <Eigen/Core>

#include "base/rng.h"

namespace ddgng {

enum class Shape { kUniform, kClusters, kDuplicates, kCollinear, kLattice, kIdentical };

inline constexpr Shape kShapes[] = {Shape::kUniform,   Shape::kClusters, Shape::kDuplicates,
                                    Shape::kCollinear, Shape::kLattice,  Shape::kIdentical};

inline Eigen::Vector3f random_point(Shape shape, base::Rng& rng) {
  const auto u = [&rng] { return static_cast<float>(rng.uniform()); };
  const auto whole = [&rng](std::uint32_t below) { return static_cast<float>(rng.below(below)); };
  switch (shape) {
    case Shape::kUniform: {
      const float x = 4 * u();
      const float y = 4 * u();
      return {x, y, 4 * u()};
    }
    case Shape::kClusters: {
      const float c = whole(4);
      const float x = c + 0.01F * u();
      const float y = 0.01F * u() - c;
      return {x, y, 0.001F * u()};
    }
    case Shape::kDuplicates: {
      const float c = whole(5);
      return {c, 0.5F * c, -c};
    }
    case Shape::kCollinear:
      return {u(), 0.0F, 1.0F};
    case Shape::kLattice: {  // many exact ties
      const float x = whole(4);
      const float y = whole(4);
      return {x, y, whole(4)};
    }
    case Shape::kIdentical:
      break;
  }
  return {1.0F, 2.0F, 3.0F};
}

}  // namespace ddgng
