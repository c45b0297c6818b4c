#include <delassus/core/handle.hpp>

#include "catch.hpp"

using delassus::Handle;

struct Set {};

TEST_CASE("a handle that nobody gave out names no place") { REQUIRE(Handle<Set>{}.index == -1); }

TEST_CASE("two handles are equal only if place, generation and owner are") {
  const Handle<Set> handle{3, 1, 7};
  REQUIRE(handle == Handle<Set>{3, 1, 7});
  REQUIRE_FALSE(handle == Handle<Set>{4, 1, 7});
  REQUIRE_FALSE(handle == Handle<Set>{3, 2, 7});
  REQUIRE_FALSE(handle == Handle<Set>{3, 1, 8});
}

TEST_CASE("no two owners have the same number") {
  REQUIRE(delassus::inner::next_owner() != delassus::inner::next_owner());
}
