// A law of a user's own that throws while it writes its rows: the bodies are those of the last whole step.
#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/joints/bilateral.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/loop/animation_loop.hpp>

#include <stdexcept>
#include <string>

#include "catch.hpp"

namespace law_that_throws_tests {

using namespace delassus;

/// Holds a body at a height, until the countdown of its calls is over; its last row is `row`.
struct Shelf : Bilateral<2> {
  struct Item {
    Anchor a, b;
  };
  int* calls_left = nullptr;
  int row = 1;
  void linearize(const Item& item, const auto& world, auto out) const {
    if ((*calls_left)-- == 0) throw std::runtime_error("the shelf breaks");
    const Vec3 x = world.point(item.a);
    auto end = out.end(item.a, x);
    end.along(0, Vec3(0, 0, 1)), out.phi(0, x[2]);
    end.along(row, Vec3(0, 1, 0)), out.phi(1, x[1]);
  }
};

auto shelf(int* calls_left, int row = 1) {
  Shelf law;
  law.calls_left = calls_left, law.row = row;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{law}, ImplicitMidpoint{}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto body = set.add({.velocity = {1, 0, 0}, .angular_velocity = {0, 0, 3}, .mass = 1.0, .shape = Box{1, 2, 3}});
  loop.add(Shelf::Item{anchor(set, body), world_anchor({0, 0, 0})});
  return loop;
}

// The midpoint rule asks for the rows of the start and for those at q + h v/2: the second call meets bodies that are moved.
TEST_CASE("a law that throws leaves all bodies in the last good state") {
  for (const int calls : {0, 1}) {
    int calls_left = calls;
    auto loop = shelf(&calls_left);
    const auto& set = bodies<RigidBodies>(loop.world());
    CHECK_THROWS_WITH(loop.step(0.1), "the shelf breaks");
    CHECK(set.position(set.handle(0)) == Vec3(0, 0, 0));
    CHECK(set.orientation(set.handle(0)).coeffs() == Quat::Identity().coeffs());
    CHECK(set.velocity(set.handle(0)) == Vec3(1, 0, 0));
    calls_left = 1000;
    CHECK(loop.step(0.1).status == Status::converged);
  }
}

TEST_CASE("a law that writes a row it has not is refused in a sentence") {
  for (const int row : {-1, 2, 1000000}) {
    int calls_left = 1000;
    auto loop = shelf(&calls_left, row);
    CHECK_THROWS_WITH(loop.step(0.1), "delassus: linearize: a law of 2 rows writes row " + std::to_string(row) +
                                          "; they count from 0 to 1, change its `rows` or its linearize");
  }
}

}  // namespace law_that_throws_tests
