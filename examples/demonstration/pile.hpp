/// Two hundred bodies of five shapes, dropped into a box of half-spaces, for any collision backend.
#pragma once

#include "measure.hpp"

#include <random>

namespace demonstration {

namespace pile_parts {

constexpr double half_width = 1.25;  // of the box, m

/// The corners of an irregular stone about 30 cm wide.
inline ConvexHull stone(std::minstd_rand& random) {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<Vec3> points;
  while (points.size() < 14) {
    const Vec3 p(coordinate(random), coordinate(random), coordinate(random));
    if (p.norm() < 1 && p.norm() > 0.3) points.push_back(0.18 * p.normalized());
  }
  return ConvexHull(points);
}

inline void add_box_of_half_spaces(RigidBodies& rigid) {
  rigid.add_fixed(HalfSpace{});
  for (const Vec3& inwards : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    rigid.add_fixed(HalfSpace{inwards, -half_width});
}

/// Layers of five by five, turned at random, each shape in its turn.
inline void add_bodies(RigidBodies& rigid, int count) {
  std::minstd_rand random(11);
  std::uniform_real_distribution<double> any(-1, 1);
  std::vector<ConvexHull> stones;
  for (int k = 0; k < 4; ++k) stones.push_back(stone(random));
  for (int i = 0; i < count; ++i) {
    const Shape shapes[] = {Sphere{0.16}, Box{0.34, 0.26, 0.22}, Capsule{0.1, 0.24}, Cylinder{0.15, 0.24},
                            stones[std::size_t(i / 5 % 4)]};
    const Vec3 place(0.46 * (i % 5 - 2), 0.46 * (i / 5 % 5 - 2), 0.4 + 0.5 * (i / 25));
    const Vec3 off(0.02 * any(random), 0.02 * any(random), 0);
    const Quat turn = Quat(any(random), any(random), any(random), any(random) + 0.01).normalized();
    rigid.add({.position = place + off, .orientation = turn, .density = 1000, .shape = shapes[(i + i / 5 + i / 25) % 5]});
  }
}

}  // namespace pile_parts

template <class Collision>
Scene drop_pile(Collision collision, const std::string& backend, bool is_quick, const Watch& watch) {
  const double h = 1.0 / 240, seconds = is_quick ? 0.25 : 6;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}}, std::move(collision),
                     AcceleratedGaussSeidel{.tolerance = 1e-4}, StepTime{}, Stopwatch{},
                     Recorder{"Pile of 200", "Spheres, boxes, capsules, cylinders and convex hulls, dropped into a box "
                                             "of half-spaces; collision detection: " + backend + "."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  pile_parts::add_box_of_half_spaces(rigid);
  pile_parts::add_bodies(rigid, 200);
  Scene scene = measure(loop, backend, h, seconds, watch);
  for (RecordedBody& body : scene.recording.bodies)
    if (!body.is_static) body.colour = int(body.shape.kind) % 8;

  // Between the corners of the octagon that stands for a cylinder's rim, the rim may sink in unseen by 11 mm.
  scene.expect_below(1e3 * scene.max_penetration, 25, "the largest penetration", "mm");
  scene.expect_below(scene.energy_rise(), 1, "the largest rise of the energy", "J");
  if (!is_quick) scene.expect_below(scene.kinetic_energy, 1, "the kinetic energy at the end", "J");
  return scene;
}

}  // namespace demonstration
