#include <delassus/compliance/cheaper.hpp>

#include "scenes.hpp"

#include "catch.hpp"

namespace cheaper_tests {

using namespace scenes;

namespace {

/// Twelve bodies of which a few have most of forty contacts, one step in.
template <class Builder>
auto cluster_problem(Builder builder, unsigned seed) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.4}}},
                     GivenContacts{},
                     builder,
                     GaussSeidel{.tolerance = 0, .max_iterations = 50, .min_iterations = 50},
                     SoftContact{}};
  loop.template get<GivenContacts>().points = add_cluster(rigid_bodies(loop), 12, 40, seed, -1e-3);
  loop.step(0.01);
  return loop.problem();
}

/// A plate on 24 points and, metres away, a pile of spheres; λ of the pile after some steps.
auto pile(int points_under_plate) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, GivenContacts{},
                     CheaperCompliance{}};
  auto& set = rigid_bodies(loop);
  auto& given = loop.template get<GivenContacts>().points;
  given = add_cluster(set, 8, 12, 3, -1e-3);
  const auto plate = set.add({.position = {50, 0, 0.1}, .mass = 1.0, .shape = Box{1, 1, 0.2}});
  for (int k = 0; k < points_under_plate; ++k) {
    const Vec3 point(50 + 0.4 * std::cos(k), 0.4 * std::sin(k), 0);
    given.push_back({.a = 0,
                     .b = plate.index,
                     .point_a = point,
                     .point_b = point,
                     .pair = 99,
                     .feature = std::uint32_t(k)});
  }
  std::vector<Vec<6>> velocity;
  for (int n = 0; n < 5; ++n) loop.step(0.01);
  for (Index b = 0; b < 8; ++b) velocity.push_back(set.velocity()[b]);
  return velocity;
}

}  // namespace

// Whichever form a row has, the same products are added in another order: as with all of one form, ulps that
// fifty sweeps raise to at most 1e-10 of the largest impulse.
TEST_CASE("rows of W beside rows without it give the impulses of W after the same number of sweeps") {
  int crowded = 0, sparse = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto p = cluster_problem(AssembledCompliance{}, seed);
    const auto q = cluster_problem(CheaperCompliance{}, seed);
    const auto &x = p.rows.pool<0>().lambda, &y = q.rows.pool<0>().lambda;
    double largest = 0, difference = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      largest = std::max(largest, x[i].norm());
      difference = std::max(difference, (x[i] - y[i]).norm());
      (q.W.is_crowded<0>(Index(i)) ? crowded : sparse) += 1;
    }
    CAPTURE(seed);
    REQUIRE(difference <= 1e-10 * largest);
  }
  CHECK(crowded > 50);
  CHECK(sparse > 50);
}

TEST_CASE("a crowd far away changes no bit of who has none") {
  const auto alone = pile(0), beside = pile(24);
  for (std::size_t b = 0; b < alone.size(); ++b) REQUIRE(alone[b] == beside[b]);
}

// Fifty contacts in the place of each: the share of W's rows would be 200 blocks long.
TEST_CASE("a plate on many points has no row of W, on four it has all of them") {
  for (const int count : {4, 200}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, GivenContacts{},
                       CheaperCompliance{}};
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{});
    set.add({.position = {0, 0, 0.1}, .mass = 1.0, .shape = Box{1, 1, 0.2}});
    for (int k = 0; k < count; ++k) {
      const Vec3 point(0.4 * std::cos(k), 0.4 * std::sin(k), 0);
      loop.get<GivenContacts>().points.push_back(
          {.a = 0, .b = 1, .point_a = point, .point_b = point, .pair = 1, .feature = std::uint32_t(k)});
    }
    REQUIRE(loop.step(0.01).status == Status::converged);
    const auto problem = loop.problem();
    REQUIRE(problem.rows.pool<0>().items() == count);
    for (Index i = 0; i < count; ++i) REQUIRE(problem.W.is_crowded<0>(i) == (count > 8));
  }
}

TEST_CASE("where springs couple A all rows are W's") {
  const auto path = [](auto compliance) {
    AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}, compliance};
    auto& set = bodies<Particles>(loop.world());
    std::vector<Particles::Handle> p;
    for (int i = 0; i < 8; ++i) p.push_back(set.add({.position = {0.2 * i, 0, 0}, .mass = 0.1}));
    for (int i = 0; i + 1 < 8; ++i) set.add_spring(p[i], p[i + 1], 50, 0.5, 0.2);
    loop.add(DistanceJoint::Item{anchor(set, p[0]), world_anchor({0, 0, 0.5}), 0.5});
    loop.add(DistanceJoint::Item{anchor(set, p[7]), world_anchor({1.4, 0, 0.5}), 0.5});
    for (int n = 0; n < 50; ++n) loop.step(0.01);
    return set.position(p[4]);
  };
  REQUIRE(path(CheaperCompliance{}) == path(AssembledCompliance{}));
}

}  // namespace cheaper_tests
