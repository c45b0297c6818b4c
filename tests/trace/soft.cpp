/// A soft beam and a rod by implicit Euler, with contacts and joints on them.
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/integrators/implicit_euler.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

using Soft = TetrahedralFem<Corotational>;

/// A beam held at one end falls on the ground; a ball hangs from a point within.
auto beam() {
  AnimationLoop loop{World{RigidBodies{}, Soft{}},
                     Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                     ImplicitEuler{.rayleigh_stiffness = 0.02}};
  auto& rigid = rigid_of(loop);
  auto& soft = bodies<Soft>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto b = soft.add({.mesh = box_mesh({0.4, 0.1, 0.1}, {2, 1, 1}),
                           .elasticity = {.young = 2e4},
                           .position = {0, 0, 0.06},
                           .contact_radius = 0.01});
  soft.fix(b, [](const Vec3& x) { return x.x() < 1e-9; });
  const Vec3 hook(0.31, 0.03, 0.1);
  const auto ball = rigid.add({.position = {0.31, 0.2, 0.3}, .mass = 0.2, .shape = Sphere{0.03}});
  loop.add(BallJoint::Item{soft.anchor_at(b, hook), anchor(rigid, ball, hook - Vec3(0.31, 0.2, 0.3))});
  return loop;
}

/// A thread that hangs from the world by a joint and swings.
auto thread() {
  AnimationLoop loop{World{Rods{}}, Constraints{BallJoint{}}, ImplicitEuler{}};
  auto& set = rigid_of(loop);
  const auto rod = set.add({.points = straight_line({0, 0, 0}, {0.6, 0, 0.1}, 4),
                            .section = round_section(0.01),
                            .young = 1e7,
                            .velocity = {0, 0.5, 0}});
  loop.add(BallJoint::Item{anchor(set, set.node(rod, 0)), world_anchor({0, 0, 0})});
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("soft");
  all.add("beam_contact_and_joint", {.h = 0.01, .is_redundant = true}, beam);
  all.add("thread", {.h = 0.01}, thread);
  return all.main(argc, argv);
}
