// expect: delassus: an integrator that says can_move makes its step at once, by `void move(auto& step) const`, and this one has no such function; add it, or take can_move out
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/loop/animation_loop.hpp>

using namespace delassus;

struct AtOnce {
  using plays = role::Integrator;
  template <class Set>
  static constexpr bool can_move = true;
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { SymplecticEuler{}.impulse(set, p, h); }
  void advance(auto& set, double h) const { SymplecticEuler{}.advance(set, h); }
  void move(auto&) {}  // not const
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, AtOnce{}};
  loop.step(0.01);
}
