// expect: delassus: an AnimationLoop needs exactly one World{...}; name the body sets of the scene in it
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{Constraints{BallJoint{}}};
  loop.step(1e-3);
}
