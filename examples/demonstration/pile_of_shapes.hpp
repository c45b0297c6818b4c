/// The bodies of the demonstration's pile.
#pragma once

#include <delassus/bodies/rigid_bodies.hpp>

#include <random>
#include <vector>

namespace demonstration {

/// The corners of an irregular stone about 30 cm wide.
inline delassus::ConvexHull stone(std::minstd_rand& random) {
  using namespace delassus;
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<Vec3> points;
  while (points.size() < 14) {
    const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
    if (p.norm() < 1 && p.norm() > 0.3) points.push_back(0.18 * p.normalized());
  }
  return ConvexHull(points);
}

/// Two hundred bodies above the floor of a box of half-spaces: layers of five by five, turned at random, each
/// shape in its turn.
inline void add_pile_of_shapes(delassus::RigidBodies& rigid) {
  using namespace delassus;
  const double half_width = 1.25;  // of the box, m
  rigid.add_fixed(HalfSpace{});
  for (const Vec3& inwards : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    rigid.add_fixed(HalfSpace{inwards, -half_width});

  std::minstd_rand random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<ConvexHull> stones;
  for (int k = 0; k < 4; ++k) stones.push_back(stone(random));
  for (int i = 0; i < 200; ++i) {
    const Shape shapes[] = {Sphere{0.16}, Box{0.34, 0.26, 0.22}, Capsule{0.1, 0.24}, Cylinder{0.15, 0.24},
                            stones[std::size_t(i / 5 % 4)]};
    const Vec3 place(0.46 * (i % 5 - 2), 0.46 * (i / 5 % 5 - 2), 0.4 + 0.5 * (i / 25));
    const Vec3 off(0.02 * any(random), 0.02 * any(random), 0);
    const Quat turn = Quat(any(random), any(random), any(random), any(random) + 0.01).normalized();
    rigid.add({.position = place + off,
               .orientation = turn,
               .density = 1000,
               .shape = shapes[(i + i / 5 + i / 25) % 5]});
  }
}

}  // namespace demonstration
