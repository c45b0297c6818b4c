// The pile, with FCL's tree and distances: one of the two pile_*.cpp is built.
#include "pile.hpp"

#include <delassus/adapters/fcl.hpp>

namespace demonstration {

Scene pile(bool is_quick, const Watch& watch) { return drop_pile(FclCollision{.margin = 0.02}, "FCL", is_quick, watch); }

}  // namespace demonstration
