#include <delassus/adapters/ccd.hpp>

#include "collision/table_of_contacts.hpp"

using namespace scenes;

TEST_CASE("libccd: swapped bodies give the same distance and the opposite normal", "[table]") {
  check_swap<CcdKernel>();
}
TEST_CASE("libccd: what touches to the last bit has the floor's normal and no false depth", "[table]") {
  check_touch_ladder<CcdCollision>();
}
TEST_CASE("libccd: concentric bodies get a unit normal and the least depth", "[table]") {
  check_concentric<CcdKernel>();
}
TEST_CASE("libccd: gaps from 1e-9 m have all their digits", "[table]") { check_gaps<CcdKernel>(); }
TEST_CASE("libccd: needles, plates and giants are bodies like any other", "[table]") {
  check_extremes<CcdKernel>(0.3);
}
TEST_CASE("libccd: a million metres from the origin the deepest contact is as deep as at home", "[table]") {
  check_far_away<CcdCollision>(5e-2);
}
TEST_CASE("libccd: each way of resting has its number of contacts", "[table]") {
  check_counts<CcdCollision>();
}
TEST_CASE("libccd: contacts do not jump for tiny tilts", "[table]") { check_no_jump_by_tilt<CcdCollision>(); }
TEST_CASE("libccd: points keep their names while a body slides", "[table]") { check_names<CcdCollision>(); }
TEST_CASE("libccd: a run again, bodies in another order and four threads give the same bits", "[table]") {
  check_same_bits<CcdCollision>();
}
TEST_CASE("libccd: no bullet passes a plate at any phase of the step", "[table]") {
  check_bullets<CcdCollision>();
}
