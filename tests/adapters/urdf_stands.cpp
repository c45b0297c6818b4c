// A robot of a URDF file stands on motors of its joints.
#include <delassus/adapters/urdf.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <variant>
#include <vector>

namespace urdf_stands_tests {

using namespace delassus;

// Motors of 200 N·m/rad and 5 N·m·s/rad with the caps of the file. A step gives the weight a speed g h = 0.02
// m/s; the solver leaves 1e-10 m/s in each of some hundred rows, which is 1e-6 of it at most.
TEST_CASE("go1 is let go above the ground and stands") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  Model model = read_urdf(std::string(folder) + "/urdf/robots/go1.urdf");
  std::vector<double> bent(model.joints.size(), 0);
  for (std::size_t j = 0; j < bent.size(); ++j) {
    const model::Joint& joint = model.joints[j];
    if (joint.kind != model::JointKind::hinge) continue;
    bent[j] = joint.name.find("thigh") != std::string::npos  ? 0.8
              : joint.name.find("calf") != std::string::npos ? -1.6
                                                             : 0;
    model::Actuator motor{.name = joint.name, .target = Index(j), .gain = 200, .bias = {0, -200, -5}};
    motor.force_is_limited = true, motor.force_lower = -joint.effort, motor.force_upper = joint.effort;
    model.actuators.push_back(motor);
  }
  REQUIRE(model.actuators.size() == 12);

  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.8}}, Hinge{}, Limit<Turn>{},
                                 SpringDamper<Turn>{}, Drive<Turn>{}, Motor<Turn>{}},
                     WithFilter{WithCompounds{NativeCollision{}}}, DirectGaussSeidel{.tolerance = 1e-10}};
  Machine machine = add(loop, model, {}, Base::free);
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  JointSpace space(model, Base::free);
  std::vector<double> q(std::size_t(space.q_size())), v(std::size_t(space.v_size()), 0);
  space.reference(q);
  for (std::size_t k = 0; k < model.actuators.size(); ++k) {
    const std::size_t joint = std::size_t(model.actuators[k].target);
    machine.controls[k] = q[std::size_t(space.q_of(Index(joint)))] = bent[joint];
  }
  set_joint_state(loop, machine, space, q, v);
  double lowest = std::numeric_limits<double>::infinity();  // of the feet
  for (const model::Geometry& g : model.geometries)
    if (const auto* foot = std::get_if<Sphere>(&g.shape))
      lowest = std::min(lowest, pose_of(set, machine, g.body).to_world(g.pose.position).z() - foot->radius);
  q[2] += 0.01 - lowest;
  set_joint_state(loop, machine, space, q, v);

  double weight = 0;
  for (const Index b : set.active())
    if (set.moves(b)) weight += norm(set.gravity) / set.state().inverse_mass[b];
  const auto trunk = [&] { return pose_of(set, machine, 0).position; };
  const double h = 2e-3, start = trunk().z();
  Vec3 stood = zero<Vec3>();
  double moved = 0, missing = 0;
  bool stands = false;
  while (loop.time() < 10) {
    actuate(loop, machine, h);
    loop.step(h);
    if (loop.time() < 2) continue;
    if (!stands) stood = trunk(), stands = true;
    moved = std::max(moved, norm(Vec3(trunk() - stood)));
    double carried = 0;
    for (const auto& c : loop.contacts())
      if (!set.moves(c.record.a.block) || !set.moves(c.record.b.block))
        carried += std::abs(c.impulse.z()) / h;
    missing = std::max(missing, std::abs(carried / weight - 1));
  }
  CHECK(start - stood.z() > 0.01);  // m: it fell that far, and yielded
  CHECK(stood.z() > 0.28);
  CHECK(moved < 1e-3);
  CHECK(missing < 1e-6);
}

}  // namespace urdf_stands_tests
