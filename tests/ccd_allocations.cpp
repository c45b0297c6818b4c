#include "allocations/count_allocations.hpp"

#include <delassus/adapters/ccd.hpp>

#include "allocations/allocation_scenes.hpp"

TEST_CASE("a warm step of ten jointed boxes allocates nothing with libccd") {
  REQUIRE(allocations_of_jointed_stack(CcdCollision{}) == 0);
}
