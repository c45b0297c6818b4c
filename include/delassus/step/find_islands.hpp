/// Islands: which constraints and bodies depend on each other in this step.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/rows/islands.hpp>

namespace delassus {

/// Blocks of all sets count on from each other; those that a set ties together are in one island.
template <class World, class T>
void find_islands(World& world, AllRows<T> rows, Islands<T>& islands) {
  Index first[World::set_count + 1];
  Index blocks = 0;
  islands.clear_blocks();
  world.each([&](const auto& set, auto s) __attribute__((always_inline)) {
    first[s] = blocks;
    blocks += set.blocks();
    for (Index b = 0; b < set.blocks(); ++b) islands.add_block(set.moves(b));
    if constexpr (requires { set.each_tie([](Index, Index) {}); })
      set.each_tie([&](Index a, Index b) { islands.tie(first[s] + a, first[s] + b); });
  });
  islands.find(rows, first);
}

}  // namespace delassus
