/// Constraints that end with a step: those whose bodies are gone, and those that break.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/core/fixed_array.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/step/law_rows.hpp>

#include <cstddef>

namespace delassus::inner {

/// Takes out every constraint one of whose bodies is gone: a host may remove bodies through their set.
template <class T>
void drop_stale(const WorldView<T>& world, AllLaws<T> laws) {
  for (const LawPool<T>& pool : laws)
    if (pool.law->drop_stale) pool.law->drop_stale(pool.pool, world);
}

/// The same, where bodies may have gone since the last call: `seen` is what the sets were then.
template <class World, class T>
void drop_stale(const World& world, const WorldView<T>& view, AllLaws<T> laws, FixedArray<SetVersion, std::size_t(World::set_count)>& seen) {
  bool may_be_stale = false;
  world.each([&](const auto& set, auto s) {
    if constexpr (requires { set.version(); }) {
      const SetVersion now = set.version();
      may_be_stale = may_be_stale || now != seen[s];
      seen[s] = now;
    } else {
      may_be_stale = true;
    }
  });
  if (may_be_stale) [[unlikely]]
    drop_stale(view, laws);
}

/// f(pool) for the pools of laws that break.
[[gnu::always_inline]] inline void each_breakable_pool(auto& laws, auto&& f) {
  each_kept_pool(laws, [&](auto, auto& pool) __attribute__((always_inline)) {
    if constexpr (requires { pool.broken.size(); }) f(pool);
  });
}

/// After the solve: who broke. Its handle, its impulse and its rows stay until the next step begins.
void note_broken(auto& laws, double h) {
  each_breakable_pool(laws, [&](auto& pool) {
    for (const Index k : pool.slots.active())
      if (pool.law.breaks(pool.items[k], pool.impulse[k], h)) pool.broken.push_back({k, pool.slots.generation(k), pool.owner});
  });
}

/// Takes out what broke in the step before.
void drop_broken(auto& laws) {
  each_breakable_pool(laws, [&](auto& pool) {
    for (const auto& joint : pool.broken)
      if (pool.slots.is_current(joint.index, joint.generation)) pool.slots.release(joint.index);
    pool.broken.clear();
  });
}

}  // namespace delassus::inner
