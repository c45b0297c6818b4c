#include <delassus/adapters/ccd.hpp>

#include "table_of_scenes.hpp"

using namespace scenes;

TEST_CASE("stacks of five and ten boxes, cubes, cylinders and all of them stand on libccd's contacts",
          "[table]") {
  check_stacks<CcdCollision>("libccd");
}
TEST_CASE("a pyramid stands on libccd's contacts", "[table]") { check_pyramid<CcdCollision>(); }
TEST_CASE("a body created touching the floor stays where it is, with libccd", "[table]") {
  check_no_jump<CcdCollision>();
}
TEST_CASE("a box on 30 degrees stays with friction 0.6 and goes with 0.55, with libccd", "[table]") {
  check_slope<CcdCollision>();
}
