// A program of its own: it counts every call of operator new.
#define EIGEN_RUNTIME_NO_MALLOC
#include <delassus/adapters/ccd.hpp>

#include "allocation_scenes.hpp"

TEST_CASE("a warm step of ten jointed boxes allocates nothing with libccd") {
  REQUIRE(allocations_of_jointed_stack(CcdCollision{}) == 0);
}
