// expect: delassus: an integrator with move(step) says which sets of bodies it moves; add `template <class Set> static constexpr bool can_move = ...;`
#include <delassus/delassus.hpp>

using namespace delassus;

struct AtOnce {
  using plays = role::Integrator;
  SystemScale scale(double) const { return {.mass = 1}; }
  void impulse(const auto& set, auto& p, double h) const { SymplecticEuler{}.impulse(set, p, h); }
  void advance(auto& set, double h) const { SymplecticEuler{}.advance(set, h); }
  void move(auto&) const {}
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, AtOnce{}};
  loop.step(0.01);
}
