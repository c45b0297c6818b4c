/// Who the last advance left where it was, and who had been given a load that is not finite.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

namespace delassus::inner {

/// All blocks of an island are held when one is sick: `loaded` is the one to blame, where there is one.
struct QuarantineRecord {
  Index count = 0;    ///< of bodies
  Index first = -1;   ///< a block of the first of them
  Index loaded = -1;  ///< the first block held whose force or torque was not finite

  /// The body of one block whose load this is, of all that start at `first_load`. Never inlined, and without the block's
  /// number: what hardly ever happens takes no register of the loop over the bodies.
  template <class Load>
  [[gnu::cold, gnu::noinline]] void leave(const Load* first_load, Load& load) {
    ++count;
    note(Index(&load - first_load), is_finite(load));
    set_zero(load);
  }
  /// Adds what another says of blocks that come later.
  void join(const QuarantineRecord& later) {
    count += later.count;
    if (first < 0) first = later.first;
    if (loaded < 0) loaded = later.loaded;
  }
  void note(Index block, bool has_finite_load) {
    if (first < 0) first = block;
    if (loaded < 0 && !has_finite_load) loaded = block;
  }
};

}  // namespace delassus::inner
