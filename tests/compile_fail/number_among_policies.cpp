// expect: delassus: a plain number is no argument of AnimationLoop; write it into the policy it is meant for, as in GaussSeidel{.tolerance = 1e-6}
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, 1e-6};
  loop.step(1e-3);
}
