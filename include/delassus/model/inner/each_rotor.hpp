/// The rotors of a machine's joints in a loop.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/joints/any_axis.hpp>
#include <delassus/constraints/joints/rotor_inertia.hpp>
#include <delassus/model/inner/count_turns.hpp>
#include <delassus/model/machine.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus::inner {

template <class C>
C coordinate_of_rotor(const RotorInertia<C>&);

/// f(j, item) for the `RotorInertia` of each joint j of the machine that has one.
template <class Loop, class F>
void each_rotor([[maybe_unused]] Loop& loop, [[maybe_unused]] const Machine& machine, [[maybe_unused]] F&& f) {
  if constexpr (requires { loop.data().laws(); })
    each_kept_pool(loop.data().laws(), [&](auto, auto& pool) {
      using Law = std::remove_cvref_t<decltype(pool.law)>;
      if constexpr (requires { requires Law::resists; }) {
        using C = decltype(coordinate_of_rotor(std::declval<Law>()));
        for (std::size_t k = 0; k < pool.items.size(); ++k) {
          if (!pool.slots.is_alive(Index(k))) continue;
          auto& item = pool.items[k];
          for (std::size_t j = 0; j < machine.axes.size(); ++j) {
            const model::Axis& axis = machine.axes[j];
            const bool is_kind = with_axis(axis.kind, []<class D>() { return std::is_same_v<C, D>; });
            if (is_kind && is_same_end(axis.b, item.b) && is_same_end(axis.a, item.a)) f(Index(j), item);
          }
        }
      }
    });
}

}  // namespace delassus::inner
