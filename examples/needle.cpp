// A needle in a driven hand is pushed against a leaning plate of bone: it bends and slides.
// prints: the hand feels 0\.07[0-9] N, the needle is bent by 7\.[45][0-9] mm
#include <delassus/delassus.hpp>
#include <delassus/fem/rods.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}, Rods{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, Weld{}},
                     ImplicitEuler{.rayleigh_mass = 5, .rayleigh_stiffness = 1e-3}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& rods = bodies<Rods>(loop.world());
  // 150 mm of steel, 0.6 mm thick, in 15 segments; the plate is 1 mm beyond its point and leans by 20
  // degrees.
  const auto needle = rods.add({.points = straight_line({0, 0, 0}, {0.15, 0, 0}, 15),
                                .section = round_section(0.3e-3),
                                .young = 2e11,
                                .density = 7800,
                                .contact_radius = 0.3e-3});
  rigid.add_fixed(Box{0.02, 0.2, 0.2}, {0.162, 0, 0}, Quat(0.98481, 0, 0.17365, 0).normalized());
  const auto hand =
      rigid.add({.position = {-0.01, 0, 0}, .shape = Sphere{0.005}, .motion = Motion::kinematic});
  const auto grip =
      loop.add(Weld::Item{anchor_at(rigid, hand, Vec3(0, 0, 0)), anchor(rods, rods.node(needle, 0))});

  const double h = 1e-3;
  for (int n = 0; n < 2000; ++n) {
    rigid.move_to(hand, {-0.01 + std::min(0.004, 0.004 * n * h), 0, 0});
    loop.step(h);
  }
  double bend = 0;
  for (Index k = 0; k <= 15; ++k) bend = std::max(bend, rods.position(rods.node(needle, k)).tail<2>().norm());
  const double force = loop.impulse(grip).norm() / h;
  std::printf("the hand feels %.3f N, the needle is bent by %.2f mm\n", force, 1000 * bend);
}
