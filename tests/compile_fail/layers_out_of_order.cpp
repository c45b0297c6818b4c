// expect: delassus: the layers of a collision go around a backend and each other in this order, each at most once: WithFilter{WithSurfaces{WithCompounds{WithMeshes{Seamless{NativeCollision{}}}}}}
#include <delassus/delassus.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}},
                     WithCompounds{WithFilter{NativeCollision{}}}};
  loop.step(1e-3);
}
