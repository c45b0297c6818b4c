// expect: delassus: UncoupledCompliance takes the mass of each node alone, which this set of bodies does not give (Rods do not); use AssembledCompliance
#include <delassus/delassus.hpp>
#include <delassus/compliance/uncoupled.hpp>
#include <delassus/fem/rods.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Rods{}}, Constraints{BallJoint{}}, ImplicitEuler{}, UncoupledCompliance{}};
  loop.step(1e-3);
}
