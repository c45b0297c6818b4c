#include "table_of_scenes.hpp"

namespace table_tests {

using namespace scenes;

TEST_CASE("stacks of five and ten boxes, cubes, cylinders and all of them stand natively", "[table]") {
  check_stacks<NativeCollision>("native");
}
TEST_CASE("a pyramid stands natively", "[table]") { check_pyramid<NativeCollision>(); }
TEST_CASE("a body created touching the floor stays where it is, natively", "[table]") {
  check_no_jump<NativeCollision>();
}
TEST_CASE("a box on 30 degrees stays with friction 0.6 and goes with 0.55, natively", "[table]") {
  check_slope<NativeCollision>();
}

}  // namespace table_tests
