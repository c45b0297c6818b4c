/// The laws of all pools with what they remember between sweeps, as a solver sees them.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/core/array.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>

#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus {

template <class Constraints, class T>
class LawSet;

/// Calls each law with its item and its memory. `prepare` runs once a step, when W is built.
template <class... Laws, class T>
class LawSet<Constraints<Laws...>, T> {
  using Memories = std::tuple<ArrayOrVector<inner::memory_of_t<inner::innermost_t<Laws>, T>>...>;
  template <int p>
  using Law = std::tuple_element_t<p, std::tuple<Laws...>>;
  template <int p>
  using Pool = decltype(std::declval<const Constraints<Laws...>&>().template pool<p>());
  template <int p>
  using Memory = typename std::tuple_element_t<p, Memories>::value_type;

 public:
  LawSet() = default;  ///< of nothing, before it is attached
  explicit LawSet(const Constraints<Laws...>& constraints) : constraints_(&constraints) {}

  /// The constraints may have moved with their loop.
  void attach(const Constraints<Laws...>& constraints) { constraints_ = &constraints; }

  /// Room for `items` of each law: `prepare` allocates nothing up to there.
  void reserve(std::size_t items) {
    std::apply([&](auto&... memory) { (memory.reserve(items), ...); }, memory_);
  }

  void prepare(const auto& W, const auto& rows, double h) {
    for_each_index<sizeof...(Laws)>([&](auto p) {
      auto& memory = std::get<p>(memory_);
      memory.resize(rows.template pool<p>().items());
      for (Index i = 0; i < Index(memory.size()); ++i) prepare_item<p>(i, W.template diagonal<p>(i), h);
    });
  }
  template <int p, class Own>
  void prepare_item(Index i, const Own& own_block, double h) {
    const auto& pool = constraints_->template pool<p>();
    inner::prepare(pool.law, pool.item(i), own_block, h, std::get<p>(memory_)[i]);
  }

  /// λ that meets the law of item i, whose own block is W and whose velocity without it is b.
  template <int p, int R>
  [[gnu::always_inline]] Vec<R, T> solve_local(Index i, const Mat<R, R, T>& W, const Vec<R, T>& b) {
    const auto& pool = constraints_->template pool<p>();
    return inner::solve_local(pool.law, pool.item(i), W, b, std::get<p>(memory_)[i]);
  }

  /// s λ − P_K(s λ − ũ); by default W_ii (λ − what the law would make of it), in the units of s λ.
  template <int p, int R>
  Vec<R, T> natural_map(Index i, const Local<R, T>& c, T scale) {
    const auto& pool = constraints_->template pool<p>();
    if constexpr (refines<Law<p>>(refine::natural_map)) {
      return asked<p, refine::natural_map>().natural_map(given<p>(i), c.lambda, c.d, scale);
    } else {
      auto memory = std::get<p>(memory_)[i];
      const Vec<R, T> change = c.lambda - inner::solve_local(pool.law, pool.item(i), c.W, c.free_velocity(), memory);
      return (scale * T(R) / trace(c.W)) * (c.W * change);
    }
  }

  /// |natural_map|² at `scale` and at 1, where the law knows both at once.
  template <int p, int R>
    requires(refines<Law<p>>(refine::natural_squares))
  Vec<2, T> natural_squares(Index i, const Local<R, T>& c, T scale) const {
    return asked<p, refine::natural_squares>().natural_squares(given<p>(i), c.lambda, c.d, scale);
  }

  template <int p>
  static constexpr auto kinds() {
    return row_kinds<Law<p>>();
  }
  /// Whether the law of pool p is a round cone, and its μ.
  template <int p>
  static constexpr bool has_cone() {
    constexpr auto law_kinds = kinds<p>();
    if constexpr (law_kinds.size() != 3 || !requires(Pool<p> pool) { pool.item(0).parameters.friction; })
      return false;
    else
      return law_kinds[0] == RowKind::lower && law_kinds[1] == RowKind::friction && law_kinds[2] == RowKind::friction;
  }
  template <int p>
  double friction(Index i) const {
    return double(constraints_->template pool<p>().item(i).parameters.friction);
  }

  /// −∂λ/∂d of the impulse that meets the law where W is diagonal, and that impulse: see `constraints/law.hpp`.
  template <int p, int R, class N>
    requires(refines<Law<p>>(refine::tangent))
  Mat<R, R, N> tangent(Index i, Local<R, N>& c) const {
    const auto& law = asked<p, refine::tangent>();
    if constexpr (requires { law.tangent(given<p>(i), c); })
      return law.tangent(given<p>(i), c);
    else
      return law.tangent(given<p>(i), c, std::get<p>(memory_)[i]);
  }

  /// The same with the slip of friction rows given, where the law has a convex form.
  template <int p, int R, class N>
    requires(refines<Law<p>>(refine::tangent))
  Mat<R, R, N> convex_tangent(Index i, Local<R, N>& c, N slip) const {
    if constexpr (refines<Law<p>>(refine::convex_tangent))
      return asked<p, refine::convex_tangent>().convex_tangent(given<p>(i), c, slip);
    else
      return tangent<p>(i, c);
  }

  /// Whether the law of pool p has a cone or a cap of its own.
  template <int p>
  static consteval bool clamps() {
    return refines<Law<p>>(refine::clamp);
  }
  template <int p, int R>
  void clamp(Index i, Vec<R, T>& lambda) const {
    const auto& pool = constraints_->template pool<p>();
    if constexpr (clamps<p>()) inner::clamp(pool.law, pool.item(i), lambda, std::get<p>(memory_)[i]);
  }

 private:
  /// The law of pool p that has this refinement, and what it is given for item i.
  template <int p, unsigned what>
  [[gnu::always_inline]] const auto& asked() const {
    return inner::who_refines<what>(constraints_->template pool<p>().law);
  }
  template <int p>
  [[gnu::always_inline]] const auto& given(Index i) const {
    return inner::given<Law<p>>(constraints_->template pool<p>().item(i));
  }

  const Constraints<Laws...>* constraints_ = nullptr;
  Memories memory_;
};

}  // namespace delassus
