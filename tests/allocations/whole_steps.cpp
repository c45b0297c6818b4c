#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"

#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

TEMPLATE_TEST_CASE(
    "a warm step of a swinging chain allocates nothing under an integrator that makes its whole step", "",
    Rattle, RungeKutta4) {
  REQUIRE(allocations_of_swinging_chain(TestType{}) == 0);
}
