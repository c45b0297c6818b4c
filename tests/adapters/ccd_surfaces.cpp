#include <delassus/adapters/ccd.hpp>

#include "soft_contacts_of.hpp"

using namespace delassus;

TEST_CASE("with libccd, bodies meet a soft one between its nodes as they do natively") {
  scenes::check_soft_contacts<CcdCollision>();
}
