#include <delassus/adapters/fcl.hpp>

#include "table_of_scenes.hpp"

using namespace scenes;

TEST_CASE("stacks of five and ten boxes, cubes, cylinders and all of them stand on FCL's contacts",
          "[table]") {
  check_stacks<FclCollision>("FCL");
}
TEST_CASE("a pyramid stands on FCL's contacts", "[table]") { check_pyramid<FclCollision>(); }
TEST_CASE("a body created touching the floor stays where it is, with FCL", "[table]") {
  check_no_jump<FclCollision>();
}
TEST_CASE("a box on 30 degrees stays with friction 0.6 and goes with 0.55, with FCL", "[table]") {
  check_slope<FclCollision>();
}
