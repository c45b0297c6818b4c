#include <delassus/adapters/fcl.hpp>

#include "collision/table_of_contacts.hpp"

using namespace scenes;

TEST_CASE("FCL: swapped bodies give the same distance and the opposite normal", "[table]") {
  check_swap<FclKernel>();
}
TEST_CASE("FCL: what touches to the last bit has the floor's normal and no false depth", "[table]") {
  check_touch_ladder<FclCollision>();
}
TEST_CASE("FCL: concentric bodies get a unit normal and the least depth", "[table]") {
  check_concentric<FclKernel>();
}
TEST_CASE("FCL: gaps from 1e-9 m have all their digits", "[table]") { check_gaps<FclKernel>(); }
TEST_CASE("FCL: needles, plates and giants are bodies like any other", "[table]") {
  check_extremes<FclKernel>(0.3);
}
TEST_CASE("FCL: a million metres from the origin the deepest contact is as deep as at home", "[table]") {
  check_far_away<FclCollision>(5e-2);
}
TEST_CASE("FCL: each way of resting has its number of contacts", "[table]") { check_counts<FclCollision>(); }
TEST_CASE("FCL: contacts do not jump for tiny tilts", "[table]") { check_no_jump_by_tilt<FclCollision>(); }
TEST_CASE("FCL: points keep their names while a body slides", "[table]") { check_names<FclCollision>(); }
TEST_CASE("FCL: a run again, bodies in another order and four threads give the same bits", "[table]") {
  check_same_bits<FclCollision>();
}
TEST_CASE("FCL: the pairs of ten thousand boxes are those of brute force, run after run", "[table]") {
  check_pairs<FclTree>();
}
TEST_CASE("FCL: no bullet passes a plate at any phase of the step", "[table]") {
  check_bullets<FclCollision>();
}
