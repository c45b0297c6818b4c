#include <delassus/adapters/fcl.hpp>

#include "adapters/stacks.hpp"

using namespace scenes;

TEST_CASE("ten boxes stand for a minute on FCL's contacts") { check_ten_stand<FclCollision>(Box{1, 1, 1}); }
TEST_CASE("ten cubes given as points stand for a minute on FCL's contacts") {
  check_ten_stand<FclCollision>(cube_of_points());
}
TEST_CASE("ten cylinders stand for a minute on FCL's contacts") { check_ten_stand<FclCollision>(Cylinder{0.5, 1}); }
TEST_CASE("restored into a fresh loop, a stack on FCL's contacts goes on bit for bit") {
  require_same_bits_after_restore<FclCollision>();
}
