/// One body on a violated joint, one body sunk into the ground: what each policy does about it.
#pragma once

#include <delassus/delassus.hpp>

namespace violated {

using namespace delassus;

/// A free particle `gap` m away from the world point it is joined to, moving across at `speed` m/s, no
/// weight.
template <class S>
struct Joint {
  AnimationLoop<World<Particles>, Constraints<BallJoint>, S, GaussSeidel> loop;
  Particles::Handle bob{};

  explicit Joint(S policy, double gap = 0.1)
      : loop(World{Particles{}}, Constraints{BallJoint{}}, policy, GaussSeidel{.tolerance = 1e-14}) {
    set().gravity.setZero();
    bob = set().add({.position = {gap, 0, 0}, .mass = 2.0});
    loop.add(BallJoint::Item{anchor(set(), bob), world_anchor(Vec3::Zero())});
  }
  Particles& set() { return bodies<Particles>(loop.world()); }
};

/// A ball of 1 kg sunk `depth` m into the ground, at rest.
template <class S>
struct Sunk {
  AnimationLoop<World<RigidBodies>, Constraints<Contact<Frictionless>>, S, GaussSeidel> loop;
  RigidBodies::Handle ball{};

  explicit Sunk(S policy, double depth)
      : loop(World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, policy,
             GaussSeidel{.tolerance = 1e-14}) {
    set().add_fixed(HalfSpace{});
    ball = set().add({.position = {0, 0, 0.5 - depth}, .mass = 1.0, .shape = Sphere{0.5}});
  }
  RigidBodies& set() { return bodies<RigidBodies>(loop.world()); }
  /// How deep it is in the ground, m.
  double depth() { return 0.5 - set().position(ball).z(); }
  /// Largest speed on the way out, over `steps`, m/s.
  double exit_speed(double h, int steps) {
    double largest = 0;
    for (int n = 0; n < steps; ++n) {
      loop.step(h);
      largest = std::max(largest, set().velocity(ball).z());
    }
    return largest;
  }
};

}  // namespace violated
