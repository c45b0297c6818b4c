// A slider-crank: a motor of 40 N·m brings the crank to a turn a second, a rod drives the piston along its cylinder.
// prints: piston off the closed form by 0\.000[01]
#include <delassus/delassus.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, BallJoint{}, Cylindrical{}, Motor<Turn>{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-8}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double r = 0.2, l = 0.6;
  const auto crank = rigid.add({.position = {r / 2, 0, 0}, .mass = 1.0, .shape = Box{r, 0.05, 0.05}});
  const auto rod = rigid.add({.position = {r + l / 2, 0, 0}, .mass = 0.5, .shape = Box{l, 0.03, 0.03}});
  const auto piston = rigid.add({.position = {r + l, 0, 0}, .mass = 0.8, .shape = Box{0.1, 0.1, 0.1}});

  const Quat along_x = frame_along({1, 0, 0});  // joints act on the z axis of their frames
  const Anchor bearing = world_anchor({0, 0, 0}), shaft = anchor_at(rigid, crank, {0, 0, 0});
  loop.add(Hinge::Item{bearing, shaft});
  loop.add(Hinge::Item{anchor_at(rigid, crank, {r, 0, 0}), anchor_at(rigid, rod, {r, 0, 0})});
  loop.add(BallJoint::Item{anchor_at(rigid, rod, {r + l, 0, 0}), anchor(rigid, piston)});
  loop.add(Cylindrical::Item{world_anchor({0, 0, 0}, along_x), anchor_at(rigid, piston, {r + l, 0, 0}, along_x)});
  loop.add(Motor<Turn>::Item{.a = bearing, .b = shaft, .speed = 6.2832, .max_force = 40});

  double worst = 0;
  for (int n = 0; n < 3000; ++n) {
    loop.step(1e-3);
    const Vec3 pin = 2 * rigid.position(crank);
    const double x = pin.x() + std::sqrt(l * l - pin.y() * pin.y());
    worst = std::max(worst, std::abs(rigid.position(piston).x() - x));
  }
  std::printf("piston off the closed form by %.5f m\n", worst);
}
