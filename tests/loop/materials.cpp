#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/io/checkpoint.hpp>

#include "scenes.hpp"

#include "catch.hpp"

namespace materials_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

struct Slippery {
  /// Whatever touches material 2.
  static bool takes(Index a, Index b) { return a == 2 || b == 2; }
};

template <class Set>
RigidBodies::Handle add_ground(Set& set, Index material) {
  return set.add({.shape = HalfSpace{}, .motion = Motion::fixed, .material = material});
}

/// |λ_t|/λ_n of all contacts together while the block slides.
template <class Loop>
double friction_seen(Loop& loop, Index ground, Index block) {
  auto& set = rigid_bodies(loop);
  add_ground(set, ground);
  const auto body = set.add({.position = {0, 0, 0.1}, .velocity = {5, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 0.2},
                             .material = block});
  for (int n = 0; n < 5; ++n) loop.step(h);
  Vec3 sum = Vec3::Zero();
  for (const ContactResult& c : loop.contacts()) sum += c.impulse;
  REQUIRE(set.velocity(body).x() > 0);
  return std::abs(sum.x() / sum.z());
}

using Loop = decltype(AnimationLoop{World{RigidBodies{}},
                                    Constraints{Contact{Restitution{Coulomb{.friction = 0.1}, 0.25}}}});
Loop make_loop() {
  return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.1}, 0.25}}}};
}

/// Upward speed of a ball of material `ball` that arrives with 2 m/s, over 2 m/s.
double restitution_seen(Loop& loop, Index ground, Index ball) {
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  add_ground(set, ground);
  const auto body = set.add({.position = {0, 0, 0.11}, .velocity = {0, 0, -2}, .mass = 1.0, .shape = Sphere{0.1},
                             .material = ball});
  for (int n = 0; n < 3; ++n) loop.step(h);
  return set.velocity(body).z() / 2;
}

}  // namespace

TEST_CASE("without materials the law's own friction and restitution hold") {
  auto a = make_loop(), b = make_loop();
  REQUIRE(friction_seen(a, 0, 0) == Approx(0.1).epsilon(1e-5));
  REQUIRE(restitution_seen(b, 0, 0) == Approx(0.25).epsilon(1e-6));
}

TEST_CASE("two materials combine to the root of their frictions and the larger restitution") {
  const auto with = [](Loop& loop) {
    REQUIRE(loop.materials().add({.friction = 0.2, .restitution = 0.5}) == 1);
    REQUIRE(loop.materials().add({.friction = 0.8, .restitution = 0.75}) == 2);
  };
  auto a = make_loop(), b = make_loop();
  with(a);
  with(b);
  REQUIRE(friction_seen(a, 1, 2) == Approx(0.4).epsilon(1e-5));
  REQUIRE(restitution_seen(b, 1, 2) == Approx(0.75).epsilon(1e-6));
}

TEST_CASE("a pair of materials comes before their combination, in either order") {
  for (const bool swapped : {false, true}) {
    const auto with = [](Loop& loop) {
      loop.materials().add({.friction = 0.2, .restitution = 0.5});
      loop.materials().add({.friction = 0.8, .restitution = 0.75});
      loop.materials().set_pair(2, 1, {.friction = 0.3, .restitution = 0.9});
    };
    auto a = make_loop(), b = make_loop();
    with(a);
    with(b);
    REQUIRE(friction_seen(a, swapped ? 2 : 1, swapped ? 1 : 2) == Approx(0.3).epsilon(1e-5));
    REQUIRE(restitution_seen(b, swapped ? 2 : 1, swapped ? 1 : 2) == Approx(0.9).epsilon(1e-6));
  }
}

TEST_CASE("a body without material keeps the law's own parameters against every material") {
  auto loop = make_loop();
  loop.materials().add({.friction = 0.9, .restitution = 0});
  REQUIRE(friction_seen(loop, 1, 0) == Approx(0.1).epsilon(1e-5));
}

TEST_CASE("a friction or restitution that cannot be is refused by its value") {
  auto loop = make_loop();
  REQUIRE_THROWS_WITH(loop.materials().add({.friction = -1}), Catch::Contains("friction -1 must be finite and >= 0"));
  REQUIRE_THROWS_WITH(loop.materials().add({.restitution = 1.5}), Catch::Contains("restitution 1.5 must be in [0, 1]"));
  REQUIRE_THROWS_WITH(loop.materials().set_pair(1, 2, {}), Catch::Contains("no material has this number"));
}

TEST_CASE("a body of a material that no loop has added is refused by add") {
  auto loop = make_loop();
  loop.materials().add({});
  for (const Index number : {1000000, -1}) {
    const std::string sentence = "material " + std::to_string(number) + " was never added; give it what loop.materials().add({...}) returns, or none";
    REQUIRE_THROWS_WITH(rigid_bodies(loop).add({.mass = 1.0, .shape = Box{1, 1, 1}, .material = number}), "delassus: rigid body #0: " + sentence);
    AnimationLoop points{World{Particles{}}};
    REQUIRE_THROWS_WITH(bodies<Particles>(points.world()).add({.mass = 1.0, .material = number}), "delassus: particle #0: " + sentence);
    using Soft = TetrahedralFem<Corotational>;
    Soft soft;
    REQUIRE_THROWS_WITH(soft.add({.mesh = box_mesh({1, 1, 1}, {1, 1, 1}), .elasticity = {.young = 1e6, .poisson = 0.3}, .material = number}),
                        Catch::Contains("#0: " + sentence));
    REQUIRE(soft.blocks() == 0);
  }
  REQUIRE(rigid_bodies(loop).blocks() == 0);
}

// Another loop has given these numbers out: `add` lets them pass, and the step, which knows its own, refuses.
TEST_CASE("a body of a material of another loop is refused by the step, which then has done nothing") {
  auto other = make_loop();
  while (other.materials().count() < 7) other.materials().add({});
  for (const Index number : {1, 7}) {
    auto loop = make_loop();
    auto& set = rigid_bodies(loop);
    add_ground(set, 0);
    const auto box = set.add({.position = {0, 0, 1}, .mass = 1.0, .shape = Box{1, 1, 1}, .material = number});
    const std::string sentence = "delassus: rigid body #1: material " + std::to_string(number) + " is not among the 0 of the "
                                 "loop; give it what loop.materials().add({...}) returns, or none";
    REQUIRE_THROWS_WITH(loop.step(h), sentence);
    REQUIRE(loop.time() == 0);
    REQUIRE(set.position(box).z() == 1);
    auto mended = loop.clone();
    while (mended.materials().count() < number) mended.materials().add({});
    REQUIRE_NOTHROW(mended.step(h));
    loop.remove(box);
    REQUIRE_NOTHROW(loop.step(h));
  }
}

TEST_CASE("every kind of body is refused with its material, and a loop without contact laws asks for none") {
  auto other = make_loop();
  while (other.materials().count() < 7) other.materials().add({});
  AnimationLoop loop{World{Particles{}}, Constraints{Contact{Coulomb{}}}};
  bodies<Particles>(loop.world()).add({.mass = 1.0, .radius = 0.1, .material = 2});
  loop.materials().add({});
  REQUIRE_THROWS_WITH(loop.step(h), Catch::Contains("particle #0: material 2 is not among the 1 of the loop"));
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop soft{World{Soft{}}, Constraints{Contact{Coulomb{}}}, ImplicitEuler{}};
  bodies<Soft>(soft.world()).add({.mesh = box_mesh({1, 1, 1}, {1, 1, 1}), .elasticity = {.young = 1e6, .poisson = 0.3}, .material = 1});
  REQUIRE_THROWS_WITH(soft.step(h), Catch::Contains("#0: material 1 is not among the 0 of the loop"));
  AnimationLoop alone{World{RigidBodies{}}};
  rigid_bodies(alone).add({.mass = 1.0, .shape = Box{1, 1, 1}, .material = 7});
  REQUIRE_NOTHROW(alone.step(h));
}

TEST_CASE("a checkpoint brings the materials of its bodies, and one without them is refused as the bodies are") {
  auto loop = make_loop(), other = make_loop();
  loop.materials().add({.friction = 0.2});
  add_ground(rigid_bodies(loop), 1);
  loop.step(h);
  restore(other, checkpoint(loop));
  REQUIRE_NOTHROW(other.step(h));
  other.materials() = {};
  REQUIRE_THROWS_WITH(other.step(h), Catch::Contains("rigid body #0: material 1 is not among the 0 of the loop"));
}

TEST_CASE("two contact laws share the contacts by their materials") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{ContactFor<Frictionless, Slippery>{}, Contact{Coulomb{.friction = 0.5}}}};
  auto& set = rigid_bodies(loop);
  loop.materials().add({.friction = 0.5});
  loop.materials().add({.friction = 0.5});
  add_ground(set, 1);
  const auto rough = set.add({.position = {0, 0, 0.1}, .velocity = {3, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 0.2}, .material = 1});
  const auto smooth = set.add({.position = {0, 5, 0.1}, .velocity = {3, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 0.2}, .material = 2});
  for (int n = 0; n < 60; ++n) REQUIRE(loop.step(h).status == Status::converged);
  REQUIRE(loop.problem().rows.pool<0>().items() == 4);
  REQUIRE(loop.problem().rows.pool<1>().items() == 4);
  REQUIRE(set.velocity(rough).norm() < 1e-9);
  REQUIRE(set.velocity(smooth).x() == Approx(3).epsilon(1e-9));
}

TEST_CASE("a contact that no law takes is a status, and does not act") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{ContactFor<Frictionless, Slippery>{}}};
  auto& set = rigid_bodies(loop);
  add_ground(set, 0);
  const auto box = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  REQUIRE(loop.step(h).status == Status::unclaimed_contact);
  REQUIRE(set.velocity(box).z() == Approx(-g * h).epsilon(1e-15));
}

TEST_CASE("bodies meet when each one's group is in the other's mask") {
  for (const auto& [group, mask, meets] : {std::tuple{1u, ~0u, true}, {2u, ~0u, true}, {1u, 2u, false}, {4u, 1u, true}, {8u, 6u, false}}) {
    auto loop = make_loop();
    auto& set = rigid_bodies(loop);
    add_ground(set, 0);
    const auto box = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}, .group = group, .collides_with = mask});
    for (int n = 0; n < 30; ++n) loop.step(h);
    CAPTURE(group, mask);
    REQUIRE((set.position(box).z() > 0.49) == meets);
  }
}

}  // namespace materials_tests
