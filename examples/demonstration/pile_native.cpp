// The pile, with the library's own collision detection: one of the two pile_*.cpp is built.
#include "pile.hpp"

namespace demonstration {

Scene pile(bool is_quick, const Watch& watch) { return drop_pile(NativeCollision{.margin = 0.02}, "native", is_quick, watch); }

}  // namespace demonstration
