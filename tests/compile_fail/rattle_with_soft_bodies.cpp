// expect: delassus: NewtonMidpoint moves rigid bodies only, Rattle and RungeKutta4 those and particles
#include <delassus/delassus.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/steppers/rattle.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{TetrahedralFem<Corotational>{}}, Rattle{}};
  loop.step(1e-3);
}
