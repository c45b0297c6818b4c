/// Soft bodies and rods solved to the end of each step, mechanisms with hinges, and whole steps in parts.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/coupling.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/schemes/substeps.hpp>
#include <delassus/steppers/bdf2.hpp>
#include <delassus/steppers/full_newton.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

using Soft = TetrahedralFem<Corotational>;

template <class Integrator>
auto spinning() {
  AnimationLoop loop{World{Soft{}}, Integrator{}};
  auto& set = rigid_of(loop);
  set.add({.mesh = box_mesh({1, 1, 1}, {1, 1, 1}), .elasticity = {.young = 1e5}});
  for (const Index b : set.active())
    set.velocity()[b] = Vec3(1, 2, 3) + Vec3(0.5, -0.3, 2).cross(Vec3(set.position(set.handle(b))));
  return loop;
}
auto bent_rod() {
  AnimationLoop loop{World{Rods{}}, FullNewton{.theta = 0.5}};
  auto& set = rigid_of(loop);
  const auto rod = set.add({.points = straight_line({0, 0, 0}, {1, 0, 0}, 3),
                            .section = round_section(0.02),
                            .young = 1e7,
                            .velocity = {0, 1, 0}});
  set.fix(set.node(rod, 0));
  return loop;
}
/// Two wheels that mesh, on arms of a chain that swings.
auto geared() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Gear{}}, Rattle{}};
  auto& set = rigid_of(loop);
  const Quat axis = frame_along({0, 1, 0});
  const auto a = set.add({.position = {0.2, 0, -0.1}, .mass = 1.0, .shape = Box{0.4, 0.1, 0.4}}),
             b = set.add({.position = {1, 0, 0}, .mass = 2.0, .shape = Box{0.6, 0.1, 0.2}});
  const Anchor w1 = world_anchor({0, 0, 0}, axis), w2 = world_anchor({0.9, 0, 0}, axis);
  const Anchor b1 = anchor_at(set, a, {0, 0, 0}, axis), b2 = anchor_at(set, b, {0.9, 0, 0}, axis);
  loop.add(Hinge::Item{w1, b1});
  loop.add(Hinge::Item{w2, b2});
  loop.add(Gear::Item{.a = b1, .b = b2, .c = w1, .d = w2, .ratio = -1.5});
  return loop;
}
template <class Integrator>
auto chain_in_parts() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Integrator{}, Substeps{2}};
  add_chain(loop, 2, 0, [&](const Anchor& a, const Anchor& b) { loop.add(BallJoint::Item{a, b}); });
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("integrators_more");
  all.add("full_newton_cube", {.h = 0.005}, spinning<FullNewton>);
  all.add("bdf2_cube", {.h = 0.005}, spinning<Bdf2>);
  all.add("full_newton_rod", {.h = 0.01}, bent_rod);
  all.add("rattle_gears", {.h = 0.005}, geared);
  all.add("newton_midpoint_in_parts", {.h = 0.02}, chain_in_parts<NewtonMidpoint>);
  all.add("runge_kutta_in_parts", {.h = 0.02}, chain_in_parts<RungeKutta4>);
  return all.main(argc, argv);
}
