// SPDX-License-Identifier: BSD-3-Clause
// A room for tests and benchmarks: floor 4 x 4 m, wall, ladder (2 rails, 7 rungs) 1 m before the
// wall; points with 3 mm noise, in random order. One head looks at the ladder from 1.2 m.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/rng.h"
#include "ddgng/cloud.h"

namespace ddgng {

struct Room {
  std::vector<float> x_m, y_m, z_m;
  std::vector<std::uint8_t> head;

  CloudView view(std::uint64_t sequence) const {
    CloudView cloud;
    cloud.x_m = x_m;
    cloud.y_m = y_m;
    cloud.z_m = z_m;
    cloud.head = head;
    cloud.head_position_m.fill({0.0F, 0.0F, 0.6F});
    cloud.head_valid = {true, true, true, true};
    cloud.time_step_s = sequence == 0 ? 0.0F : 0.1F;
    cloud.sequence = sequence;
    return cloud;
  }
};

inline constexpr double kLadderX_m = 1.2;
inline constexpr double kRailY_m = 0.225;

inline bool on_ladder(const Eigen::Vector3f& p) {
  return std::abs(p.x() - 1.2F) < 0.06F && std::abs(p.y()) < 0.29F && p.z() > 0.15F;
}

class RoomBuilder {
 public:
  explicit RoomBuilder(std::uint64_t seed) : rng_(seed) {}

  /// 40 % floor, 1/3 wall, the rest half rails (r = 20 mm), half rungs (r = 15 mm).
  Room build(int num_points, bool with_ladder = true) {
    const auto share = [num_points](double part) { return static_cast<int>(part * num_points); };
    for (int i = 0; i < share(6.0 / 15); ++i) {  // one draw per line: compilers differ in order
      const double y = u() * 4 - 2;
      add(u() * 4 - 1.8, y, 0.0);
    }
    for (int i = 0; i < share(5.0 / 15); ++i) {
      const double z = u() * 2.5;
      add(2.2, u() * 4 - 2, z);
    }
    for (int i = 0; with_ladder && i < share(2.0 / 15); ++i) {
      const auto [c, s] = circle();
      const double y = rng_.below(2) == 0 ? -kRailY_m : kRailY_m;
      add(kLadderX_m + 0.020 * c, y + 0.020 * s, u() * 2.2);
    }
    for (int i = 0; with_ladder && i < share(2.0 / 15); ++i) {
      const auto [c, s] = circle();
      const double height = 0.25 + 0.3 * rng_.below(7);
      add(kLadderX_m + 0.015 * c, (2 * u() - 1) * kRailY_m, height + 0.015 * s);
    }
    shuffle();
    return std::move(room_);
  }

 private:
  double u() { return rng_.uniform(); }

  std::pair<double, double> circle() {
    for (;;) {
      const double x = 2 * u() - 1;
      const double y = 2 * u() - 1;
      const double r = std::sqrt(x * x + y * y);
      if (r > 0.1 && r <= 1.0) return {x / r, y / r};
    }
  }

  void add(double x, double y, double z) {
    constexpr double kNoise_m = 0.003;
    room_.x_m.push_back(static_cast<float>(x + kNoise_m * rng_.gaussian()));
    room_.y_m.push_back(static_cast<float>(y + kNoise_m * rng_.gaussian()));
    room_.z_m.push_back(static_cast<float>(z + kNoise_m * rng_.gaussian()));
    room_.head.push_back(static_cast<std::uint8_t>(rng_.below(kNumHeads)));
  }

  void shuffle() {
    for (std::size_t i = room_.x_m.size(); i > 1; --i) {
      const std::size_t j = rng_.below(static_cast<std::uint32_t>(i));
      std::swap(room_.x_m[i - 1], room_.x_m[j]);
      std::swap(room_.y_m[i - 1], room_.y_m[j]);
      std::swap(room_.z_m[i - 1], room_.z_m[j]);
      std::swap(room_.head[i - 1], room_.head[j]);
    }
  }

  base::Rng rng_;
  Room room_;
};

}  // namespace ddgng
