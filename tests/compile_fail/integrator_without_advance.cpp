// expect: delassus: this type plays role::Integrator but lacks scale(h), impulse(set, p, h) or advance(set, h)
#include <delassus/delassus.hpp>

using namespace delassus;

struct Euler {
  using plays = role::Integrator;
  SystemScale scale(double) const { return {}; }
  void impulse(const auto& set, auto& p, double h) const {
    set.add_forces(p);
    times(p, h);
  }
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Euler{}};
  loop.step(1e-3);
}
