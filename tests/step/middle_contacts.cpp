// Contacts of the start that are moved to the middle of a step.
#include <delassus/step/middle_contacts.hpp>

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/collision/collider.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/step/plain_step.hpp>

#include "catch.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace middle_contacts_tests {

using namespace delassus;

namespace {

/// Answers with the first list where the ball is at x = 0, and with the second one elsewhere.
struct TwoAnswers {
  using plays = role::Collision;
  std::vector<ContactPoint> at_start{}, in_middle{};

  CollisionReport detect(std::span<const Collider> colliders, double, std::vector<ContactPoint>& out) {
    out = colliders[1].pose.position.x() == 0 ? at_start : in_middle;
    return {.queries = 1, .points = Index(out.size())};
  }
};

ContactPoint touch(std::uint32_t feature, double gap, const Vec3& normal) {
  return {.a = 0, .b = 1, .point_a = {0, 0, 0}, .point_b = gap * normal, .normal = normal, .gap = gap, .pair = 1, .feature = feature};
}

/// A ball at x = 0 that goes with 2 m/s above a ground, when the rows of a step of 0.1 s are made.
auto linearized(std::vector<ContactPoint> at_start, std::vector<ContactPoint> in_middle) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, ImplicitMidpoint{}, TwoAnswers{at_start, in_middle}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  set.add({.position = {0, 0, 1}, .velocity = {2, 0, 0}, .mass = 1.0, .shape = Sphere{1}});
  stage::begin(loop.data(), 0.1);
  stage::detect(loop.data());
  stage::linearize(loop.data());
  return loop;
}

}  // namespace

TEST_CASE("a contact takes the place and normal of its namesake in the middle, and keeps the gap of the start") {
  const Vec3 up(0, 0, 1), aslant(0.6, 0, 0.8);
  const auto loop = linearized({touch(3, 0.25, up), touch(7, 0.5, up)}, {touch(5, 1, up), touch(7, 0.125, aslant), touch(9, 1, up)});
  REQUIRE(loop.contacts().size() == 2);
  CHECK(loop.contacts()[0].record.normal == up);
  CHECK(loop.contacts()[1].record.normal == aslant);
  CHECK(loop.contacts()[1].record.gap == 0.125);
  const auto& rows = loop.data().rows.template pool<0>();
  CHECK(rows.phi[0][0] == 0.25);
  CHECK(rows.phi[1][0] == 0.5);
}

// A ball that does not turn takes it along by h v/2 = 0.1 m.
TEST_CASE("a contact without a namesake in the middle goes there with the body that moves") {
  const auto loop = linearized({touch(3, 0.5, Vec3(0, 0, 1))}, {});
  const ContactRecord& record = loop.contacts()[0].record;
  CHECK((record.point_a - Vec3(0.1, 0, 0)).norm() <= 1e-15);
  CHECK((record.point_b - Vec3(0.1, 0, 0.5)).norm() <= 1e-15);
  CHECK(record.normal == Vec3(0, 0, 1));
}

TEST_CASE("the bodies are back where they were, and both detections are counted") {
  const auto loop = linearized({touch(3, 0.5, Vec3(0, 0, 1))}, {});
  CHECK(loop.world().template set<0>().pose(1).position == Vec3(0, 0, 1));
  CHECK(loop.report().queries == 2);
  CHECK(loop.report().contacts == 1);
}

}  // namespace middle_contacts_tests
