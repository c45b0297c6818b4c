/// What laws do once a step, pool by pool, without their types.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/row_past.hpp>
#include <delassus/core/ranges.hpp>
#include <delassus/rows/anchor.hpp>
#include <delassus/rows/contact_place.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/world_view.hpp>
#include <delassus/rows/writer.hpp>
#include <delassus/step/contact_cache.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace delassus {

/// Who is called with the two ends of each item that has them.
struct PairVisitor {
  void* who;
  void (*visit)(void* who, const Anchor& a, const Anchor& b);
};

/// One constant table a law and scalar. `pool` is its Pool of constraints.
template <class T>
struct LawSteps {
  const RowKind* kinds;   ///< of the rows of an item
  bool is_contact;
  bool has_slip;          ///< rows 1 and 2 are friction beside a contact's normal
  bool has_mean_springs;  ///< its springs see the mean velocity of the step
  /// Takes out every item one of whose bodies is gone; null: detection makes them anew.
  void (*drop_stale)(void* pool, const WorldView<T>&);
  /// Items that remember something of their pose (how often a wheel has turned) see the start of the step; null: none does.
  void (*follow)(void* pool, const WorldView<T>&);
  Index (*count)(const void* pool);  ///< of items
  void (*each_pair)(const void* pool, const PairVisitor&);  ///< null: contacts, whose ends are no anchors
  /// H and φ of the items first … last − 1 at the present configuration of the world. There is room for their rows; their
  /// entries are appended.
  void (*linearize)(const void* pool, const WorldView<T>&, const RowArrays<T>&, Index first, Index last);
  /// The speed that the rows of item i shall have, m/s or rad/s; null: zero.
  double (*speed)(const void* pool, Index i);
  /// Where item i acts; null: it has no slip.
  ContactPlace (*place)(const void* pool, Index i);
  /// e of item i, in [0, 1]; null: zero.
  double (*restitution)(const void* pool, Index i);
  /// What item i is called from step to step; null: it has no e.
  ItemName (*name)(const void* pool, const WorldView<T>&, Index i);
  /// λ ← `ratio` · λ of the last step, by contact id or by item, of some items; h in s. Who shares the items leaves those of a
  /// pair of bodies together.
  void (*warm_start)(const void* pool, const RowArrays<T>&, inner::Range, ContactCache&, ContactCache::Search&, double ratio, double h);
  /// Hands the impulses of some items back: to the items of the pool, or to the contacts as world vectors.
  void (*keep_impulses)(void* pool, const RowArrays<T>&, inner::Range, ContactCache&);
  /// The first item from i on that is of another pair of bodies than the one before it.
  Index (*next_pair)(const void* pool, Index i, const ContactCache&);
  /// Item i starts the next step from zero.
  void (*forget)(void* pool, Index i, ContactCache&);
};

/// A pool of constraints and what its law does.
template <class T>
struct LawPool {
  void* pool;
  const LawSteps<T>* law;
};

namespace inner {

/// Rows of friction beside a contact's normal: rows 1 and 2.
template <std::size_t rows>
constexpr bool has_slip(const std::array<RowKind, rows>& kinds) {
  if constexpr (rows >= 3)
    return kinds[0] == RowKind::lower && kinds[1] == RowKind::friction && kinds[2] == RowKind::friction;
  else
    return false;
}

/// A law whose springs see the mean velocity of the step.
template <class Law>
inline constexpr bool has_mean_springs = requires(const Law& contact) {
  requires std::remove_cvref_t<decltype(contact.law)>::takes_mean;
};

template <class Law, class T>
struct LawRows {
  static constexpr int R = Law::rows;
  static constexpr std::array<RowKind, R> kinds = row_kinds<Law>();

  static Pool<Law>& of(void* pool) { return *static_cast<Pool<Law>*>(pool); }
  static const Pool<Law>& of(const void* pool) { return *static_cast<const Pool<Law>*>(pool); }
  static Vec<R, T>* blocks(Array<T>& numbers) { return reinterpret_cast<Vec<R, T>*>(numbers.data()); }

  static void drop_stale([[maybe_unused]] void* at, [[maybe_unused]] const WorldView<T>& world) {
    if constexpr (!ContactLaw<Law>) {
      Pool<Law>& pool = of(at);
      for (Index i = 0; i < pool.count(); ++i) {
        bool is_stale = false;
        each_end(pool.item(i), [&](const Anchor& end) __attribute__((always_inline)) { is_stale = is_stale || !world.is_current(end); });
        if (is_stale) pool.slots.release(pool.slots.active()[i--]);
      }
    }
  }
  static void follow([[maybe_unused]] void* pool, [[maybe_unused]] const WorldView<T>& world) {
    if constexpr (refines<Law>(refine::follow))
      for (const Index place : of(pool).slots.active()) of(pool).law.follow(of(pool).items[place], world);
  }
  static Index count(const void* pool) { return of(pool).count(); }
  static void each_pair([[maybe_unused]] const void* at, [[maybe_unused]] const PairVisitor& visitor) {
    if constexpr (!ContactLaw<Law>) {
      const Pool<Law>& pool = of(at);
      for (Index i = 0; i < pool.count(); ++i) delassus::each_pair(pool.item(i), [&](const Anchor& a, const Anchor& b) { visitor.visit(visitor.who, a, b); });
    }
  }
  static void linearize(const void* at, const WorldView<T>& world, const RowArrays<T>& rows, Index first, Index last) {
    const Pool<Law>& pool = of(at);
    for (Index i = first; i < last; ++i) {
      rows.template begin<R>(i);
      pool.law.linearize(pool.item(i), world, RowWriter<T>(world, rows, i));
      rows.close();
    }
  }
  static double speed([[maybe_unused]] const void* pool, [[maybe_unused]] Index i) {
    if constexpr (refines<Law>(refine::speed)) return of(pool).law.speed(of(pool).item(i));
    else return 0;
  }
  static constexpr bool has_slip = ContactLaw<Law> && inner::has_slip(kinds);
  static ContactPlace place([[maybe_unused]] const void* pool, [[maybe_unused]] Index i) {
    if constexpr (has_slip) {
      const auto& item = of(pool).item(i);
      return {item.record, &item.point, &item.frame};
    } else {
      return {};
    }
  }
  static double restitution([[maybe_unused]] const void* pool, [[maybe_unused]] Index i) {
    if constexpr (refines<Law>(refine::restitution)) return of(pool).law.restitution(of(pool).item(i));
    else return 0;
  }
  static ItemName name(const void* at, [[maybe_unused]] const WorldView<T>& world, Index i) {
    const Pool<Law>& pool = of(at);
    if constexpr (ContactLaw<Law>) {
      const auto& record = *pool.item(i).record;
      return {record.pair, std::uint64_t(world.generation(record.a)) << 32 | world.generation(record.b), record.feature};
    } else {
      const Index place = pool.slots.active()[i];
      return {std::uint64_t(place), pool.slots.generation(place), 0};
    }
  }

  static void warm_start(const void* at, const RowArrays<T>& rows, Range range, ContactCache& cache, ContactCache::Search& search, double ratio, double h) {
    const Pool<Law>& pool = of(at);
    Vec<R, T>* lambda = blocks(*rows.lambda);
    for (Index i = range.first; i < range.last; ++i) {
      if constexpr (ContactLaw<Law>) {
        const auto& item = pool.item(i);
        const Vec3 impulse = ratio * cache.remembered(item.result, h, search);
        if (is_zero(impulse)) continue;
        const Vec3 own = item.frame * impulse;
        for (int k = 0; k < rows_along<R>; ++k) lambda[i][k] = T(own[k]);
        clamp(pool.law, item, lambda[i], NoMemory{});
      } else {
        (void)cache, (void)search, (void)h;
        const Index place = pool.slots.active()[i];
        if (pool.starts_cold[place]) set_all(lambda[i], T(0));
        else
          for (int k = 0; k < R; ++k) lambda[i][k] = T(ratio * pool.impulse[place][k]);
      }
    }
  }
  static void keep_impulses(void* at, const RowArrays<T>& rows, Range range, ContactCache& cache) {
    Pool<Law>& pool = of(at);
    const Vec<R, T>* lambda = blocks(*rows.lambda);
    for (Index i = range.first; i < range.last; ++i) {
      if constexpr (ContactLaw<Law>) {
        const auto& item = pool.item(i);
        ContactResult& result = cache.results[item.result];
        assign(result.impulse, world_impulse<R>(item.frame, lambda[i]));
        result.starts_cold = !is_finite(lambda[i]);
        result.is_sliding = who_refines<refine::is_sliding>(pool.law).is_sliding(given<Law>(item), lambda[i]);
      } else {
        (void)cache;
        const Index place = pool.slots.active()[i];
        for (int k = 0; k < R; ++k) pool.impulse[place][k] = double(lambda[i][k]);
        pool.starts_cold[place] = !is_finite(lambda[i]);
      }
    }
  }
  static Index next_pair(const void* at, Index i, [[maybe_unused]] const ContactCache& cache) {
    if constexpr (ContactLaw<Law>) {
      const Pool<Law>& pool = of(at);
      const auto pair = [&](Index k) { return cache.results[pool.item(k).result].record.pair; };
      while (i > 0 && i < pool.count() && pair(i) == pair(i - 1)) ++i;
    }
    return i;
  }
  static void forget(void* at, Index i, ContactCache& cache) {
    Pool<Law>& pool = of(at);
    if constexpr (ContactLaw<Law>) cache.results[pool.item(i).result].starts_cold = true;
    else (void)cache, pool.starts_cold[pool.slots.active()[i]] = 1;
  }

  static constexpr LawSteps<T> make_table() {
    return {kinds.data(),
            ContactLaw<Law>,
            inner::has_slip(kinds),
            inner::has_mean_springs<Law>,
            ContactLaw<Law> ? nullptr : drop_stale,
            refines<Law>(refine::follow) ? follow : nullptr,
            count,
            ContactLaw<Law> ? nullptr : each_pair,
            linearize,
            refines<Law>(refine::speed) ? speed : nullptr,
            has_slip ? place : nullptr,
            refines<Law>(refine::restitution) ? restitution : nullptr,
            refines<Law>(refine::restitution) ? name : nullptr,
            warm_start,
            keep_impulses,
            next_pair,
            forget};
  }
  static const LawSteps<T> table;
};

template <class Law, class T>
constinit const LawSteps<T> LawRows<Law, T>::table = make_table();

/// What a law does in the stages; a function for the same reason as `law_table`.
template <class Law, class T>
const LawSteps<T>* law_steps() {
  return &LawRows<Law, T>::table;
}

}  // namespace inner

/// The pools of a loop's laws: `PoolsOf laws(step.laws())`.
template <class Laws, class T>
class PoolsOf;
template <class... L, class T>
class PoolsOf<Constraints<L...>, T> {
 public:
  PoolsOf() = default;  ///< of nothing, before it is attached
  /// Const laws too: who only reads writes nothing.
  explicit PoolsOf(const Constraints<L...>& laws) { attach(laws); }

  /// The laws may have moved with their loop.
  void attach(const Constraints<L...>& laws) {
    if (of_ == &laws) return;
    of_ = &laws;
    each_pool(const_cast<Constraints<L...>&>(laws), [&]<class Law>(auto p, Pool<Law>& pool) __attribute__((always_inline)) {
      pools_[p] = {&pool, inner::law_steps<Law, T>()};
    });
  }
  /// A copy is of nothing.
  PoolsOf(const PoolsOf&) {}
  PoolsOf& operator=(const PoolsOf&) {
    of_ = nullptr;
    return *this;
  }

  inner::Slice<const LawPool<T>> all() const { return {pools_, sizeof...(L)}; }

 private:
  const void* of_ = nullptr;
  LawPool<T> pools_[sizeof...(L) + 1];
};

/// All laws of a step, in the order of the sweep.
template <class T>
using AllLaws = inner::Slice<const LawPool<T>>;

}  // namespace delassus
