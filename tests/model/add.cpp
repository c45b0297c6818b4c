#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/add.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include "catch.hpp"

#include <cmath>
#include <string>

namespace add_tests {

using namespace delassus;

namespace {

/// A rod of a metre that hangs on a hinge about y at the origin, and a second one on its end.
Model double_pendulum() {
  Model model{.name = "double pendulum"};
  for (int k = 0; k < 2; ++k) {
    model.joints.push_back({.name = "hinge " + std::to_string(k), .axis = {0, 1, 0}});
    model.bodies.push_back({.name = "rod " + std::to_string(k),
                            .parent = Index(k - 1),
                            .pose = {Vec3(0, 0, k == 0 ? 0. : -1.), Mat3::Identity()},
                            .mass = 1,
                            .centre = {0, 0, -0.5},
                            .inertia = Mat3(Vec3(1. / 12, 1. / 12, 1e-3).asDiagonal()),
                            .joints = {Index(k)}});
  }
  return model;
}

auto bare_loop(auto... laws) { return AnimationLoop{World{RigidBodies{}}, Constraints{laws...}, NewtonMidpoint{}}; }

}  // namespace

// A rod on a hinge at its end: θ'' = −(3/2)(g/l) sin θ; a quarter of a swing from θ₀ is K(sin θ₀/2)/√(3g/2l).
TEST_CASE("a machine of hinges moves as its equations say, and its joints are read back") {
  Model model = double_pendulum();
  model.bodies.resize(1), model.joints.resize(1);
  model.joints[0].reference = 0.5;  // its zero is elsewhere
  auto loop = bare_loop(Hinge{});
  const Machine machine = add(loop, model, Pose{Vec3(1, 2, 3), Quat(Eigen::AngleAxisd(0.8, Vec3::UnitY())).toRotationMatrix()});
  auto& set = bodies<RigidBodies>(loop.world());
  CHECK(machine.left_out.empty());
  CHECK(position_of(loop.world(), machine, 0) == Approx(0.5));
  CHECK((pose_of(set, machine, 0).position - Vec3(1, 2, 3)).norm() < 1e-15);
  const double w = std::sqrt(1.5 * 9.81), k = std::sin(0.4);
  double a = 1, b = std::sqrt(1 - k * k);  // K by the mean of arithmetic and geometric means
  for (int n = 0; n < 6; ++n) {
    const double next = 0.5 * (a + b);
    b = std::sqrt(a * b), a = next;
  }
  const double quarter = M_PI / (2 * a) / w, h = quarter / 1000;
  for (int n = 0; n < 1000; ++n) loop.step(h);
  CHECK(std::abs(position_of(loop.world(), machine, 0) - 0.5 + 0.8) < 1e-5);  // hangs straight down: −0.8 from where it was
  CHECK(set.active().size() == 1);
}

TEST_CASE("links that are fixed to each other are one body, and a fixed root is the world") {
  Model model = double_pendulum();
  model.bodies[1].joints.clear();
  model.joints.resize(1);
  auto loop = bare_loop(Hinge{});
  const Machine machine = add(loop, model);
  auto& set = bodies<RigidBodies>(loop.world());
  REQUIRE(set.active().size() == 1);
  CHECK(set.state().inverse_mass[0] == 0.5);
  CHECK((set.position(set.handle(0)) - Vec3(0, 0, -1)).norm() < 1e-15);  // the common centre
  CHECK((pose_of(set, machine, 1).position - Vec3(0, 0, -1)).norm() < 1e-15);
  // A rod of 2 m: 4/12 m about its centre.
  Mat3 inertia = Mat3::Zero();
  inertia.diagonal() << 2 * 4. / 12, 2 * 4. / 12, 2e-3;
  CHECK((set.inertia(0) - inertia).norm() < 1e-12);

  model.bodies[0].joints.clear();
  model.joints.clear();
  auto still = bare_loop(Hinge{});
  const Machine nothing = add(still, model);
  CHECK(bodies<RigidBodies>(still.world()).active().size() == 0);
  CHECK(nothing.parts[1].is_world);
  auto flies = bare_loop(Hinge{});
  const Machine one = add(flies, model, {}, Base::free);
  CHECK(bodies<RigidBodies>(flies.world()).active().size() == 1);
  CHECK_FALSE(one.parts[0].is_world);
}

TEST_CASE("what a loop does not name is said in one sentence, and nothing is added") {
  Model model = double_pendulum();
  model.joints[0].is_limited = true, model.joints[0].lower = -1, model.joints[0].upper = 1;
  model.joints[1].damping = 0.1;
  model.joints[1].friction_loss = 0.2;
  model.geometries.push_back({.name = "bob", .body = 1, .pose = {Vec3(0, 0, -1), Mat3::Identity()}, .shape = Sphere{0.1}});
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}, BallJoint{}}};
  CHECK_THROWS_WITH(add(loop, model), Catch::Contains("Hinge{}") && Catch::Contains("Limit<Turn>{}") && Catch::Contains("SpringDamper<Turn>{}") &&
                                          Catch::Contains("Motor<Turn>{}") && Catch::Contains("WithCompounds{...}"));
  CHECK(bodies<RigidBodies>(loop.world()).active().size() == 0);
  auto less = bare_loop(Hinge{});
  add(less, model, {}, Base::as_file, {.contacts = true, .limits = true, .damping = true, .friction_loss = true});
  CHECK(bodies<RigidBodies>(less.world()).active().size() == 2);
}

TEST_CASE("limits, springs, friction and couplings of a machine act on its joints") {
  Model model = double_pendulum();
  for (model::Body& body : model.bodies) body.parent = -1, body.pose = {};
  model.bodies[1].pose.position = {0, 1, 0};
  model.joints[0].reference = 0.2;
  model.joints[0].is_limited = true, model.joints[0].lower = -0.1, model.joints[0].upper = 0.9;
  model.joints[0].stiffness = 100, model.joints[0].damping = 1, model.joints[0].spring_reference = 5;  // into its stop
  model.joints[1].damping = 1;
  model.couplings.push_back({.name = "gear", .joint = 1, .other = 0, .coefficients = {0.1, 2, 0, 0, 0}});
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}, SpringDamper<Turn>{}, Gear{}}, AcceleratedGaussSeidel{.tolerance = 1e-10}};
  const Machine machine = add(loop, model);
  for (int n = 0; n < 2000; ++n) loop.step(2e-3);
  CHECK(position_of(loop.world(), machine, 0) == Approx(0.9).margin(1e-4));
  CHECK(position_of(loop.world(), machine, 1) == Approx(0.1 + 2 * 0.7).margin(1e-3));
}

// A rod of 2 kg whose root is a block around its hinge: they overlap, and would jam.
TEST_CASE("a link does not meet the fixed link that a joint holds it to, nor what it is excluded from") {
  for (const bool by_exclude : {false, true}) {
    Model model{.name = "arm"};
    model.bodies.push_back({.name = "base", .mass = 1, .inertia = Mat3(Mat3::Identity())});
    model.bodies.push_back({.name = "rod", .parent = by_exclude ? -1 : 0, .mass = 2, .centre = {0, 0, -0.5}, .inertia = Mat3(Vec3(0.2, 0.2, 0.01).asDiagonal()), .joints = {0}});
    model.joints.push_back({.name = "hinge", .axis = {0, 1, 0}});
    model.geometries.push_back({.name = "block", .body = 0, .shape = Box{0.3, 0.3, 0.3}});
    model.geometries.push_back({.name = "stick", .body = 1, .pose = {Vec3(0, 0, -0.5), Mat3::Identity()}, .shape = Box{0.1, 0.1, 1}});
    if (by_exclude) model.excludes.push_back({.body = 1, .other = 0});
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, Hinge{}}, WithFilter{WithCompounds{NativeCollision{}}}};
    const Machine machine = add(loop, model, {}, Base::fixed);
    bodies<RigidBodies>(loop.world()).gravity.setZero();
    for (int n = 0; n < 100; ++n) push_joint(loop, machine, 0, 0.5), loop.step(1e-2);
    CAPTURE(by_exclude);
    CHECK(loop.contacts().empty());
    CHECK(position_of(loop.world(), machine, 0) == Approx(0.5 * 0.5 / 0.7).epsilon(0.02));  // ½ τ t²/(I + m l²), and a step of it
  }
}

TEST_CASE("what a machine cannot be is refused before anything is added, and what holds nothing is named") {
  Model model{.name = "table"};
  model.joints = {{.name = "x", .kind = model::JointKind::slide, .axis = {1, 0, 0}},
                  {.name = "xy", .kind = model::JointKind::slide, .axis = Vec3(1, 1, 0).normalized()}};
  model.bodies.push_back({.name = "top", .mass = 1, .inertia = Mat3(Mat3::Identity()), .joints = {0, 1}});
  AnimationLoop loop{World{RigidBodies{}}, Constraints{SerialJoint<2, 0>{}, BallJoint{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  CHECK_THROWS_WITH(add(loop, model), Catch::Contains("top") && Catch::Contains("right angles"));
  CHECK(set.active().size() == 0);
  model.joints[1].axis = {0, 1, 0};
  model.bodies.push_back({.name = "vase", .parent = 0, .mass = 1, .inertia = Mat3(Mat3::Identity())});
  model.connects.push_back({.name = "glue", .body = 0, .other = 1});
  const Machine machine = add(loop, model);
  REQUIRE(machine.left_out.size() == 1);
  CHECK(machine.left_out[0].find("glue") != std::string::npos);
  CHECK_THROWS_WITH(position_of(loop.world(), machine, 7), Catch::Contains("joint 7"));
  CHECK_THROWS_WITH(push_joint(loop, machine, -1, 1), Catch::Contains("joint -1"));
}

TEST_CASE("a machine whose shapes are not in the middle of its bodies stands on them") {
  Model model{.name = "table"};
  model.joints.push_back({.name = "root", .kind = model::JointKind::free});
  model.bodies.push_back({.name = "top", .pose = {Vec3(0, 0, 1.2), Mat3::Identity()}, .mass = 10, .centre = {0.1, 0, -0.1},
                          .inertia = Mat3(Mat3::Identity()), .joints = {0}});
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.4, 0.4})
      model.geometries.push_back({.name = "leg", .body = 0, .pose = {Vec3(x, y, -0.5), Mat3::Identity()}, .shape = Capsule{0.05, 0.9}});
  model.geometries.push_back({.name = "floor", .body = -1, .shape = model::Plane{}});
  for (std::size_t g = 0; g < 4; ++g) model.geometries[g].name += std::to_string(g);
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, WithCompounds{NativeCollision{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-8}};
  const Machine machine = add(loop, model);
  auto& set = bodies<RigidBodies>(loop.world());
  for (int n = 0; n < 600; ++n) loop.step(1. / 240);
  const Pose top = pose_of(set, machine, 0);
  CHECK(top.position.z() == Approx(1).margin(1e-3));  // legs of a metre
  CHECK((top.rotation - Mat3::Identity()).norm() < 1e-2);
  // The nearer legs bear more: moments about the centre, 0.1 m off.
  double front = 0, back = 0;
  for (const auto& contact : loop.contacts()) (contact.record.point().x() > 0 ? front : back) += std::abs(contact.impulse.z()) * 240;
  CHECK(front + back == Approx(98.1).margin(0.01));
  CHECK(front == Approx(98.1 * 0.6).margin(0.5));
}

}  // namespace add_tests
