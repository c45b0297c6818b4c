// A user's program: everything the package installs must be there for it to compile.
#ifdef CONSUMER_USES_COMPILED
#include <delassus/compiled.hpp>
#else
#include <delassus/delassus.hpp>
#endif

#ifdef CONSUMER_USES_FCL
#include <delassus/adapters/fcl.hpp>
#endif
#ifdef CONSUMER_USES_CCD
#include <delassus/adapters/ccd.hpp>
#endif

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto box = rigid.add({.position = {0, 0, 5}, .mass = 2.0, .shape = Box{1, 1, 1}});
  loop.step(1e-3);
  return rigid.position(box).z() < 5 ? 0 : 1;
}
