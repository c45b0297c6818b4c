#include <delassus/listeners/triple_buffer.hpp>

#include "catch.hpp"

#include <array>
#include <cstdint>
#include <set>
#include <vector>

using namespace delassus;

TEST_CASE("a reader of a triple buffer gets the newest value once, and keeps it") {
  TripleBuffer<int> buffer;
  REQUIRE_FALSE(buffer.fetch());
  for (int k = 1; k <= 3; ++k) {
    buffer.back() = k;
    buffer.publish();
  }
  REQUIRE(buffer.fetch());
  REQUIRE(buffer.front() == 3);
  REQUIRE_FALSE(buffer.fetch());
  REQUIRE(buffer.front() == 3);
}

TEST_CASE("in every order of twelve calls the reader sees the last value published, and the slots stay apart") {
  // One bit a call: publish or fetch. All 4096 orders; a triple buffer has 3! places times fresh or not, so twelve calls
  // reach every state by every way.
  for (unsigned order = 0; order < 4096; ++order) {
    TripleBuffer<int> buffer;
    int published = 0, seen = 0;
    for (int call = 0; call < 12; ++call) {
      if (order >> call & 1) {
        buffer.back() = ++published;
        buffer.publish();
      } else {
        const bool is_new = buffer.fetch();
        REQUIRE(is_new == (published > seen));
        seen = published;
      }
      REQUIRE(buffer.front() == seen);
      REQUIRE(&buffer.front() != &buffer.back());
    }
  }
}

TEST_CASE("a triple buffer never moves a slot: three addresses, for ever") {
  TripleBuffer<std::vector<int>> buffer;
  std::set<const void*> seen;
  for (int k = 0; k < 100; ++k) {
    buffer.back().assign(10, k);
    seen.insert(&buffer.back());
    buffer.publish();
    if (k % 3 == 0) buffer.fetch();
  }
  REQUIRE(seen.size() == 3);
}
