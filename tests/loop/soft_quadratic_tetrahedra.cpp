// Tetrahedra with nodes on their edges in a whole loop: contact of their surface, joints.
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/fem/quadratic_tetrahedral_fem.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

namespace soft_quadratic_tetrahedra_tests {

using namespace delassus;

TEST_CASE(
    "what lands on a bed of ten-node tetrahedra rests on it, and a joint inside of one holds a weight") {
  using Soft = QuadraticTetrahedralFem<Corotational>;
  const double h = 0.01, radius = 0.01;
  AnimationLoop loop{
      World{RigidBodies{}, Soft{}}, Constraints{BallJoint{}, Contact{Coulomb{.friction = 0.5}}},
      ImplicitEuler{.rayleigh_stiffness = 0.02}, WithSurfaces{NativeCollision{.margin = 0.02}}};
  auto& soft = bodies<Soft>(loop.world());
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto bed = soft.add({.mesh = quadratic(box_mesh({1, 1, 0.4}, {2, 2, 1})),
                             .elasticity = {.young = 1e5},
                             .contact_radius = radius});
  soft.fix(bed, [](const Vec3& x) { return x[2] < 1e-9; });
  // Inside of one of the four triangles of a face: the nodes around it are 0.1 m away.
  const auto ball = rigid.add({.position = {0.33, 0.42, 0.53}, .mass = 5., .shape = Sphere{0.1}});
  const Mat3 inertia = 0.01 * Mat3::Identity();
  const auto weight = rigid.add({.position = {0.8, 0.7, -0.3}, .mass = 2., .inertia = inertia});
  loop.add(BallJoint::Item{soft.anchor_at(bed, {0.8, 0.7, 0.1}), anchor(rigid, weight, {0, 0, 0.4})});
  for (int n = 0; n < 300; ++n) loop.step(h);
  CHECK(loop.report().status == Status::converged);
  CHECK(rigid.position(ball)[2] > 0.45);
  CHECK(rigid.position(ball)[2] < 0.4 + radius + 0.1);
  double on_ball = 0;
  for (const ContactResult& c : loop.contacts()) on_ball += std::abs(c.impulse[2]) / h;
  // Damped for 3 s; a hundredth of the weight is more than what still swings.
  CHECK(std::abs(on_ball / (5 * 9.81) - 1) < 1e-2);
  // The joint's point sinks with the bed under 20 N, by less than a weight on its area, m g L/(E 0.01 m²).
  CHECK(rigid.position(weight)[2] < -0.3);
  CHECK(rigid.position(weight)[2] > -0.3 - 2 * 9.81 * 0.4 / (1e5 * 0.01));
}

}  // namespace soft_quadratic_tetrahedra_tests
