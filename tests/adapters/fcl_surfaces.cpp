#include <delassus/adapters/fcl.hpp>

#include "soft_contacts_of.hpp"

using namespace delassus;

TEST_CASE("with FCL, bodies meet a soft one between its nodes as they do natively") {
  scenes::check_soft_contacts<FclCollision>();
}
