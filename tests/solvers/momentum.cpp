// When momentum restarts, on movements that are given.
#include <delassus/solvers/inner/momentum.hpp>

#include "catch.hpp"

namespace momentum_tests {

using namespace delassus;
using inner::RestartRule;

namespace {

/// Sweeps that all move `moved`, with a product that asks for nothing; how often a restart was asked for.
int go_on(RestartRule& rule, int sweeps, double moved) {
  int restarts = 0;
  for (int k = 0; k < sweeps; ++k) restarts += rule.asks(-1, moved);
  return restarts;
}

}  // namespace

TEST_CASE("a product above zero asks for a restart, a movement that grows a little does not") {
  RestartRule rule;
  REQUIRE_FALSE(rule.asks(-1, 1.0));
  REQUIRE_FALSE(rule.asks(-1, 3.9));
  REQUIRE(rule.asks(1, 0.5));
  REQUIRE_FALSE(rule.asks(-1, 100.0));  // the first after a restart: nothing to compare it with
}

TEST_CASE("after a growth to more than four times the least no growth is let through") {
  RestartRule rule;
  REQUIRE(go_on(rule, 20, 1.0) == 0);
  REQUIRE(rule.asks(-1, 4.1));
  REQUIRE_FALSE(rule.asks(-1, 4.0));
  REQUIRE(rule.asks(-1, 4.04));
}

TEST_CASE("strictness ends with sixty sweeps that did not halve the movement, and lasts while they do") {
  RestartRule rule;
  go_on(rule, 20, 1.0);
  REQUIRE(rule.asks(-1, 5.0));
  REQUIRE(go_on(rule, 60, 5.0) == 0);
  REQUIRE(rule.asks(-1, 5.1));         // the 61st: still strict when it asks, and the last
  REQUIRE_FALSE(rule.asks(-1, 5.0));
  REQUIRE_FALSE(rule.asks(-1, 5.2));   // loose again
  RestartRule other;
  go_on(other, 20, 1.0);
  REQUIRE(other.asks(-1, 5.0));
  REQUIRE(go_on(other, 40, 5.0) == 0);
  REQUIRE_FALSE(other.asks(-1, 1.2));  // a quarter in energy is half in length
  REQUIRE(go_on(other, 60, 1.2) == 0);
  REQUIRE(other.asks(-1, 1.3));
}

TEST_CASE("only a strict time after a loose one that grew at once is futile") {
  RestartRule rule;
  go_on(rule, 20, 1.0);
  rule.asks(-1, 5.0);
  go_on(rule, 61, 5.0);
  REQUIRE_FALSE(rule.is_futile());  // twenty sweeps had gone well before
  go_on(rule, 3, 5.0);
  REQUIRE(rule.asks(-1, 21.0));
  go_on(rule, 60, 21.0);
  REQUIRE_FALSE(rule.is_futile());
  go_on(rule, 1, 21.0);
  REQUIRE(rule.is_futile());
  go_on(rule, 1, 21.0);
  REQUIRE_FALSE(rule.is_futile());
}

}  // namespace momentum_tests
