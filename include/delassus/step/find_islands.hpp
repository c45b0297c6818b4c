/// Islands: which constraints and bodies depend on each other in this step.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/rows/islands.hpp>

#include <array>
#include <cstddef>
#include <span>

namespace delassus {

/// Blocks of all sets count on from each other; those that a set ties together are in one island.
template <class World, class Rows, int pools>
void find_islands(World& world, const Rows& rows, Islands<pools>& islands) {
  std::array<Index, std::size_t(World::set_count)> first{};
  Index blocks = 0;
  world.each([&](const auto& set, auto s) {
    first[s] = blocks;
    blocks += set.blocks();
  });
  const auto moves = [&](auto s, Index b) { return world.template set<s>().moves(b); };
  const auto ties = [&](const auto& tie) {
    world.each([&](const auto& set, auto s) {
      const auto both = [&](Index a, Index b) { tie(first[s] + a, first[s] + b); };
      if constexpr (requires { set.each_tie(both); }) set.each_tie(both);
    });
  };
  islands.find(rows, std::span<const Index>(first), blocks, moves, ties);
}

}  // namespace delassus
