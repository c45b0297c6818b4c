// Every sentence with which a body, a spring, a step or a policy is refused.
#include <delassus/bodies/body_input.hpp>

#include <delassus/delassus.hpp>

#include <limits>
#include <vector>

#include "catch.hpp"

using namespace delassus;
using Catch::Contains;

namespace {

const double no_number = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

/// A sound body, for one thing to be spoilt.
RigidBody sound() { return {.mass = 1.0, .shape = Box{1, 1, 1}}; }
Mat3 diagonal(double x, double y, double z) { return Vec3(x, y, z).asDiagonal(); }

}  // namespace

TEST_CASE("a rigid body's mass must be finite and positive") {
  RigidBodies set;
  for (const double mass : {0.0, -1.0, no_number, infinity, -infinity}) {
    RigidBody body = sound();
    body.mass = mass;
    CHECK_THROWS_WITH(set.add(body),
                      "delassus: rigid body #0: mass " + inner::text(mass) + " must be finite and > 0");
    body.mass.reset();
    body.density = mass;
    CHECK_THROWS_WITH(set.add(body),
                      "delassus: rigid body #0: density " + inner::text(mass) + " must be finite and > 0");
  }
  CHECK(set.blocks() == 0);  // what is refused leaves nothing behind
}

TEST_CASE("a rigid body needs mass or density, not both, and an inertia from somewhere") {
  RigidBodies set;
  CHECK_THROWS_WITH(set.add({.shape = Box{1, 1, 1}}), Contains("give mass (kg) or density"));
  CHECK_THROWS_WITH(set.add({.mass = 1.0, .density = 1.0, .shape = Box{1, 1, 1}}),
                    Contains("mass or density, not both"));
  CHECK_THROWS_WITH(set.add({.mass = 1.0}), Contains("give an inertia (kg·m²) or a shape that has a volume"));
  CHECK_THROWS_WITH(set.add({.density = 1.0, .inertia = diagonal(1, 1, 1)}),
                    Contains("density needs a shape that has a volume"));
  CHECK_NOTHROW(set.add({.mass = 1.0, .inertia = diagonal(1, 1, 1)}));
}

TEST_CASE("an inertia that no body has is refused, with the rule it breaks") {
  RigidBodies set;
  const auto add = [&](const Mat3& inertia) { set.add({.mass = 1.0, .inertia = inertia}); };
  CHECK_THROWS_WITH(add(diagonal(1, 1, 2.1)),
                    Contains("rigid body #0") && Contains("(1, 1, 2.1)") && Contains("triangle inequality"));
  // Turned, so that no diagonal entry shows it.
  const Mat3 turn = Quat(0.3, 0.5, -0.2, 0.7).normalized().toRotationMatrix();
  CHECK_THROWS_WITH(add(turn * diagonal(1, 1, 2.1) * turn.transpose()), Contains("triangle inequality"));
  Mat3 lopsided = diagonal(1, 1, 1);
  lopsided(0, 1) = 0.1;
  CHECK_THROWS_WITH(add(lopsided), Contains("inertia is not symmetric"));
  CHECK_THROWS_WITH(add(diagonal(1, 1, 0)), Contains("not positive definite"));
  CHECK_THROWS_WITH(add(diagonal(1, 1, -1)), Contains("not positive definite"));
  CHECK_THROWS_WITH(add(diagonal(1, no_number, 1)), Contains("inertia is not finite"));
  CHECK_THROWS_WITH(add(diagonal(1, infinity, 1)), Contains("inertia is not finite"));
  // A flat plate and a needle are bodies: the inequality holds with equality there.
  CHECK_NOTHROW(add(diagonal(1, 1, 2)));
  CHECK_NOTHROW(add(diagonal(1, 1, 1e-6)));
}

TEST_CASE("a state that is not finite is refused, and so is the zero quaternion") {
  RigidBodies set;
  const auto refused = [&](auto spoil, const std::string& sentence) {
    RigidBody body = sound();
    spoil(body);
    CHECK_THROWS_WITH(set.add(body), Contains("delassus: rigid body #0: " + sentence));
  };
  refused([](RigidBody& b) { b.position.x() = no_number; }, "position is not finite");
  refused([](RigidBody& b) { b.position.z() = infinity; }, "position is not finite");
  refused([](RigidBody& b) { b.velocity.y() = no_number; }, "velocity is not finite");
  refused([](RigidBody& b) { b.angular_velocity.y() = -infinity; }, "angular velocity is not finite");
  refused([](RigidBody& b) { b.orientation = Quat(0, 0, 0, 0); },
          "orientation is the zero quaternion or not finite");
  refused([](RigidBody& b) { b.orientation = Quat(1, no_number, 0, 0); },
          "orientation is the zero quaternion or not finite");
  refused([](RigidBody& b) { b.orientation = Quat(1, infinity, 0, 0); },
          "orientation is the zero quaternion or not finite");
}

TEST_CASE("a quaternion of any length is a rotation") {
  RigidBodies set;
  RigidBody body = sound();
  body.orientation = Quat(3, 0, 4, 0);
  CHECK(set.orientation(set.add(body)).coeffs() == Quat(0.6, 0, 0.8, 0).coeffs());
}

TEST_CASE("a shape of no size is refused with its measure") {
  RigidBodies set;
  const auto refused = [&](const Shape& shape, const std::string& sentence) {
    CHECK_THROWS_WITH(set.add({.mass = 1.0, .shape = shape}),
                      "delassus: rigid body #0: " + sentence + " m must be finite and > 0");
  };
  refused(Sphere{0}, "sphere radius 0");
  refused(Sphere{-1}, "sphere radius -1");
  refused(Sphere{no_number}, "sphere radius nan");
  refused(Box{1, -2, 1}, "box edge y -2");
  refused(Capsule{0.1, 0}, "capsule height 0");
  refused(Cylinder{infinity, 1}, "cylinder radius inf");
  refused(Cone{1, -2}, "cone height -2");
  refused(Ellipsoid{1, 1, 0}, "ellipsoid semi-axis c 0");
  CHECK_THROWS_WITH(set.add_fixed(Sphere{1e200}), Contains("sphere radius 1e+200 m must be <= 1e100 m"));
  CHECK_THROWS_WITH(set.add_fixed(HalfSpace{.normal = Vec3::Zero()}),
                    Contains("half-space normal is zero or not finite"));
  CHECK_THROWS_WITH(set.add_fixed(HalfSpace{.offset = no_number}),
                    Contains("half-space offset nan m is not finite"));
}

TEST_CASE("too few points, or points without a volume, are no convex hull") {
  CHECK_THROWS_WITH(ConvexHull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}),
                    "delassus: a convex hull needs at least 4 points, got 3");
  CHECK_THROWS_WITH(ConvexHull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}),
                    Contains("lie in one plane"));
  CHECK_THROWS_WITH(ConvexHull(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, no_number, 1}}),
                    Contains("point #3 is not finite"));
  CHECK_THROWS_WITH(ConvexHull(std::vector<Vec3>(8, Vec3(1, 2, 3))), Contains("span 0 m"));
}

TEST_CASE("a particle must have a mass, a place and no negative radius") {
  Particles set;
  for (const double mass : {0.0, -2.0, no_number, infinity})
    CHECK_THROWS_WITH(set.add({.mass = mass}),
                      "delassus: particle #0: mass " + inner::text(mass) + " must be finite and > 0");
  CHECK_THROWS_WITH(set.add({}), Contains("particle #0: give mass (kg), or is_fixed"));
  CHECK_THROWS_WITH(set.add({.position = {no_number, 0, 0}, .mass = 1.0}),
                    Contains("particle #0: position is not finite"));
  CHECK_THROWS_WITH(set.add({.velocity = {0, infinity, 0}, .mass = 1.0}),
                    Contains("particle #0: velocity is not finite"));
  CHECK_THROWS_WITH(set.add({.mass = 1.0, .radius = -0.1}),
                    Contains("particle #0: radius -0.1 must be finite and >= 0"));
  CHECK(set.blocks() == 0);
}

TEST_CASE("a spring of negative stiffness, damping or length is refused") {
  Particles set;
  const auto a = set.add({.mass = 1.0}), b = set.add({.position = {1, 0, 0}, .mass = 1.0});
  for (const double bad : {-1.0, no_number, infinity}) {
    CHECK_THROWS_WITH(set.add_spring(a, b, bad), "delassus: particle #0: spring stiffness " +
                                                     inner::text(bad) + " N/m must be finite and >= 0");
    CHECK_THROWS_WITH(set.add_spring(a, b, 1, bad), "delassus: particle #0: spring damping " +
                                                        inner::text(bad) + " N·s/m must be finite and >= 0");
    CHECK_THROWS_WITH(set.add_spring(a, b, 1, 0, bad), "delassus: particle #0: rest length " +
                                                           inner::text(bad) + " m must be finite and >= 0");
  }
  CHECK_THROWS_WITH(set.add_spring(a, a, 1), Contains("a spring needs two different ends"));
  CHECK_THROWS_WITH(set.add_spring(a, Vec3(no_number, 0, 0), 1, 0, 0.0),
                    Contains("the spring's point is not finite"));
  set.remove(b);
  CHECK_THROWS_WITH(set.add_spring(a, b, 1), Contains("particle #1 was removed; its handle is stale"));
}

TEST_CASE("a distance joint of negative length, stiffness or damping is refused") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}};
  auto& set = bodies<Particles>(loop.world());
  const Anchor end = anchor(set, set.add({.mass = 1.0}));
  for (const double bad : {-1.0, no_number, infinity}) {
    const std::string value = inner::text(bad);
    CHECK_THROWS_WITH(loop.add(DistanceJoint::Item{end, world_anchor({}), bad}),
                      "delassus: DistanceJoint: length " + value + " m must be finite and >= 0");
    CHECK_THROWS_WITH(loop.add(DistanceJoint::Item{end, world_anchor({}), 1, bad}),
                      "delassus: DistanceJoint: stiffness " + value + " N/m must be finite and >= 0");
    CHECK_THROWS_WITH(loop.add(DistanceJoint::Item{end, world_anchor({}), 1, 1, bad}),
                      "delassus: DistanceJoint: damping " + value + " N·s/m must be finite and >= 0");
  }
}

TEST_CASE("an anchor at a point that is not finite, or with a frame that is no rotation, is refused") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto body = set.add(sound());
  CHECK_THROWS_WITH(anchor(set, body, {no_number, 0, 0}),
                    "delassus: anchor: the point on rigid body #0 is not finite");
  CHECK_THROWS_WITH(anchor(set, body, {0, 0, 0}, Quat(2, 0, 0, 0)),
                    "delassus: anchor: the frame on rigid body #0 is not a unit quaternion");
  CHECK_THROWS_WITH(anchor(set, body, {0, 0, 0}, Quat(no_number, 0, 0, 0)),
                    "delassus: anchor: the frame on rigid body #0 is not a unit quaternion");
  CHECK_THROWS_WITH(loop.add(BallJoint::Item{anchor(set, body), world_anchor({0, infinity, 0})}),
                    Contains("world") && Contains("not finite"));
}

TEST_CASE("a step that is not positive and finite is refused, and changes nothing") {
  AnimationLoop loop{World{RigidBodies{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto body = set.add(sound());
  loop.step(0.1);
  const Vec3 position = set.position(body);
  for (const double h : {0.0, -0.01, no_number, infinity})
    CHECK_THROWS_WITH(loop.step(h), "delassus: step: h = " + inner::text(h) + " s must be finite and > 0");
  CHECK(set.position(body) == position);
  CHECK(loop.time() == 0.1);
}

TEST_CASE("a friction, restitution or relaxation out of its range is refused") {
  const auto with = [](auto... parts) { AnimationLoop{World{RigidBodies{}}, parts...}; };
  for (const double friction : {-0.1, no_number, infinity}) {
    const std::string sentence = "friction " + inner::text(friction) + " must be finite and >= 0";
    CHECK_THROWS_WITH(with(Constraints{Contact{Coulomb{.friction = friction}}}),
                      "delassus: Coulomb: " + sentence);
    Materials materials;
    CHECK_THROWS_WITH(materials.add({.friction = friction}), "delassus: material: " + sentence);
  }
  for (const double e : {-0.1, 1.1, no_number}) {
    const std::string sentence = "restitution " + inner::text(e) + " must be in [0, 1]";
    CHECK_THROWS_WITH(with(Constraints{Contact{Restitution{Frictionless{}, e}}}),
                      "delassus: Restitution: " + sentence);
    Materials materials;
    CHECK_THROWS_WITH(materials.add({.restitution = e}), "delassus: material: " + sentence);
  }
  for (const double omega : {0.0, 2.0, -1.0, no_number}) {
    const std::string sentence = "relaxation " + inner::text(omega) + " must lie in (0, 2)";
    CHECK_THROWS_WITH(with(Constraints{BallJoint{}}, GaussSeidel{.relaxation = omega}),
                      "delassus: GaussSeidel: " + sentence);
    CHECK_THROWS_WITH(with(Constraints{BallJoint{}}, AcceleratedGaussSeidel{.relaxation = omega}),
                      "delassus: AcceleratedGaussSeidel: " + sentence);
  }
}

TEST_CASE("a Rayleigh damping below zero is refused") {
  for (const double bad : {-1.0, no_number, infinity}) {
    CHECK_THROWS_WITH((AnimationLoop{World{Particles{}}, ImplicitEuler{.rayleigh_mass = bad}}),
                      Contains("ImplicitEuler: rayleigh_mass " + inner::text(bad)));
    CHECK_THROWS_WITH((AnimationLoop{World{Particles{}}, ImplicitEuler{.rayleigh_stiffness = bad}}),
                      Contains("ImplicitEuler: rayleigh_stiffness " + inner::text(bad)));
  }
}

TEST_CASE("a place, velocity or target that is not finite is refused, and the body stays") {
  RigidBodies set;
  const auto body = set.add(sound());
  const auto moved = set.add({.shape = Box{1, 1, 1}, .motion = Motion::kinematic});
  CHECK_THROWS_WITH(set.place(body, {no_number, 0, 0}), Contains("rigid body #0: pose is not finite"));
  CHECK_THROWS_WITH(set.place(body, {0, 0, 0}, Quat(infinity, 0, 0, 0)),
                    Contains("rigid body #0: pose is not finite"));
  CHECK_THROWS_WITH(set.place(body, {0, 0, 0}, Quat(0, 0, 0, 0)),
                    Contains("rigid body #0: pose is not finite"));
  CHECK_THROWS_WITH(set.set_velocity(body, {0, no_number, 0}),
                    Contains("rigid body #0: velocity is not finite"));
  CHECK_THROWS_WITH(set.move_to(moved, {0, infinity, 0}), Contains("rigid body #1: pose is not finite"));
  CHECK_THROWS_WITH(set.move_to(moved, {0, 0, 0}, Quat(no_number, 0, 0, 0)),
                    Contains("rigid body #1: pose is not finite"));
  CHECK_THROWS_WITH(set.move_to(body, {0, 0, 1}),
                    Contains("rigid body #0: only a kinematic body can be moved along a path"));
  CHECK(set.position(body) == Vec3(0, 0, 0));
}

// The force is given at run time, so it is not refused: it holds its own island still for that step, and the
// report says so.
TEST_CASE("a force that is not a number stops its own body for one step and changes no bit elsewhere") {
  const auto run = [](bool spoil) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}};
    auto& set = bodies<RigidBodies>(loop.world());
    const auto one = set.add(sound()),
               two = set.add({.position = {9, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}});
    for (const auto& b : {one, two})
      loop.add(
          BallJoint::Item{anchor(set, b, {0.5, 0.5, 0}), world_anchor(set.position(b) + Vec3(0.5, 0.5, 0))});
    for (int n = 0; n < 50; ++n) {
      const Vec3 before = set.position(one);
      if (spoil && n == 10) set.apply_force(one, {no_number, 0, 0});
      const StepReport report = loop.step(1e-2);
      CHECK((report.status == Status::quarantined) == (spoil && n == 10));
      CHECK(report.quarantined == (spoil && n == 10 ? 1 : 0));
      if (spoil && n == 10) CHECK(set.position(one) == before);
    }
    CHECK(is_finite(set.position(one)));
    return set.position(two);
  };
  CHECK(run(true) == run(false));
}
