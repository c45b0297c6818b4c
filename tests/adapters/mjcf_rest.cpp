// Machines of files fall on their floors and come to rest.
#include <delassus/adapters/mjcf.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace mjcf_rest_tests {

using namespace delassus;

namespace {

struct Rest {
  double highest = 0;  ///< kinetic energy, J
  double most = 0;     ///< the same from 30 s on
  double missing = 0;  ///< share of the weight that the floor does not carry from 30 s on
};

/// Lets a machine fall for 32 s, its hinges `lean` rad off their reference on the right and in the middle.
Rest fall(auto&& loop, const Model& model, double lean) {
  const Machine machine = add(loop, model, {}, Base::as_file, {.actuators = true});
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = model.gravity;
  JointSpace space(model);
  std::vector<double> q(std::size_t(space.q_size())), v(std::size_t(space.v_size()), 0);
  space.reference(q);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (model.joints[j].kind == model::JointKind::hinge && model.joints[j].name.find("left") == std::string::npos)
      q[std::size_t(space.q_of(Index(j)))] += lean;
  if (lean != 0) set_joint_state(loop, machine, space, q, v);
  double weight = 0;
  for (const Index b : set.active())
    if (set.moves(b)) weight += norm(model.gravity) / set.state().inverse_mass[b];
  Rest rest;
  const double h = 5e-3;
  while (loop.time() < 32) {
    loop.step(h);
    rest.highest = std::max(rest.highest, kinetic_energy(set));
    if (loop.time() < 30) continue;
    double carried = 0;
    for (const auto& c : loop.contacts())
      if (!set.moves(c.record.a.block) || !set.moves(c.record.b.block)) carried += std::abs(c.impulse.z()) / h;
    rest.most = std::max(rest.most, kinetic_energy(set));
    rest.missing = std::max(rest.missing, std::abs(carried / weight - 1));
  }
  return rest;
}

}  // namespace

// Joint damping and friction take all energy. At rest the floor carries the weight, to what the solver leaves.
TEST_CASE("walker, hopper and cheetah fall, come to rest, and the floor carries their weight") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  for (const char* name : {"walker", "hopper", "cheetah"}) {
    const Model model = read_mjcf(std::string(folder) + "/mjcf/dm_control/" + name + ".xml");
    const Rest rest = fall(AnimationLoop{World{RigidBodies{}},
                                         Constraints{Contact{Coulomb{.friction = 0.8}}, Hinge{}, SerialJoint<2, 1>{}, Limit<Turn>{},
                                                     SpringDamper<Turn>{}, SpringDamper<Slide>{}, RotorInertia<Turn>{}},
                                         WithFilter{WithCompounds{NativeCollision{}}}, DirectGaussSeidel{.tolerance = 1e-8}},
                           model, 0);
    CAPTURE(name);
    CHECK(rest.highest > 1);  // J: it fell
    CHECK(rest.most < 1e-6);
    CHECK(rest.missing < 1e-6);
  }
}

// The same of two humanoids. One of them would balance on its way down for a while: it begins off its symmetry.
TEST_CASE("humanoids fall, come to rest, and the floor carries their weight", "[.]") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  for (const std::string name : {"mujoco/humanoid", "dm_control/humanoid"}) {
    const Model model = read_mjcf(std::string(folder) + "/mjcf/" + name + ".xml");
    const Rest rest = fall(
        AnimationLoop{World{RigidBodies{}},
                      Constraints{Contact{Coulomb{.friction = 0.8}}, Hinge{}, SerialJoint<0, 2>{}, SerialJoint<0, 3>{}, Limit<Turn>{},
                                  Limit<Precession>{}, Limit<Nutation>{}, Limit<Spin>{}, SpringDamper<Turn>{}, SpringDamper<Precession>{},
                                  SpringDamper<Nutation>{}, SpringDamper<Spin>{}, RotorInertia<Turn>{}, RotorInertia<Precession>{},
                                  RotorInertia<Nutation>{}, RotorInertia<Spin>{}, TendonLimit<2>{}},
                      WithFilter{WithCompounds{NativeCollision{}}}, DirectGaussSeidel{.tolerance = 1e-8}},
        model, name == "dm_control/humanoid" ? 0.1 : 0);
    CAPTURE(name);
    CHECK(rest.highest > 1);
    CHECK(rest.most < 1e-6);
    CHECK(rest.missing < 1e-6);
  }
}

}  // namespace mjcf_rest_tests
