#include <delassus/core/expect.hpp>

#include <string>

#include "catch.hpp"

namespace {

/// Counts how often the sentence was made.
std::string sentence(int& made) {
  ++made;
  return "mass must be positive, got " + delassus::inner::text(-2.5);
}

}  // namespace

TEST_CASE("bad input throws the sentence, under the library's name") {
  int made = 0;
  REQUIRE_THROWS_WITH([&] { DELASSUS_EXPECT(false, sentence(made)); }(),
                      "delassus: mass must be positive, got -2.5");
  REQUIRE_THROWS_AS([&] { DELASSUS_EXPECT(false, sentence(made)); }(), delassus::InvalidArgument);
  REQUIRE_THROWS_AS([&] { DELASSUS_EXPECT(false, sentence(made)); }(), std::invalid_argument);
}

TEST_CASE("good input never makes the sentence") {
  int made = 0;
  DELASSUS_EXPECT(true, sentence(made));
  REQUIRE(made == 0);
}
