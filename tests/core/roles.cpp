#include <delassus/core/roles.hpp>

#include "catch.hpp"

namespace role = delassus::role;

namespace {

struct Solver {
  using plays = role::Solver;
};
struct Nobody {};

}  // namespace

TEST_CASE("a policy plays the role it names, no other, and a type without a role plays none") {
  STATIC_REQUIRE(delassus::Plays<Solver, role::Solver>);
  STATIC_REQUIRE_FALSE(delassus::Plays<Solver, role::Integrator>);
  STATIC_REQUIRE_FALSE(delassus::Plays<Nobody, role::Solver>);
}
