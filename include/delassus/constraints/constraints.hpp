/// The constraint laws of a loop: a tuple of pools.
#pragma once

#include <delassus/constraints/pool.hpp>
#include <delassus/core/pack.hpp>
#include <delassus/core/roles.hpp>
#include <delassus/rows/row_system.hpp>

#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus {

/// `Constraints{Contact{Coulomb{}}, BallJoint{}}`: one pool a law, in the order of the sweep.
template <class... Laws>
class Constraints {
 public:
  using plays = role::Constraints;
  static constexpr int pool_count = int(sizeof...(Laws));
  static constexpr bool has_contacts = (ContactLaw<Laws> || ...);

  Constraints() = default;
  explicit Constraints(Laws... laws)
    requires(sizeof...(Laws) > 0)
      : pools_{{Pool<Laws>{std::move(laws)}}...} {}

  template <int p>
  auto& pool() {
    return inner::part<std::size_t(p)>(pools_);
  }
  template <int p>
  const auto& pool() const {
    return inner::part<std::size_t(p)>(pools_);
  }
  template <class Law>
  auto& of() {
    return inner::part<place_of<Law>()>(pools_);
  }
  template <class Law>
  const auto& of() const {
    return inner::part<place_of<Law>()>(pools_);
  }

  static void each_array(auto& self, auto&& f) {
    self.pools_.each([&](auto& p) { p.each_array(p, f); });
  }

  /// The law whose items are of this type, or void.
  template <class Item>
  struct law_of {
    template <class L>
    static constexpr bool fits = std::is_same_v<Item, typename L::Item> && !ContactLaw<L>;
    template <class... Ls>
    struct find {
      using type = void;
    };
    template <class L, class... Rest>
    struct find<L, Rest...> : std::conditional_t<fits<L>, std::type_identity<L>, find<Rest...>> {};
    using type = typename find<Laws...>::type;
  };

 private:
  /// Of the one pool of this law.
  template <class Law>
  static consteval std::size_t place_of() {
    constexpr bool is_it[] = {std::is_same_v<Law, Laws>..., false};
    constexpr int count = (int(std::is_same_v<Law, Laws>) + ... + 0);
    static_assert(count < 2,
                  "delassus: Constraints{...} lists this law twice; one entry holds any number of constraints, take "
                  "the other out");
    std::size_t place = 0;
    while (!is_it[place] && place < sizeof...(Laws)) ++place;
    return place;
  }

  [[no_unique_address]] inner::Pack<Pool<Laws>...> pools_;
};

template <class... Laws>
Constraints(Laws...) -> Constraints<Laws...>;

/// f(p, pool) for every pool of items that a host adds and that stay from step to step.
[[gnu::always_inline]] inline void each_kept_pool(auto& laws, auto&& f) {
  for_each_index<std::remove_cvref_t<decltype(laws)>::pool_count>([&](auto p) __attribute__((always_inline)) {
    auto& pool = laws.template pool<p>();
    if constexpr (requires { pool.slots; }) f(p, pool);
  });
}

/// f(p, pool) for every pool of items that collision detection makes anew in each step.
[[gnu::always_inline]] inline void each_contact_pool(auto& laws, auto&& f) {
  for_each_index<std::remove_cvref_t<decltype(laws)>::pool_count>([&](auto p) __attribute__((always_inline)) {
    auto& pool = laws.template pool<p>();
    if constexpr (ContactLaw<std::remove_cvref_t<decltype(pool.law)>>) f(p, pool);
  });
}

}  // namespace delassus
