// Numbers that are finite in double and nothing a set of bodies can compute with are refused where they
// enter.
#include <delassus/delassus.hpp>

#include "catch.hpp"

using namespace delassus;
using Catch::Contains;

TEST_CASE("a position or velocity beyond single precision is refused by the sets that keep it so") {
  const std::string largest = " is beyond 3.40282e+38, the largest number that this set of bodies holds";
  RigidBodiesF rigid;
  RigidBody body{.mass = 1.0, .shape = Sphere{1}};
  const auto box = rigid.add(body);
  body.position = {1e300, 0, 0};
  CHECK_THROWS_WITH(rigid.add(body), "delassus: rigid body #1: position (1e+300, 0, 0) m" + largest);
  CHECK_THROWS_WITH(rigid.place(box, {0, -1e39, 0}),
                    "delassus: rigid body #0: position (0, -1e+39, 0) m" + largest);
  body = {.velocity = {0, 1e300, 0}, .mass = 1.0, .shape = Sphere{1}};
  CHECK_THROWS_WITH(rigid.add(body), "delassus: rigid body #1: velocity (0, 1e+300, 0) m/s" + largest);
  CHECK_THROWS_WITH(rigid.set_velocity(box, Vec3::Zero(), {0, 0, 1e39}),
                    Contains("rigid body #0: angular velocity (0, 0, 1e+39) rad/s" + largest));
  CHECK_THROWS_WITH(anchor(rigid, box, {1e39, 0, 0}),
                    Contains("the point on rigid body #0, (1e+39, 0, 0) m" + largest));
  const auto lift = rigid.add({.shape = Sphere{1}, .motion = Motion::kinematic});
  CHECK_THROWS_WITH(rigid.move_to(lift, {1e39, 0, 0}), Contains("rigid body #1: position (1e+39, 0, 0) m"));

  ParticlesF points;
  const auto grain = points.add({.mass = 1.0});
  CHECK_THROWS_WITH(points.add({.position = {1e300, 0, 0}, .mass = 1.0}),
                    "delassus: particle #1: position (1e+300, 0, 0) m" + largest);
  CHECK_THROWS_WITH(points.place(grain, {1e39, 0, 0}),
                    Contains("particle #0: position (1e+39, 0, 0) m" + largest));
  CHECK_THROWS_WITH(points.set_velocity(grain, {1e39, 0, 0}),
                    Contains("velocity (1e+39, 0, 0) m/s" + largest));
  CHECK_THROWS_WITH(points.add({.velocity = {1e39, 0, 0}, .mass = 1.0}), Contains("m/s" + largest));

  // In double they are numbers like others.
  RigidBodies wide;
  CHECK_NOTHROW(wide.add({.position = {1e300, 0, 0}, .mass = 1.0, .shape = Sphere{1}}));
  CHECK(rigid.blocks() == 2);
  CHECK(points.blocks() == 1);
}

TEST_CASE("a mass is refused where it or its inverse is no normal number of the set") {
  ParticlesF points;
  for (const double mass : {1e-50, 1e-39, 1e38, 1e300})
    CHECK_THROWS_WITH(
        points.add({.mass = mass}),
        "delassus: particle #0: mass " + inner::text(mass) +
            " kg lies outside [1.17549e-38, 8.50706e+37], where this set of bodies holds a number and "
            "its inverse");
  CHECK_NOTHROW(points.add({.mass = 1e-37}));
  Particles wide;
  CHECK_THROWS_WITH(wide.add({.mass = 1e-320}),
                    Contains("mass 9.99989e-321 kg lies outside [2.22507e-308, "));
  CHECK_THROWS_WITH(wide.add({.mass = 1.7e308}), Contains("lies outside"));

  RigidBodiesF rigid;
  CHECK_THROWS_WITH(rigid.add({.mass = 1e-50, .shape = Sphere{1}}),
                    Contains("rigid body #0: mass 1e-50 kg lies outside"));
  // The inertia of a grain whose mass is a number need not be one.
  CHECK_THROWS_WITH(rigid.add({.mass = 1e-20, .shape = Sphere{1e-10}}),
                    Contains("inertia with diagonal (4e-41, 4e-41, 4e-41) kg·m² lies outside"));
  CHECK_THROWS_WITH(rigid.add({.mass = 1e20, .shape = Sphere{1e10}}), Contains("kg·m² lies outside"));
  RigidBodies exact;
  CHECK_THROWS_WITH(exact.add({.mass = 1e-320, .shape = Sphere{1}}),
                    Contains("e-321 kg lies outside"));
  CHECK(rigid.blocks() == 0);
  CHECK(exact.blocks() == 0);
}

// det I of moments 1e-110 is 1e-330, that of 1e110 is 1e330: neither is a number, and neither matters.
TEST_CASE("a tiny and a huge ball answer to a torque by their own inertia") {
  for (const double mass : {1e-110, 1.0, 1e110}) {
    AnimationLoop loop{World{RigidBodies{}}};
    auto& set = bodies<RigidBodies>(loop.world());
    const auto ball = set.add({.mass = mass, .shape = Sphere{1}});
    set.apply_torque(ball, {0, 0, 0.4 * mass});
    loop.step(0.5);
    CAPTURE(mass);
    CHECK(set.angular_velocity(ball).z() == Approx(0.5).epsilon(1e-14));
  }
}

TEST_CASE("a fixed body has no velocity to set, a kinematic one has") {
  RigidBodies rigid;
  const auto wall = rigid.add_fixed(HalfSpace{});
  CHECK_THROWS_WITH(rigid.set_velocity(wall, {1, 0, 0}),
                    "delassus: rigid body #0: a fixed body has no velocity; add it as a kinematic one");
  CHECK(rigid.velocity(wall) == Vec3::Zero());
  const auto lift = rigid.add({.shape = Sphere{1}, .motion = Motion::kinematic});
  CHECK_NOTHROW(rigid.set_velocity(lift, {1, 0, 0}));
  Particles points;
  const auto nail = points.add({.is_fixed = true});
  CHECK_THROWS_WITH(points.set_velocity(nail, {1, 0, 0}),
                    "delassus: particle #0: a fixed particle has no velocity");
}

TEST_CASE("a stiffness or damping that makes a row no number is refused, and says the range") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{DistanceJoint{}, VirtualCoupling{}}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto ball = set.add({.mass = 1.0, .shape = Sphere{1}});
  DistanceJoint::Item spring{.a = anchor(set, ball), .b = world_anchor({0, 0, 2}), .length = 2};
  for (const double bad : {1e-310, 1e-21, 1e21, 1e300}) {
    spring.stiffness = bad, spring.damping = 0;
    CHECK_THROWS_WITH(loop.add(spring), "delassus: DistanceJoint: stiffness " + inner::text(bad) +
                                            " N/m must be 0 or lie in [1e-20, 1e20]");
    spring.stiffness = 0, spring.damping = bad;
    CHECK_THROWS_WITH(loop.add(spring), Contains("DistanceJoint: damping " + inner::text(bad)));
    CHECK_THROWS_WITH(
        loop.add(VirtualCoupling::Item{.a = anchor(set, ball), .b = world_anchor({}), .stiffness = bad}),
        Contains("VirtualCoupling: stiffness " + inner::text(bad) +
                 " N/m must be 0 or lie in [1e-20, 1e20]"));
    CHECK_THROWS_WITH((Penalty{Coulomb{}, bad}.check()), Contains("Penalty: stiffness " + inner::text(bad)));
  }
  spring.damping = 0, spring.length = 1e21;
  CHECK_THROWS_WITH(loop.add(spring), "delassus: DistanceJoint: length 1e+21 must be <= 1e20 m");
  spring.length = 2;
  Particles points;
  const auto grain = points.add({.mass = 1.0});
  CHECK_THROWS_WITH(points.add_spring(grain, Vec3(0, 0, 1), 1e300),
                    "delassus: particle #0: spring stiffness 1e+300 N/m must be 0 or lie in [1e-20, 1e20]");
  // The ends of the range are springs that do not disturb a step, of any usual length.
  for (const double h : {1e-6, 1e-3, 1.0})
    for (const double k : {1e-20, 1e20}) {
      spring.stiffness = k;
      const auto joint = loop.add(spring);
      CAPTURE(h, k);
      CHECK(loop.step(h).status == Status::converged);
      loop.remove(joint);
    }
}
