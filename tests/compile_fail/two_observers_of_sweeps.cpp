// expect: delassus: of the listeners with `every_sweep` a solver tells one
#include <delassus/delassus.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, ConvergenceRecord{}, BasicConvergenceRecord<float>{}};
  loop.step(1e-3);
}
