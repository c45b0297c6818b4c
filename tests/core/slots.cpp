#include <delassus/core/slots.hpp>

#include "catch.hpp"

using delassus::Index;
using delassus::Slots;

TEST_CASE("places are handed out in order and stay where they are") {
  Slots slots;
  REQUIRE(slots.take() == 0);
  REQUIRE(slots.take() == 1);
  REQUIRE(slots.take() == 2);
  slots.release(1);
  REQUIRE(slots.size() == 3);
  REQUIRE(slots.active() == std::vector<Index>{0, 2});
}

TEST_CASE("a place given back is reused under a new generation") {
  Slots slots;
  const Index place = slots.take();
  const auto before = slots.generation(place);
  slots.release(place);
  REQUIRE_FALSE(slots.is_alive(place));
  REQUIRE(slots.take() == place);
  REQUIRE(slots.is_alive(place));
  REQUIRE_FALSE(slots.is_current(place, before));
  REQUIRE(slots.is_current(place, slots.generation(place)));
}

TEST_CASE("no place outside the list is alive") {
  Slots slots;
  slots.take();
  REQUIRE_FALSE(slots.is_alive(-1));
  REQUIRE_FALSE(slots.is_alive(1));
}

TEST_CASE("the live places are listed in ascending order whatever the order of removal") {
  Slots slots;
  for (int i = 0; i < 6; ++i) slots.take();
  slots.release(4);
  slots.release(1);
  slots.take();  // reuses 1, the last one freed
  REQUIRE(slots.active() == std::vector<Index>{0, 1, 2, 3, 5});
}

TEST_CASE("the count of removals is never again what it was, whatever the slots are put back to") {
  Slots slots;
  for (int i = 0; i < 3; ++i) slots.take();
  const Slots saved = slots;
  slots.release(0);
  const auto after = slots.removals();
  slots = saved;
  REQUIRE(slots.removals() > after);
  const auto back = slots.removals();
  slots.release(1);
  REQUIRE(slots.removals() > back);
}
