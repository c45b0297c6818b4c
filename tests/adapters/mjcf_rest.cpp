// Machines of files fall on their floors and come to rest.
#include <delassus/adapters/mjcf.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/add.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

namespace mjcf_rest_tests {

using namespace delassus;

// Joint damping and friction take all energy. At rest the floor carries the weight, to what the solver leaves.
TEST_CASE("walker, hopper and cheetah fall, come to rest, and the floor carries their weight") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  for (const char* name : {"walker", "hopper", "cheetah"}) {
    const Model model = read_mjcf(std::string(folder) + "/mjcf/dm_control/" + name + ".xml");
    AnimationLoop loop{World{RigidBodies{}},
                       Constraints{Contact{Coulomb{.friction = 0.8}}, Hinge{}, SerialJoint<2, 1>{}, Limit<Turn>{}, SpringDamper<Turn>{},
                                   SpringDamper<Slide>{}, RotorInertia<Turn>{}},
                       WithFilter{WithCompounds{NativeCollision{}}}, DirectGaussSeidel{.tolerance = 1e-8}};
    const Machine machine = add(loop, model);
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity = model.gravity;
    double weight = 0, highest = 0, most = 0, missing = 0;
    for (const Index b : set.active())
      if (set.moves(b)) weight += norm(model.gravity) / set.state().inverse_mass[b];
    const double h = 5e-3;
    int unconverged = 0;
    while (loop.time() < 32) {
      unconverged += loop.step(h).status != Status::converged;
      highest = std::max(highest, kinetic_energy(set));
      if (loop.time() < 30) continue;
      double carried = 0;
      for (const auto& c : loop.contacts())
        if (!set.moves(c.record.a.block) || !set.moves(c.record.b.block)) carried += std::abs(c.impulse.z()) / h;
      most = std::max(most, kinetic_energy(set));
      missing = std::max(missing, std::abs(carried / weight - 1));
    }
    CAPTURE(name, unconverged);
    CHECK(highest > 1);  // J: it fell
    CHECK(most < 1e-6);
    CHECK(missing < 1e-6);
  }
}

}  // namespace mjcf_rest_tests
