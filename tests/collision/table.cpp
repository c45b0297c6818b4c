#include "collision/table_of_contacts.hpp"

namespace table_tests {

using namespace scenes;

TEST_CASE("native: swapped bodies give the same distance and the opposite normal", "[table]") {
  check_swap<GjkEpa>();
}
TEST_CASE("native: what touches to the last bit has the floor's normal and no false depth", "[table]") {
  check_touch_ladder<NativeCollision>();
}
TEST_CASE("native: gaps from 1e-9 m have all their digits", "[table]") { check_gaps<GjkEpa>(); }
TEST_CASE("native: a million metres from the origin the deepest contact is as deep as at home", "[table]") {
  check_far_away<NativeCollision>(0);
}
TEST_CASE("native: a run again, bodies in another order and four threads give the same bits", "[table]") {
  check_same_bits<NativeCollision>();
}
TEST_CASE("native: the pairs of ten thousand boxes are those of brute force, run after run", "[table]") {
  check_pairs<BoxTree>();
}
TEST_CASE("native: no bullet passes a plate at any phase of the step", "[table]") {
  check_bullets<NativeCollision>();
}

}  // namespace table_tests
