// Machines of files that stand, topple and swing: a quadruped on its actuators, dominos, a cradle on strings.
#include <delassus/adapters/mjcf.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/actuators.hpp>
#include <delassus/model/add.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace mjcf_stands_tests {

using namespace delassus;

// Servos of joints and of tendons hold it, dampers take what is left of the fall, couplings are rigid. What
// the torso still does from 5 s on is what the solver leaves.
TEST_CASE("a quadruped stands on its actuators and its tendons stay coupled") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  Model model = read_mjcf(std::string(folder) + "/mjcf/dm_control/quadruped.xml");
  // The ball is its last body.
  const Index ball = Index(model.bodies.size()) - 1;
  REQUIRE(model.bodies.back().joints == std::vector<Index>{Index(model.joints.size()) - 1});
  std::erase_if(model.geometries, [&](const model::Geometry& g) { return g.body == ball; });
  model.bodies.pop_back();
  model.joints.pop_back();

  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 1}}, Hinge{}, SerialJoint<0, 2>{}, Limit<Turn>{},
                                 Limit<Precession>{}, Limit<Spin>{}, SpringDamper<Turn>{},
                                 SpringDamper<Precession>{}, SpringDamper<Spin>{}, RotorInertia<Turn>{},
                                 RotorInertia<Precession>{}, RotorInertia<Spin>{}, Tendon<3>{}},
                     WithFilter{WithCompounds{NativeCollision{}}}, DirectGaussSeidel{.tolerance = 1e-8}};
  Machine machine = add(loop, model);
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = model.gravity;
  REQUIRE(model.couplings.size() == 4);
  REQUIRE(machine.actuators.size() == 12);
  const double h = 5e-3;
  Vec3 stood = zero<Vec3>();
  double moved = 0, apart = 0;
  bool stands = false;
  const double start = pose_of(set, machine, 0).position.z();
  while (loop.time() < 15) {
    actuate(loop, machine, h);
    loop.step(h);
    if (loop.time() < 5) continue;
    const Vec3 torso = pose_of(set, machine, 0).position;
    if (!stands) stood = torso, stands = true;
    moved = std::max(moved, norm(Vec3(torso - stood)));
    for (const model::Coupling& coupling : model.couplings) {
      double length = 0;
      for (const model::TendonJoint& j : model.tendons[std::size_t(coupling.joint)].joints)
        length += j.coefficient * position_of(loop.world(), machine, j.joint);
      apart = std::max(apart, std::abs(length));
    }
  }
  CHECK(stood.z() > 0.4);           // m, on its legs
  CHECK(start - stood.z() > 0.05);  // it came down
  CHECK(moved < 1e-3);
  CHECK(apart < 1e-3);
}

// With the friction of the file, which is 1.
TEST_CASE("all dominos fall") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  const Model model = read_mjcf(std::string(folder) + "/mjcf/mujoco/dominos.xml");
  REQUIRE(model.bodies.size() == 96);
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 1}}}, NativeCollision{},
                     AcceleratedGaussSeidel{.tolerance = 1e-5}};
  const Machine machine = add(loop, model);
  auto& set = bodies<RigidBodies>(loop.world());
  const auto fallen = [&] {
    int count = 0;
    for (Index b = 0; b < 96; ++b) count += pose_of(set, machine, b).rotation(2, 2) < std::sqrt(0.5);
    return count;
  };
  int before = fallen();
  CHECK(before == 0);
  while (loop.time() < 10) {
    loop.step(2e-3);
    if (loop.time() > 4 && loop.time() < 4.0021) before = fallen();
  }
  CHECK(before > 10);
  CHECK(before < 80);  // one after the other
  CHECK(fallen() == 96);
}

namespace {

/// As MuJoCo's newton_cradle: steel balls of 2 cm, each on two strings. The first is up by `angle` rad, the
/// others touch but for 1 µm.
std::string cradle(int balls, double angle) {
  std::string bodies, strings;
  const double length = std::hypot(0.032, 0.142), pi = 3.14159265358979323846;
  for (int k = 0; k < balls; ++k) {
    const std::string n = std::to_string(k);
    const double x = k * 0.040001, up = k == 0 ? angle : 0;
    bodies += "<site name='a" + n + "' pos='" + inner::text(x) + " -.04 .2'/><site name='c" + n + "' pos='" +
              inner::text(x) + " .04 .2'/>" + "<body name='ball " + n + "' pos='" +
              inner::text(x - 0.16 * std::sin(up)) + " 0 " + inner::text(0.2 - 0.16 * std::cos(up)) +
              "' euler='0 " + inner::text(up * 180 / pi) +
              " 0'><freejoint/><geom size='.02' density='8000'/>" + "<site name='b" + n +
              "' pos='0 -.008 .018'/><site name='d" + n + "' pos='0 .008 .018'/></body>";
    for (const std::string ends : {"ab", "cd"})
      strings += "<spatial limited='true' range='0 " + inner::text(length) + "'><site site='" + ends[0] + n +
                 "'/><site site='" + ends[1] + n + "'/></spatial>";
  }
  return "<mujoco><worldbody>" + bodies + "</worldbody><tendon>" + strings + "</tendon></mujoco>";
}

}  // namespace

// The ball that comes turns once a swing, and keeps that: ½ (2/5) m r² θ̇² of ½ m l² θ̇², with r = 2 cm and l =
// 16 cm 0.6 %.
TEST_CASE("a cradle of five balls on strings: one up and one out") {
  const Model model = parse_mjcf(cradle(5, 0.6), "cradle.xml");
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{SequentialRestitution{Frictionless{}, 1.}}, Limit<Length>{}},
                     NativeCollision{}, DirectGaussSeidel{.tolerance = 1e-10}};
  const Machine machine = add(loop, model);
  auto& set = bodies<RigidBodies>(loop.world());
  const auto energy = [&](int k) {
    const auto body = machine.parts[std::size_t(k)].body;
    const double mass = model.bodies[std::size_t(k)].mass;
    return mass * (0.5 * squared_norm(set.velocity(body)) +
                   0.2 * 0.02 * 0.02 * squared_norm(set.angular_velocity(body)) +
                   9.81 * (set.position(body).z() - 0.04));
  };
  const double start = energy(0);
  double out = 0, others = 0;
  while (loop.time() < 0.6) {  // half a swing is 0.4 s
    loop.step(1e-4);
    if (energy(4) <= out) continue;
    out = energy(4), others = 0;
    for (int k = 1; k < 4; ++k) others = std::max(others, energy(k));
  }
  CHECK(out >= 0.99 * start);
  CHECK(out < 1.001 * start);
  CHECK(others < 1e-3 * start);
}

}  // namespace mjcf_stands_tests
