// expect: delassus: UncoupledCompliance takes the mass of each node alone, which this set of bodies does not give (Rods do not); use AssembledCompliance
#include <delassus/delassus.hpp>
#include <delassus/bodies/rods.hpp>
#include <delassus/compliance/uncoupled.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Rods{}}, Constraints{BallJoint{}}, ImplicitEuler{}, UncoupledCompliance{}};
  loop.step(1e-3);
}
