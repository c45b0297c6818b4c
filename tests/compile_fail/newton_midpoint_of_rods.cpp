// expect: delassus: NewtonMidpoint moves rigid bodies only
#include <delassus/delassus.hpp>
#include <delassus/fem/rods.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Rods{}}, NewtonMidpoint{}};
  loop.step(1e-3);
}
