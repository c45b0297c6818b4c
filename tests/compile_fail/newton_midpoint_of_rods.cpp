// expect: delassus: NewtonMidpoint moves rigid bodies only
#include <delassus/bodies/rods.hpp>
#include <delassus/delassus.hpp>
#include <delassus/loop/newton_midpoint.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Rods{}}, NewtonMidpoint{}};
  loop.step(1e-3);
}
