/// The scenes of the example: a stack, a cluster with random contacts, and bodies of three kinds.
#pragma once

#include "flat_step.hpp"

namespace light {

using Contacts = Contact<Coulomb>;

/// A stack of boxes on the ground in the midst of its first step.
inline auto stack(int count) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     delassus::GaussSeidel{}};
  scenes::add_stack(scenes::rigid_bodies(loop), count, Box{1, 1, 1});
  stop_before_solve(loop, 1.0 / 60);
  return loop;
}

/// Boxes with random contacts between them; one island.
inline auto cluster(int bodies, int contacts) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                     scenes::GivenContacts{}, delassus::GaussSeidel{}};
  loop.template policy<role::Collision>().points =
      scenes::add_cluster(scenes::rigid_bodies(loop), bodies, contacts, 3);
  stop_before_solve(loop, 1.0 / 60);
  return loop;
}

/// A second set of particles: a small soft body of springs, which an implicit integrator couples.
using Jelly = Tagged<Particles, struct Soft>;

/// Boxes on the ground with a chain of hinges, particles that hang from them, and a cube of eight particles
/// with springs along its edges and diagonals that one box carries and a soft row holds to the world.
inline auto mixed(double stiffness = 2000) {
  AnimationLoop loop{World{RigidBodies{}, Particles{}, Jelly{}},
                     Constraints{BallJoint{}, Hinge{}, Contact{Coulomb{.friction = 0.5}}, DistanceJoint{}},
                     ImplicitEuler{}, delassus::GaussSeidel{}};
  auto& world = loop.world();
  auto& rigid = world.template set<0>();
  auto& beads = world.template set<1>();
  auto& jelly = world.template set<2>();
  rigid.add_fixed(HalfSpace{});
  std::array<RigidBodies::Handle, 4> box;
  for (int k = 0; k < 4; ++k)
    box[k] = rigid.add({.position = {1.5 * k, 0.01 * k, 0.499},
                        .velocity = {1, 0.2 * k, 0},
                        .mass = 1.0 + k,
                        .shape = Box{1, 1, 1}});
  for (int k = 0; k < 2; ++k)
    loop.add(Hinge::Item{anchor(rigid, box[k], {0.75, 0, 0}), anchor(rigid, box[k + 1], {-0.75, 0.01, 0})});
  for (int k = 0; k < 3; ++k) {
    const auto bead = beads.add({.position = {1.5 * k, 0.3, 1.2}, .velocity = {0, 0.5, 0}, .mass = 0.1});
    loop.add(BallJoint::Item{anchor(rigid, box[k], {0, 0.3, 0.7}), anchor(beads, bead)});
  }
  std::array<Particles::Handle, 8> node;
  for (int k = 0; k < 8; ++k)
    node[k] =
        jelly.add({.position = {4.5 + 0.4 * (k & 1), 0.4 * (k >> 1 & 1), 1.5 + 0.4 * (k >> 2)}, .mass = 0.2});
  for (int a = 0; a < 8; ++a)
    for (int b = a + 1; b < 8; ++b) jelly.add_spring(node[a], node[b], stiffness, 1.0);
  loop.add(BallJoint::Item{anchor(rigid, box[3], {0, 0, 1}), anchor(jelly, node[0])});
  loop.add(DistanceJoint::Item{anchor(jelly, node[7]), world_anchor({4.9, 0.4, 3}), 1.0, 300, 2});
  loop.add(DistanceJoint::Item{anchor(jelly, node[3]), world_anchor({4.9, 0.4, 3}), 1.55});
  stop_before_solve(loop, 0.01);
  return loop;
}

}  // namespace light
