// A soft beam is clamped at one end, sags, and carries a ball that hangs on its tip.
// prints: tip sags by 0\.347[0-9] m, the joint carries 0\.981 N
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{BallJoint{}},
                     ImplicitEuler{.rayleigh_mass = 2, .rayleigh_stiffness = 0.02}};
  auto& soft = bodies<Soft>(loop.world());
  auto& rigid = bodies<RigidBodies>(loop.world());

  const auto beam = soft.add({.mesh = box_mesh({1, 0.1, 0.1}, {20, 2, 2}),
                              .elasticity = {.young = 2e6, .poisson = 0.3},
                              .density = 1000});
  soft.fix(beam, [](const Vec3& x) { return x.x() < 1e-9; });
  const Vec3 tip(1, 0.05, 0.05);
  const auto ball = rigid.add({.position = {1, 0.05, -0.25}, .mass = 0.1, .shape = Sphere{0.1}});
  const auto hook = loop.add(BallJoint::Item{anchor_at(rigid, ball, tip), soft.anchor_at(beam, tip)});

  for (int i = 0; i < 1000; ++i) loop.step(0.01);
  const Vec3 moved = rigid.position(ball) - Vec3(1, 0.05, -0.25);
  std::printf("tip sags by %.4f m, the joint carries %.3f N\n", -moved.z(), loop.impulse(hook).norm() / 0.01);
}
