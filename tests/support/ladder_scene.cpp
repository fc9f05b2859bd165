// SPDX-License-Identifier: BSD-3-Clause
#include "tests/support/ladder_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <Eigen/Geometry>

namespace test_support {
namespace {

using Eigen::Vector3d;

const std::array<Vector3d, ladder::kNumHeads> kHeads_m = {
    Vector3d(0.0, 0.04, 0.57), Vector3d(0.0, -0.04, 0.57), Vector3d(0.0, 0.04, 0.53),
    Vector3d(0.0, -0.04, 0.53)};

struct Point {
  Vector3d position_m;
  int head = 0;
  int plane = -1;
};

Vector3d point_on(const Surface& s, const Vector3d& head_m, base::Rng& rng) {
  const Vector3d on_axis = s.end0_m + rng.uniform() * (s.end1_m - s.end0_m);
  const double y_m = (rng.uniform() - 0.5) * s.height_m;
  if (!s.is_round) return on_axis + y_m * s.across;
  const Vector3d d = (s.end1_m - s.end0_m).normalized();
  const Vector3d ray = (on_axis - head_m).normalized();
  const Vector3d depth = (ray - ray.dot(d) * d).normalized();
  const double radius_m = 0.5 * s.height_m;
  return on_axis + y_m * d.cross(depth) - std::sqrt(radius_m * radius_m - y_m * y_m) * depth;
}

std::vector<Point> draw_points(const std::vector<Surface>& surfaces, const LadderScene& scene,
                               base::Rng& rng) {
  std::vector<Point> points;
  for (const Surface& s : surfaces) {
    const double area_m2 = (s.end1_m - s.end0_m).norm() * s.height_m;
    const double per_m2 = s.plane < 0 ? scene.points_per_m2 : 0.05 * scene.points_per_m2;
    for (int i = 0; i < static_cast<int>(s.density * area_m2 * per_m2); ++i) {
      Point point;
      point.head = static_cast<int>(rng.below(ladder::kNumHeads));
      point.plane = s.plane;
      const Vector3d& head_m = kHeads_m[point.head];
      const Vector3d exact = point_on(s, head_m, rng);
      const Vector3d ray = (exact - head_m).normalized();
      point.position_m = exact + scene.noise_sigma_m * rng.gaussian() * ray;
      points.push_back(point);
    }
  }
  return points;
}

using Cell = std::array<int, 3>;

Cell cell_of(const Vector3d& p, double size_m) {
  return {static_cast<int>(std::floor(p.x() / size_m)),
          static_cast<int>(std::floor(p.y() / size_m)),
          static_cast<int>(std::floor(p.z() / size_m))};
}

/// Nodes at some of the points, none nearer to each other than the spacing (on planes five times
/// it); in order of height.
std::vector<Point> draw_nodes(const std::vector<Point>& points, double spacing_m) {
  std::vector<Point> nodes;
  std::array<std::map<Cell, std::vector<Vector3d>>, 2> taken;  // off planes, on planes
  for (const Point& point : points) {
    auto& cells = taken[point.plane < 0 ? 0 : 1];
    const double apart_m = point.plane < 0 ? spacing_m : 5.0 * spacing_m;
    const Cell center = cell_of(point.position_m, apart_m);
    bool is_crowded = false;
    for (int i = 0; i < 27 && !is_crowded; ++i) {
      const Cell cell = {center[0] + i % 3 - 1, center[1] + i / 3 % 3 - 1, center[2] + i / 9 - 1};
      const auto found = cells.find(cell);
      if (found == cells.end()) continue;
      is_crowded = std::any_of(found->second.begin(), found->second.end(), [&](const Vector3d& p) {
        return (p - point.position_m).squaredNorm() < apart_m * apart_m;
      });
    }
    if (is_crowded) continue;
    cells[center].push_back(point.position_m);
    nodes.push_back(point);
  }
  std::sort(nodes.begin(), nodes.end(),
            [](const Point& a, const Point& b) { return a.position_m.z() < b.position_m.z(); });
  return nodes;
}

/// The two nodes nearest to p, second = -1 when there is one only. Nodes in order of height: looks
/// up and down until the height alone is too far.
std::pair<int, int> nearest_two(const std::vector<Point>& nodes, const Vector3d& p) {
  constexpr double kFar = std::numeric_limits<double>::max();
  int first = -1, second = -1;
  double first_m2 = kFar, second_m2 = kFar;
  const auto look = [&](int i) {
    const double d_m2 = (nodes[i].position_m - p).squaredNorm();
    if (d_m2 < first_m2) {
      second = std::exchange(first, i);
      second_m2 = std::exchange(first_m2, d_m2);
    } else if (d_m2 < second_m2) {
      second = i;
      second_m2 = d_m2;
    }
  };
  const auto in_reach = [&](int i) {
    const double dz_m = nodes[i].position_m.z() - p.z();
    return dz_m * dz_m < second_m2;
  };
  const auto above =
      std::lower_bound(nodes.begin(), nodes.end(), p.z(),
                       [](const Point& node, double z_m) { return node.position_m.z() < z_m; });
  int up = static_cast<int>(above - nodes.begin());
  int down = up - 1;
  const int num_nodes = static_cast<int>(nodes.size());
  bool goes_on = true;
  while (goes_on) {
    goes_on = false;
    if (up < num_nodes && in_reach(up)) goes_on = (look(up++), true);
    if (down >= 0 && in_reach(down)) goes_on = (look(down--), true);
  }
  return {first, second};
}

struct Sum {
  double n = 0.0;
  Vector3d s = Vector3d::Zero();
  Eigen::Matrix3d ss = Eigen::Matrix3d::Zero();
};

ladder::HeadMoment to_moment(int node, int head, const Sum& sum) {
  const Vector3d mean = sum.s / sum.n;
  const Eigen::Matrix3f c = (sum.ss / sum.n - mean * mean.transpose()).cast<float>();
  ladder::HeadMoment m;
  m.node = node;
  m.head = head;
  m.weight = static_cast<float>(sum.n);
  m.mean_m = mean.cast<float>();
  m.xx_m2 = c(0, 0);
  m.xy_m2 = c(0, 1);
  m.xz_m2 = c(0, 2);
  m.yy_m2 = c(1, 1);
  m.yz_m2 = c(1, 2);
  m.zz_m2 = c(2, 2);
  return m;
}

}  // namespace

void LadderScene::add_bar(const Vector3d& end0_m, const Vector3d& end1_m, double diameter_m) {
  surfaces_.push_back({end0_m, end1_m, Vector3d::UnitZ(), diameter_m, true, -1});
}

void LadderScene::add_board(const Vector3d& end0_m, const Vector3d& end1_m, double height_m) {
  surfaces_.push_back({end0_m, end1_m, Vector3d::UnitZ(), height_m, false, -1});
}

void LadderScene::add_shelf_board(const Vector3d& end0_m, const Vector3d& end1_m, double depth_m) {
  const Vector3d away = (end0_m - end1_m).cross(Vector3d::UnitZ()).normalized();
  const Vector3d half = 0.5 * depth_m * away;
  surfaces_.push_back({end0_m + half, end1_m + half, away, depth_m, false, -1});
}

void LadderScene::add_tread(const Vector3d& end0_m, const Vector3d& end1_m, double height_m,
                            double depth_m) {
  add_board(end0_m, end1_m, height_m);
  const Vector3d view = 0.5 * (end0_m + end1_m) - kHeads_m[0];
  const Vector3d seen_face(0.0, 0.0, std::copysign(0.5 * height_m, -view.z()));
  add_shelf_board(end0_m + seen_face, end1_m + seen_face, depth_m);
  surfaces_.back().density = std::abs(view.z()) / std::hypot(view.x(), view.y());
}

void LadderScene::add_front(double x_m, double half_width_m, double from_z_m, double to_z_m,
                            bool as_plane) {
  const double z_m = 0.5 * (from_z_m + to_z_m);
  const int plane = as_plane ? num_planes_++ : -1;
  surfaces_.push_back({{x_m, half_width_m, z_m},
                       {x_m, -half_width_m, z_m},
                       Vector3d::UnitZ(),
                       to_z_m - from_z_m,
                       false,
                       plane});
}

void LadderScene::add_stairs(double x_m, int num_steps) {
  for (int i = 0; i < num_steps; ++i) {
    const double x = x_m + 0.25 * i;
    const double z_m = 0.19 * (i + 1);
    add_board({x, 0.45, z_m}, {x, -0.45, z_m}, 0.08);
  }
}

void LadderScene::add_shelf(double x_m) {
  for (const double y_m : {0.3, -0.3}) {
    surfaces_.push_back({{x_m, y_m, 0.1}, {x_m, y_m, 2.0}, Vector3d::UnitY(), 0.02, false, -1});
  }
  for (int i = 0; i < 6; ++i) {
    const double z_m = 0.2 + 0.33 * i;
    add_board({x_m, 0.3, z_m}, {x_m, -0.3, z_m}, 0.02);
    add_shelf_board({x_m, 0.3, z_m + 0.01}, {x_m, -0.3, z_m + 0.01}, 0.25);
  }
}

void LadderScene::add_ladder(const LadderShape& shape) {
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(shape.yaw_rad, Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(shape.tilt_rad, Vector3d::UnitY()))
                                   .toRotationMatrix();
  const Vector3d foot(shape.distance_m, 0.0, 0.0);
  const auto at = [&](double y_m, double z_m) -> Vector3d {
    return foot + turn * Vector3d(0.0, y_m, z_m);
  };
  const double half_m = 0.5 * shape.clear_width_m;
  const double top_m = shape.first_height_m + shape.spacing_m * (shape.num_rungs - 1) + 0.15;
  const double rail_m = half_m + 0.5 * shape.rail_width_m;
  for (const double y_m : {rail_m, -rail_m}) {
    surfaces_.push_back({at(y_m, 0.1), at(y_m, top_m), turn.col(1), shape.rail_width_m, false, -1});
  }
  for (int i = 0; i < shape.num_rungs; ++i) {
    if (i == shape.missing_rung) continue;
    const double z_m = shape.first_height_m + shape.spacing_m * i;
    const Vector3d left = at(half_m, z_m);
    const Vector3d right = at(-half_m, z_m);
    const bool is_damaged = i == shape.stub_rung || i == shape.bent_rung || i == shape.tilted_rung;
    truth.push_back({left, right, !is_damaged});
    if (shape.tread_depth_m > 0.0) {
      add_tread(left, right, shape.rung_diameter_m, shape.tread_depth_m);
    } else if (i == shape.stub_rung) {
      add_bar(left, at(-0.2 * half_m, z_m), shape.rung_diameter_m);
    } else if (i == shape.tilted_rung) {
      add_bar(left, at(-half_m, z_m - 0.05), shape.rung_diameter_m);
    } else if (i == shape.bent_rung) {
      constexpr int kPieces = 8;
      const auto bent = [&](double u) {
        const double sag_m = 0.05 * 4.0 * u * (1.0 - u);
        return at(half_m * (1.0 - 2.0 * u), z_m - 0.07 * u - sag_m);
      };
      for (int k = 0; k < kPieces; ++k) {
        add_bar(bent(1.0 * k / kPieces), bent((k + 1.0) / kPieces), shape.rung_diameter_m);
      }
    } else {
      add_bar(left, right, shape.rung_diameter_m);
    }
  }
}

ladder::NodeCloud LadderScene::cloud(int frame) const {
  base::Rng rng(seed_, static_cast<std::uint64_t>(frame));
  std::vector<Point> points = draw_points(surfaces_, *this, rng);
  for (std::size_t i = points.size(); i > 1; --i) {
    std::swap(points[i - 1], points[rng.below(static_cast<std::uint32_t>(i))]);
  }
  const std::vector<Point> nodes = draw_nodes(points, node_spacing_m);
  std::map<std::pair<int, int>, Sum> sums;
  std::set<std::pair<int, int>> edges;
  for (const Point& point : points) {
    const auto [first, second] = nearest_two(nodes, point.position_m);
    Sum& sum = sums[{first, point.head}];
    sum.n += 1.0;
    sum.s += point.position_m;
    sum.ss += point.position_m * point.position_m.transpose();
    if (second >= 0) edges.insert(std::minmax(first, second));
  }
  ladder::NodeCloud cloud;
  cloud.sequence = static_cast<std::uint64_t>(frame);
  for (int i = 0; i < static_cast<int>(nodes.size()); ++i) {
    const Point& node = nodes[i];
    cloud.id.push_back(i);
    cloud.x_m.push_back(static_cast<float>(node.position_m.x()));
    cloud.y_m.push_back(static_cast<float>(node.position_m.y()));
    cloud.z_m.push_back(static_cast<float>(node.position_m.z()));
    cloud.node_class.push_back(node.plane < 0 ? ladder::NodeClass::kObstacle
                                              : ladder::NodeClass::kWall);
    cloud.plane.push_back(node.plane);
  }
  for (const auto& [key, sum] : sums) {
    cloud.moments.push_back(to_moment(key.first, key.second, sum));
  }
  for (const auto& [a, b] : edges) cloud.edges.push_back({a, b});
  cloud.planes.resize(num_planes_);
  cloud.suspected.push_back({{1.5F, 0.0F, 1.5F}, {2.5F, 1.6F, 3.0F}});
  for (int i = 0; i < ladder::kNumHeads; ++i) {
    cloud.head_position_m[i] = kHeads_m[i].cast<float>();
    cloud.head_valid[i] = true;
  }
  cloud.body_position_m = {-0.2F, 0.0F, 0.45F};
  cloud.pixel_pitch_rad = 0.0048F;
  cloud.range_max_m = 4.0F;
  return cloud;
}

ladder::NodeCloud moved(const ladder::NodeCloud& cloud, double yaw_rad, const Vector3d& by_m) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(yaw_rad, Vector3d::UnitZ()).toRotationMatrix();
  const auto move = [&](const Eigen::Vector3f& p) -> Eigen::Vector3f {
    return (turn * p.cast<double>() + by_m).cast<float>();
  };
  ladder::NodeCloud out = cloud;
  for (int i = 0; i < cloud.num_nodes(); ++i) {
    const Eigen::Vector3f p = move({cloud.x_m[i], cloud.y_m[i], cloud.z_m[i]});
    out.x_m[i] = p.x();
    out.y_m[i] = p.y();
    out.z_m[i] = p.z();
  }
  for (ladder::HeadMoment& m : out.moments) {
    m.mean_m = move(m.mean_m);
    Eigen::Matrix3d c;
    c << m.xx_m2, m.xy_m2, m.xz_m2, m.xy_m2, m.yy_m2, m.yz_m2, m.xz_m2, m.yz_m2, m.zz_m2;
    const Eigen::Matrix3f turned = (turn * c * turn.transpose()).cast<float>();
    m.xx_m2 = turned(0, 0);
    m.xy_m2 = turned(0, 1);
    m.xz_m2 = turned(0, 2);
    m.yy_m2 = turned(1, 1);
    m.yz_m2 = turned(1, 2);
    m.zz_m2 = turned(2, 2);
  }
  for (auto& head : out.head_position_m) head = move(head);
  out.body_position_m = move(out.body_position_m);
  return out;
}

}  // namespace test_support
