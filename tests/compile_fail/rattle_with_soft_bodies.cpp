// expect: delassus: NewtonMidpoint moves rigid bodies only, Rattle and RungeKutta4 those and particles
#include <delassus/bodies/elasticity/corotational.hpp>
#include <delassus/bodies/tetrahedral_fem.hpp>
#include <delassus/delassus.hpp>
#include <delassus/loop/rattle.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{TetrahedralFem<Corotational>{}}, Rattle{}};
  loop.step(1e-3);
}
