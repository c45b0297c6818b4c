// expect: delassus: Substeps and ErrorControlled make a step in parts; take the activity, Sleeping or HandPicked, out
#include <delassus/delassus.hpp>
#include <delassus/schemes/substeps.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, Substeps{}, Sleeping{}};
  loop.step(1e-3);
}
