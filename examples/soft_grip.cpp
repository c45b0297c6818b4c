// Two fingers press a soft cube with 20 N each and lift it: friction holds its 1 kg from mu = m g / (2 N) on.
// prints: mu 5% above: lifted by 50 mm, slips by 0\.[0-9] mm; 5% below: it falls
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include <cstdio>
using namespace delassus;
using Soft = TetrahedralFem<Corotational>;
/// By how much the cube fell behind the fingers, and how far those went, m.
std::pair<double, double> lift(double friction) {
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{friction}}, Slider{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.01}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& soft = bodies<Soft>(loop.world());
  const auto cube = soft.add({.mesh = box_mesh({0.1, 0.1, 0.1}, {3, 3, 3}), .elasticity = {.young = 5e4}, .contact_radius = 0.002});
  const auto hand = rigid.add({.position = {0.05, 0.05, 0.2}, .motion = Motion::kinematic});
  const Vec3 at[2] = {{-0.0125, 0.05, 0.05}, {0.1125, 0.05, 0.05}}, x = Vec3::UnitX();
  RigidBodies::Handle finger[2];
  for (int k = 0; k < 2; ++k) {
    finger[k] = rigid.add({.position = at[k], .mass = 0.2, .shape = Box{0.02, 0.12, 0.12}});
    loop.add(Slider::Item{anchor_at(rigid, hand, at[k], frame_along(x)),
                          anchor_at(rigid, finger[k], at[k], frame_along(x))});
  }
  for (int n = 0; n < 350; ++n) {  // 0.5 s to grip, 0.5 s in which gravity comes, 1.5 s to lift, 1 s to hold
    const double t = std::clamp((n - 100) / 150., 0., 1.),
                 height = 0.05 * t * t * t * (10 - 15 * t + 6 * t * t);
    soft.gravity = {0, 0, -9.81 * std::clamp((n - 50) / 50., 0., 1.)};
    for (int k = 0; k < 2; ++k) rigid.apply_force(finger[k], (k == 0 ? 20. : -20.) * x);
    rigid.move_to(hand, {0.05, 0.05, 0.2 + height}, Quat::Identity());
    loop.step(0.01);
  }
  return {0.05 + 0.2 / 3 - soft.position(soft.node(cube, 36)).z(), rigid.position(finger[0]).z() - 0.05};
}
int main() {
  const auto [slip, lifted] = lift(1.05 * 9.81 / 40);
  std::printf("mu 5%% above: lifted by %.0f mm, slips by %.1f mm; ", 1e3 * lifted, 1e3 * slip);
  std::puts(lift(0.95 * 9.81 / 40).first > 0.1 ? "5% below: it falls" : "5% below: it holds");
}
