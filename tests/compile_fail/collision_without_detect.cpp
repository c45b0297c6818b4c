// expect: delassus: this type plays role::Collision but lacks detect(std::span<const Collider>, double,
#include <delassus/delassus.hpp>

using namespace delassus;

struct Grid {
  using plays = role::Collision;
  double cell = 1;
};

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, Grid{}};
  loop.step(1e-3);
}
