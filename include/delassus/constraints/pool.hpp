/// All constraints of one law.
#pragma once

#include <delassus/constraints/law.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/block_array.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/core/handle.hpp>
#include <delassus/core/slots.hpp>
#include <delassus/rows/anchor.hpp>

#include <concepts>
#include <string>
#include <type_traits>
#include <vector>

namespace delassus {

/// Names one constraint of a law.
template <class Law_>
struct ConstraintHandle {
  using Law = Law_;
  Index index = -1;
  std::uint32_t generation = 0;
  std::uint32_t owner = 0;  ///< its pool's own number; copies of a loop share it

  friend bool operator==(const ConstraintHandle&, const ConstraintHandle&) = default;
};

template <class Law>
struct Pool;

namespace inner {

struct NeverBreaks {};

/// Functions of a pool that a program can compile once, without the classes of all pools in each of its files.
template <class Law>
ConstraintHandle<Law> add_item(Pool<Law>& pool, const typename Law::Item& item);
template <class Char>
std::basic_string<Char> stale_constraint(std::uint32_t owner, const std::basic_string<Char>& what);

}  // namespace inner

/// Items in places that never move, the impulse each had last step, and the list of live ones.
template <class Law>
struct Pool {
  static constexpr int rows = Law::rows;
  using Item = typename Law::Item;

  Law law{};
  ArrayOrVector<Item> items;
  BlockArray<Vec<rows>> impulse;  ///< N·s of the last step, by item: the warm start
  Array<char> starts_cold;   ///< that impulse is no start for the next step
  Slots slots;
  std::uint32_t owner = inner::next_owner();
  /// Who broke in the last step, and goes when the next one begins.
  [[no_unique_address]] std::conditional_t<refines<Law>(refine::breaks), std::vector<ConstraintHandle<Law>>, inner::NeverBreaks> broken;

  Pool() = default;
  explicit Pool(Law l) : law(std::move(l)) {}

  ConstraintHandle<Law> add(const Item& item) { return inner::add_item(*this, item); }

  ConstraintHandle<Law> handle(Index place) const {
    DELASSUS_EXPECT(slots.is_alive(place), "constraint: place " + std::to_string(place) + " of this law holds none");
    return {place, slots.generation(place), owner};
  }
  /// What is wrong with a handle that this pool does not contain.
  static std::string stale(ConstraintHandle<Law> h, const std::string& what) {
    return inner::stale_constraint(h.owner, what);
  }
  bool contains(ConstraintHandle<Law> h) const { return h.owner == owner && slots.is_current(h.index, h.generation); }

  void remove(ConstraintHandle<Law> h) {
    DELASSUS_EXPECT(contains(h), "remove: " + stale(h, "this constraint was removed before"));
    slots.release(h.index);
  }

  /// Takes out every item one of whose anchors sits on this block: its body goes.
  void remove_on(std::uint32_t set, Index block) {
    if constexpr (HasEnds<Item>)
      for (Index k = 0; k < Index(items.size()); ++k) {
        if (!slots.is_alive(k)) continue;
        bool sits_there = false;
        each_end(items[k], [&](const Anchor& a) { sits_there = sits_there || (a.owner == set && a.block == block); });
        if (sits_there) slots.release(k);
      }
  }

  static void each_array(auto& self, auto&& f) {
    f(self.items), f(self.impulse), f(self.starts_cold);
    if constexpr (refines<Law>(refine::breaks)) f(self.broken);
    self.slots.each_array(self.slots, f);
  }
  void memory(auto& archive) {
    archive(items, impulse, starts_cold, slots);
    if constexpr (refines<Law>(refine::breaks)) archive(broken);
  }

  /// The item of a constraint that is there; refuses another.
  Item& item_of(ConstraintHandle<Law> h) {
    DELASSUS_EXPECT(contains(h), "item: " + stale(h, "this constraint was removed"));
    return items[h.index];
  }
  /// The item behind the i-th rows of this step.
  const Item& item(Index i) const { return items[slots.active()[i]]; }
  Index count() const { return Index(slots.active().size()); }
};

namespace inner {

template <class Law>
ConstraintHandle<Law> add_item(Pool<Law>& pool, const typename Law::Item& item) {
  const Index place = pool.slots.take();
  if (place == Index(pool.items.size())) {
    pool.items.push_back(item);
    pool.impulse.resize(pool.items.size());
    pool.starts_cold.push_back(0);
  }
  pool.items[place] = item;
  pool.impulse.set_zero(std::size_t(place));
  pool.starts_cold[place] = 0;
  return {place, pool.slots.generation(place), pool.owner};
}
template <class Char>
std::basic_string<Char> stale_constraint(std::uint32_t owner, const std::basic_string<Char>& what) {
  return wrong_handle(owner, "constraint", what + ", or is another loop's; its handle is stale");
}

}  // namespace inner

/// What is not a law has no items; the loop's checks say what it lacks.
template <class Law>
  requires(!ConstraintLaw<Law>)
struct Pool<Law> {
  Law law{};

  Pool() = default;
  explicit Pool(Law l) : law(std::move(l)) {}

  Index count() const { return 0; }
};

/// Contacts are made anew each step; their impulses are remembered by contact id, not here.
template <class Law>
  requires(ConstraintLaw<Law> && ContactLaw<Law>)
struct Pool<Law> {
  static constexpr int rows = Law::rows;
  using Item = typename Law::Item;

  Law law{};
  ArrayOrVector<Item> items;

  Pool() = default;
  explicit Pool(Law l) : law(std::move(l)) {}

  static void each_array(auto& self, auto&& f) { f(self.items); }
  const Item& item(Index i) const { return items[i]; }
  Index count() const { return Index(items.size()); }
};

}  // namespace delassus
