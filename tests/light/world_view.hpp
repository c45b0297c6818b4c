/// The bodies as a law and the solver see them: a list of sets behind tables, whatever their types.
#pragma once

#include "set_table.hpp"

#include <delassus/bodies/world.hpp>
#include <delassus/core/array.hpp>

namespace light {

/// One set and where its blocks and velocities begin in the world's count.
template <class T>
struct SetView {
  const void* set;
  const SetTable<T>* table;
  Index first_block, first_velocity;
  bool is_coupled;
};

template <class T>
struct WorldView {
  Array<SetView<T>> sets;
  Index blocks = 0, velocities = 0;

  WorldView() = default;
  template <class... Sets>
  explicit WorldView(const World<Sets...>& world) {
    world.each(
        [&](const auto& set, auto) { add(&set, FunctionsOf<std::remove_cvref_t<decltype(set)>>::table); });
  }
  void add(const void* set, const SetTable<T>& table) {
    sets.push_back({set, &table, blocks, velocities, table.is_coupled(set)});
    blocks += table.blocks(set);
    velocities += table.width * table.blocks(set);
  }

  Vec3 point(const Anchor& a) const { return a.set < 0 ? a.local : of(a).table->point(of(a).set, a); }
  Quat frame(const Anchor& a) const { return a.set < 0 ? a.frame : of(a).table->frame(of(a).set, a); }
  Mat3 axes(const Anchor& a) const { return frame(a).toRotationMatrix(); }
  const SetView<T>& of(const Anchor& a) const { return sets[std::size_t(a.set)]; }
};

}  // namespace light
