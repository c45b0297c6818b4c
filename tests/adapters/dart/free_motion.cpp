// Machines of URDF files that move freely, beside DART: masses, frames, joints and dampers are read by its reader, and the motion is the same.
#include "catch.hpp"

#include <delassus/adapters/urdf.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/add.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <dart/dynamics/DegreeOfFreedom.hpp>
#include <dart/dynamics/Joint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/utils/urdf/DartLoader.hpp>
#include <tinyxml2.h>

namespace dart_free_motion_tests {

using namespace delassus;

namespace {

/// Numbers of hinges and slides, by name.
using Numbers = std::map<std::string, double>;

/// A start: angles (rad) and ways (m) to 0.3 from where the file has them, rates to 1.
struct Start {
  Numbers q, v;
};

Start start_of(const Model& model) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  Start start;
  for (const model::Joint& joint : model.joints)
    if (inner::has_one_freedom(joint)) {
      start.q[joint.name] = joint.reference + 0.3 * draw(random);
      start.v[joint.name] = draw(random);
    }
  return start;
}

/// The robot without its shapes, whose meshes DART needs to be there, and without an inertia of no mass, of which it warns.
std::string bare(const std::string& path) {
  tinyxml2::XMLDocument file;
  REQUIRE(file.LoadFile(path.c_str()) == tinyxml2::XML_SUCCESS);
  for (tinyxml2::XMLElement* link = file.RootElement()->FirstChildElement("link"); link; link = link->NextSiblingElement("link"))
    for (const char* part : {"visual", "collision", "inertial"})
      for (tinyxml2::XMLElement *e = link->FirstChildElement(part), *next = nullptr; e; e = next) {
        next = e->NextSiblingElement(part);
        const tinyxml2::XMLElement* mass = e->FirstChildElement("mass");
        if (!mass || mass->DoubleAttribute("value") == 0) link->DeleteChild(e);
      }
  tinyxml2::XMLPrinter text;
  file.Print(&text);
  return text.CStr();
}

/// q after a second by RK4 with DART's accelerations: no contacts, stops, dry friction, mimics and motors.
Numbers by_dart(const std::string& path, const Start& start, double h) {
  // DART gives a link without <inertial> 1 kg, where ours has none; of 0 it warns.
  const dart::dynamics::Inertia none(1e-12, Vec3::Zero(), 1e-12 * Mat3::Identity());
  dart::utils::DartLoader reader({nullptr, dart::utils::DartLoader::RootJointType::FIXED, none});
  const dart::dynamics::SkeletonPtr skeleton = reader.parseSkeletonString(bare(path), dart::common::Uri::createFromPath(path));
  REQUIRE(skeleton);
  const std::size_t freedoms = skeleton->getNumDofs();
  using Vector = Eigen::VectorXd;
  // Its own damping is implicit and hangs on its time step, so it acts as a force here.
  Vector damping = Vector::Zero(Eigen::Index(freedoms)), q = damping, v = damping;
  for (std::size_t k = 0; k < freedoms; ++k) {
    dart::dynamics::DegreeOfFreedom& freedom = *skeleton->getDof(k);
    INFO(freedom.getName());
    dart::dynamics::Joint& joint = *freedom.getJoint();
    joint.setActuatorType(dart::dynamics::Joint::FORCE);
    joint.setLimitEnforcement(false);
    damping[Eigen::Index(k)] = freedom.getDampingCoefficient();
    freedom.setDampingCoefficient(0);
    freedom.setCoulombFriction(0);
    REQUIRE(start.q.contains(freedom.getName()));
    q[Eigen::Index(k)] = start.q.at(freedom.getName());
    v[Eigen::Index(k)] = start.v.at(freedom.getName());
  }
  REQUIRE(freedoms == start.q.size());
  const auto acceleration = [&](const Vector& at, const Vector& rate) {
    skeleton->setPositions(at);
    skeleton->setVelocities(rate);
    skeleton->setForces(-damping.cwiseProduct(rate));
    skeleton->computeForwardDynamics();
    return Vector(skeleton->getAccelerations());
  };
  for (long n = std::lround(1 / h); n > 0; --n) {
    const Vector a1 = acceleration(q, v), v2 = v + 0.5 * h * a1;
    const Vector a2 = acceleration(q + 0.5 * h * v, v2), v3 = v + 0.5 * h * a2;
    const Vector a3 = acceleration(q + 0.5 * h * v2, v3), v4 = v + h * a3;
    const Vector a4 = acceleration(q + h * v3, v4);
    q += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  Numbers reached;
  for (std::size_t k = 0; k < freedoms; ++k) reached[skeleton->getDof(k)->getName()] = q[Eigen::Index(k)];
  return reached;
}

/// q after a second, by steps of `h` s.
Numbers by_delassus(const Model& model, const Start& start, double h) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Hinge{}, Slider{}, SerialJoint<2, 1>{}, SpringDamper<Turn>{}, SpringDamper<Slide>{}},
                     NewtonMidpoint{}};
  const LeaveOut off{.contacts = true, .limits = true, .friction_loss = true, .couplings = true, .actuators = true};
  const Machine machine = add(loop, model, {}, Base::fixed, off);
  bodies<RigidBodies>(loop.world()).gravity = model.gravity;
  JointSpace space(model, Base::fixed);
  std::vector<double> q(std::size_t(space.q_size())), v(std::size_t(space.v_size()));
  space.reference(q);
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (const std::string& name = model.joints[j].name; start.q.contains(name)) {
      q[std::size_t(space.q_of(Index(j)))] = start.q.at(name);
      v[std::size_t(space.v_of(Index(j)))] = start.v.at(name);
    }
  set_joint_state(loop, machine, space, q, v);
  for (long n = std::lround(1 / h); n > 0; --n) loop.step(h);
  Numbers reached;
  for (std::size_t j = 0; j < model.joints.size(); ++j)
    if (const std::string& name = model.joints[j].name; start.q.contains(name))
      reached[name] = position_of(loop.world(), machine, Index(j));
  return reached;
}

/// The largest difference of a joint, rad or m; of hinges up to whole turns.
double difference(const Model& model, const Numbers& a, const Numbers& b) {
  double most = 0;
  for (const model::Joint& joint : model.joints)
    if (inner::has_one_freedom(joint)) {
      const double d = a.at(joint.name) - b.at(joint.name);
      most = std::max(most, std::abs(joint.kind == model::JointKind::hinge ? std::remainder(d, 2 * M_PI) : d));
    }
  return most;
}

}  // namespace

// NewtonMidpoint is of second order: with h/2 the difference falls to a quarter. RK4 at 2e-4 s is right to 2e-9 here.
TEST_CASE("machines of URDF files move freely as in DART") {
  const char* folder = std::getenv("DELASSUS_MODELS");
  if (!folder) {
    WARN("DELASSUS_MODELS does not name the folder of models: skipped");
    return;
  }
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(folder) / "urdf"))
    if (entry.path().extension() == ".urdf") files.push_back(entry.path().string());
  int compared = 0, moved = 0;
  for (const std::string& path : files) {
    CAPTURE(path);
    Model model;
    try {
      model = read_urdf(path, {.base = Base::fixed});
    } catch (const InvalidArgument&) {
      continue;  // urdf_models.cpp has the reasons
    }
    const Start start = start_of(model);
    const auto names = [&](const std::string& part) { return path.find(part) != path.npos; };
    // Nothing moves in the one; links of the other have an inertia that no solid has, which no loop takes.
    if (start.q.empty() || names("TwoJointRobot")) continue;
    ++compared;
    const Numbers truth = by_dart(path, start, 2e-4);
    moved += difference(model, truth, start.q) > 0.05;
    // The panda throws its fingers 3 m out, and turns its last joint by 10 rad.
    const double h = names("panda") ? 5e-4 : 1e-3;
    const double coarse = difference(model, by_delassus(model, start, 2 * h), truth), fine = difference(model, by_delassus(model, start, h), truth);
    CHECK(fine < 1e-3);
    CHECK(coarse / fine == Approx(4).epsilon(0.1));
  }
  CHECK(compared == 11);
  CHECK(moved == 11);  // rad or m
}

}  // namespace dart_free_motion_tests
