/// Scenes of loose bodies, from which problems are taken: walls, piles, stacks, arches, slopes, hoppers.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace problems {

using namespace delassus;

/// Numbers that are alike on every machine.
class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * double(random_() - 1) / 2147483646.0;
  }
  Quat turn() {
    const double a = (*this)(-1, 1), b = (*this)(-1, 1), c = (*this)(-1, 1), d = (*this)(-1, 1);
    return Quat(a + 1e-3, b, c, d).normalized();
  }

 private:
  std::minstd_rand random_;
};

/// A floor and four walls around a square of twice `half`.
inline void add_bin(RigidBodies& set, double half) {
  set.add_fixed(HalfSpace{});
  for (const Vec3& inwards : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    set.add_fixed(HalfSpace{inwards, -half});
}

inline void add_wall(RigidBodies& set, int rows, int columns) {
  set.add_fixed(HalfSpace{});
  for (int r = 0; r < rows; ++r)
    for (int k = 0; k < columns; ++k)
      set.add({.position = {0, 0.4 * (k - 0.5 * columns + 0.5 * (r % 2)), 0.2 * (r + 0.5)},
               .density = 2000.,
               .shape = Box{0.2, 0.4, 0.2}});
  set.add({.position = {-2, 0, 0.1 * rows},
           .velocity = {7, 0, 0.5},
           .density = 7800.,
           .shape = Sphere{0.08 + 0.02 * rows}});
}

/// `side`² columns of balls, `layers` high, each a little off the one below; every `every`-th is ten times as
/// heavy.
inline void add_balls(RigidBodies& set, int side, int layers, int every = 0) {
  const double radius = 0.1, pitch = 0.205;
  add_bin(set, 0.5 * pitch * side + 0.05);
  Dice dice(5);
  for (int i = 0; i < side * side * layers; ++i) {
    const double x = pitch * (i % side - 0.5 * (side - 1)) + dice(-0.03, 0.03),
                 y = pitch * (i / side % side - 0.5 * (side - 1)) + dice(-0.03, 0.03);
    set.add({.position = {x, y, 1.2 * radius + 1.1 * pitch * (i / side / side)},
             .mass = every > 0 && i % every == 0 ? 10. : 1.,
             .shape = Sphere{radius}});
  }
}

/// Boxes of many sizes, turned anyhow, above a bin.
inline void add_boxes(RigidBodies& set, int count, double half) {
  add_bin(set, half);
  Dice dice(17);
  const int side = std::max(1, int(2 * half / 0.5));
  for (int i = 0; i < count; ++i)
    set.add({.position = {0.5 * (i % side - 0.5 * (side - 1)), 0.5 * (i / side % side - 0.5 * (side - 1)),
                          0.3 + 0.45 * (i / side / side)},
             .orientation = dice.turn(),
             .density = 800.,
             .shape = Box{dice(0.15, 0.35), dice(0.15, 0.3), dice(0.1, 0.25)}});
}

inline ConvexHull stone(Dice& dice, double size) {
  std::vector<Vec3> points;
  while (points.size() < 12) {
    const Vec3 p{dice(-1, 1), dice(-1, 1), dice(-1, 1)};
    if (p.norm() < 1 && p.norm() > 0.3) points.push_back(size * p.normalized());
  }
  return ConvexHull(points);
}

/// The k-th of five kinds, about 30 cm wide.
inline Shape any_shape(int k, const ConvexHull& rock) {
  switch (k % 5) {
    case 0:
      return Sphere{0.15};
    case 1:
      return Box{0.32, 0.26, 0.2};
    case 2:
      return Capsule{0.1, 0.22};
    case 3:
      return Cylinder{0.14, 0.24};
    default:
      return rock;
  }
}

inline void add_mixed(RigidBodies& set, int count, double half) {
  add_bin(set, half);
  Dice dice(23);
  const int side = int(2 * half / 0.46);
  for (int i = 0; i < count; ++i) {
    const ConvexHull rock = stone(dice, 0.17);
    set.add({.position = {0.46 * (i % side - 0.5 * (side - 1)), 0.46 * (i / side % side - 0.5 * (side - 1)),
                          0.35 + 0.5 * (i / side / side)},
             .orientation = dice.turn(),
             .density = 1000.,
             .shape = any_shape(i, rock)});
  }
}

/// Boxes on each other, each `ratio` times as heavy as the one below, beside each other `towers` times.
inline void add_stacks(RigidBodies& set, int count, int towers, double ratio) {
  set.add_fixed(HalfSpace{});
  Dice dice(7);
  for (int t = 0; t < towers; ++t)
    for (int i = 0; i < count; ++i)
      set.add({.position = {1.5 * t + dice(-0.02, 0.02), dice(-0.02, 0.02), 0.5 + 1.002 * i},
               .mass = std::pow(ratio, i),
               .shape = Box{1, 1, 1}});
}

inline void add_pyramid(RigidBodies& set, int rows) {
  set.add_fixed(HalfSpace{});
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i)
      set.add(
          {.position = {1.05 * (i + 0.5 * row), 0, 0.5 + 1.002 * row}, .mass = 1., .shape = Box{1, 1, 1}});
}

/// Cards of 100 × 60 × 1 mm: tents of two at 65 degrees and level cards between them.
inline void add_card_house(RigidBodies& set, int storeys) {
  set.add_fixed(HalfSpace{});
  const double a = 0.05, b = 0.0005, angle = 65 * std::numbers::pi / 180, c = std::cos(angle),
               s = std::sin(angle);
  const double half = a * c + b * s, rise = a * s + b * c, spacing = 4 * half + 1e-4;
  double floor = 0;
  for (int storey = 0; storey < storeys; ++storey) {
    const int tents = storeys - storey;
    for (int k = 0; k < tents; ++k)
      for (const double side : {-1., 1.})
        set.add({.position = {spacing * (k + 0.5 * storey) + side * half, 0, floor + rise},
                 .orientation = Quat(std::cos(0.5 * angle), 0, side * std::sin(0.5 * angle), 0),
                 .density = 800.,
                 .shape = Box{2 * a, 0.06, 2 * b}});
    for (int k = 0; k + 1 < tents; ++k)
      set.add({.position = {spacing * (k + 0.5 + 0.5 * storey), 0, floor + 2 * rise + b},
               .density = 800.,
               .shape = Box{spacing - 1e-4, 0.06, 2 * b}});
    floor += 2 * rise + 2 * b;
  }
}

/// A half circle of wedges, on which boxes drop.
inline void add_arch(RigidBodies& set, int count, int boxes) {
  set.add_fixed(HalfSpace{});
  const double step = std::numbers::pi / count, r = 3, half = 0.35;
  for (int k = 0; k < count; ++k) {
    std::vector<Vec3> corners;
    for (const double angle : {k * step, (k + 1) * step})
      for (const double radius : {r - half, r + half})
        for (const double y : {-0.4, 0.4})
          corners.push_back({radius * std::cos(angle), y, radius * std::sin(angle)});
    const ConvexHull hull(corners);
    set.add({.position = hull.centroid(), .density = 2000., .shape = hull});
  }
  for (int k = 0; k < boxes; ++k)
    set.add({.position = {0.02 * k, 0, r + half + 0.3 + 0.45 * k},
             .density = 1500.,
             .shape = Box{0.4, 0.4, 0.4}});
}

/// Boxes on a slope of 24 degrees that ends in a ledge.
inline void add_slope(RigidBodies& set, int rows, int columns, bool are_stones) {
  const Quat lean(Eigen::AngleAxisd(24 * std::numbers::pi / 180, Vec3::UnitY()));
  set.add_fixed(Box{30, 10, 1}, lean * Vec3(0, 0, -0.5), lean);
  set.add_fixed(Box{0.4, 10, 2}, lean * Vec3(3.2, 0, 0.5), lean);
  Dice dice(3);
  for (int i = 0; i < rows * columns; ++i) {
    const double x = 2.4 - 0.62 * (i / columns), y = 0.6 * (i % columns - 0.5 * (columns - 1));
    if (are_stones)
      set.add({.position = lean * Vec3(x, y, 0.3),
               .orientation = dice.turn(),
               .density = 2000.,
               .shape = stone(dice, 0.25)});
    else
      set.add({.position = lean * Vec3(x, y, 0.16 + 0.02 * dice(0, 1)),
               .orientation = lean,
               .density = 700.,
               .shape = Box{0.5, 0.5, dice(0.2, 0.32)}});
  }
}

inline void add_dominoes(RigidBodies& set, int count) {
  set.add_fixed(HalfSpace{});
  for (int k = 0; k < count; ++k)
    set.add({.position = {0.55 * k, 0, 0.5}, .mass = 1., .shape = Box{0.2, 0.5, 1}});
  set.add({.position = {-1.2, 0, 0.9}, .velocity = {4, 0, 1}, .mass = 2., .shape = Sphere{0.2}});
}

/// A ring of bricks on a ring of bricks, and a ball that hits it.
inline void add_round_tower(RigidBodies& set, int layers, int bricks, double speed) {
  set.add_fixed(HalfSpace{});
  const double r = 0.42 * bricks / (2 * std::numbers::pi);
  for (int layer = 0; layer < layers; ++layer)
    for (int k = 0; k < bricks; ++k) {
      const double angle = 2 * std::numbers::pi * (k + 0.5 * (layer % 2)) / bricks;
      set.add({.position = {r * std::cos(angle), r * std::sin(angle), 0.1 + 0.201 * layer},
               .orientation = Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())),
               .density = 1800.,
               .shape = Box{0.2, 0.4, 0.2}});
    }
  set.add({.position = {-r - 1.5, 0, 0.15 * layers},
           .velocity = {speed, 0, 0.5},
           .density = 4000.,
           .shape = Sphere{0.18}});
}

/// Logs between posts, row over row.
inline void add_logs(RigidBodies& set, int lowest, int rows) {
  set.add_fixed(HalfSpace{});
  const double r = 0.15;
  for (const double side : {-1., 1.})
    set.add_fixed(Box{0.2, 3, 3}, {side * (lowest * 1.01 * r + 0.12), 0, 1.5});
  const Quat lying(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitX()));
  Dice dice(29);
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < lowest - row % 2; ++k)
      set.add(
          {.position = {2.02 * r * (k - 0.5 * (lowest - 1 - row % 2)), dice(-0.1, 0.1), r + 1.9 * r * row},
           .orientation = lying,
           .density = 600.,
           .shape = row % 3 == 2 ? Shape(Capsule{r, 1.6}) : Shape(Cylinder{r, 2})});
}

/// A blade that is moved into rubble.
inline void add_plough(RigidBodies& set, int count) {
  set.add_fixed(HalfSpace{});
  Dice dice(41);
  for (int i = 0; i < count; ++i)
    set.add({.position = {0.35 * (i / 6 % 5), 0.35 * (i % 6 - 2.5), 0.25 + 0.35 * (i / 30)},
             .orientation = dice.turn(),
             .density = 1500.,
             .shape = i % 3 == 0 ? Shape(Box{0.25, 0.2, 0.15}) : Shape(stone(dice, 0.15))});
  set.add({.position = {-0.6, 0, 0.4},
           .velocity = {0.8, 0, 0},
           .shape = Box{0.2, 2.6, 0.8},
           .motion = Motion::kinematic});
}

/// Grains over a hole of 4.5 diameters in the bottom of a hopper.
inline void add_hopper(RigidBodies& set, int count, bool are_cubes) {
  const double d = 0.1, width = 0.9, hole = 0.45, rim = 0.5 * (width - hole);
  for (int axis = 0; axis < 2; ++axis)
    for (const double side : {-1., 1.}) {
      const Vec3 out = side * Vec3::Unit(axis);
      set.add_fixed(HalfSpace{-out}, 0.5 * width * out);
      set.add_fixed(axis == 0 ? Shape(Box{rim, width, d}) : Shape(Box{hole, rim, d}),
                    0.5 * (hole + rim) * out - Vec3(0, 0, 0.5 * d));
    }
  set.add_fixed(HalfSpace{}, {0, 0, -0.6});
  Dice dice(13);
  for (int i = 0; i < count; ++i)
    set.add({.position = {0.11 * (i % 8 - 3.5) + dice(-0.004, 0.004),
                          0.11 * (i / 8 % 8 - 3.5) + dice(-0.004, 0.004), 0.06 + 0.11 * (i / 64)},
             .mass = 1e-3,
             .shape = are_cubes ? Shape(Box{d, d, d}) : Shape(Sphere{0.5 * d})});
}

/// A plate on balls, and boxes that drop on the plate.
inline void add_plate(RigidBodies& set, int side, int boxes) {
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < side * side; ++i)
    set.add({.position = {0.3 * (i % side - 0.5 * (side - 1)), 0.3 * (i / side - 0.5 * (side - 1)), 0.05},
             .mass = 0.5,
             .shape = Sphere{0.05}});
  set.add({.position = {0, 0, 0.16}, .mass = 30., .shape = Box{0.3 * side, 0.3 * side, 0.1}});
  for (int k = 0; k < boxes; ++k)
    set.add({.position = {0.3 * (k % 3 - 1), 0.3 * (k / 3 % 3 - 1), 0.4 + 0.3 * (k / 9)},
             .velocity = {0.2, 0, -0.5},
             .mass = 3.,
             .shape = Box{0.22, 0.24, 0.2}});
}

/// Thin books that lean between two ends.
inline void add_books(RigidBodies& set, int count) {
  set.add_fixed(HalfSpace{});
  Dice dice(53);
  double x = 0;
  for (int k = 0; k < count; ++k) {
    const double thick = dice(0.02, 0.06), tall = dice(0.2, 0.3);
    x += 0.5 * thick + 0.03;
    set.add({.position = {x, 0, 0.5 * tall + 0.02},
             .orientation = Quat(Eigen::AngleAxisd(0.12, Vec3::UnitY())),
             .density = 700.,
             .shape = Box{thick, 0.16, tall}});
    x += 0.5 * thick;
  }
  for (const double end : {-0.1, x + 0.12}) set.add_fixed(Box{0.1, 0.4, 0.6}, {end, 0, 0.3});
}

}  // namespace problems
