/// The loops of one law over spans of its items: what stands in its `LawTable`.
#pragma once

#include <delassus/constraints/law.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/fwd.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/rows/free_velocity.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/solvers/inner/row_weights.hpp>
#include <delassus/solvers/law_table.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>

namespace delassus::inner {

/// A law with the items and the memory of a pool.
template <class Law, class T>
struct LawItems {
  using Item = typename Law::Item;
  using Memory = memory_of_t<innermost_t<Law>, double>;
  static constexpr int R = Law::rows;
  using Weights = RowWeights<R, turning_rows<Law>()>;

  const Law& law;
  const Item* items;
  const Index* places;
  Memory* memory;

  [[gnu::always_inline]] explicit LawItems(const PoolView<T>& pool)
      : law(*static_cast<const Law*>(pool.law)),
        items(static_cast<const Item*>(pool.law_items)),
        places(pool.places),
        memory(static_cast<Memory*>(pool.memory)) {}

  [[gnu::always_inline]] const Item& item(Index i) const {
    if constexpr (ContactLaw<Law>) return items[i];
    else return items[places ? places[i] : i];
  }
  /// λ that meets the law at free velocity b.
  [[gnu::always_inline]] Vec<R, double> solve_local(Index i, const auto* own, const Vec<R, double>& b, Memory& m, const Vec<R, double>& lambda) const {
    if constexpr (requires(Vec<R, double>& x) { law.relax(as_square<R>(own), b, x); }) {
      Vec<R, double> next = lambda;
      law.relax(as_square<R>(own), b, next);
      return next;
    } else {
      (void)lambda, (void)m;
      const auto& solved = innermost(law);
      if constexpr (RemembersBetweenSweeps<innermost_t<Law>>) return solved.solve_local(given<Law>(item(i)), as_square<R>(own), b, m);
      else return solved.solve_local(given<Law>(item(i)), as_square<R>(own), b);
    }
  }
  [[gnu::always_inline]] void clamp(Index i, Vec<R, double>& lambda) const { inner::clamp(law, item(i), lambda, memory[i]); }
  /// s λ − P_K(s λ − ũ); by default W_ii (λ − what the law would make of it), in the units of s λ. Where
  /// W_ii = 0 no λ does anything: none is wrong.
  [[gnu::always_inline]] Vec<R, double> natural_map(Index i, const auto* own, const Vec<R, double>& lambda, const Vec<R, double>& u,
                                                    const Weights& scale) const {
    if constexpr (refines<Law>(refine::natural_map)) {
      const auto& asked = who_refines<refine::natural_map>(law);
      if constexpr (Weights::is_mixed && requires { asked.natural_map(given<Law>(item(i)), lambda, u, 1.0, 1.0); })
        return asked.natural_map(given<Law>(item(i)), lambda, u, scale.motion, scale.turn);
      else
        return asked.natural_map(given<Law>(item(i)), lambda, u, scale.motion);
    } else {
      const Mat<R, R, double> W = load_square<R>(own);
      Memory m = memory[i];
      const Vec<R, double> change = lambda - solve_local(i, own, u - W * lambda, m, lambda);
      if constexpr (Weights::is_mixed) {
        const Weights own_scale = Weights::of(own);
        Vec<R, double> out = W * change;
        for (int k = 0; k < R; ++k) out[k] = own_scale[k] > 0 ? out[k] * (scale[k] / own_scale[k]) : 0;
        return out;
      } else {
        const double size = trace(W);
        return (size > 0 ? scale.motion * R / size : 0.0) * (W * change);
      }
    }
  }
};

/// Whether a law is a round cone: a normal row and two of friction, with a coefficient.
template <class Law>
constexpr bool is_round_cone() {
  constexpr auto kinds = row_kinds<Law>();
  if constexpr (kinds.size() != 3 || !requires(const typename Law::Item& item) { item.parameters.friction; })
    return false;
  else
    return kinds[0] == RowKind::lower && kinds[1] == RowKind::friction && kinds[2] == RowKind::friction;
}

/// Whether `Coulomb` itself answers, from its memory and with what it makes of cones: who is around it says nothing of that.
template <class Law>
constexpr bool is_answered_by_coulomb() {
  constexpr unsigned answers = refine::prepare | refine::clamp | refine::natural_map | refine::natural_squares | refine::projection_step;
  if constexpr (std::is_same_v<Law, Coulomb>) return true;
  else if constexpr (requires { typename Law::wraps; } && (declared_refinements<Law> & answers) == 0)
    return is_answered_by_coulomb<typename Law::wraps>();
  else return false;
}

// What a visit does is inlined by order: whether compilers do it by themselves depends on what else a program holds, and one
// call a visit costs a fifth of a sweep.
template <class Law, class T>
struct LawLoops {
  using Items = LawItems<Law, T>;
  static constexpr int R = Law::rows;
  static constexpr auto kinds = row_kinds<Law>();
  static constexpr unsigned turns = turning_rows<Law>();
  using Weights = typename Items::Weights;

  static void prepare(const Span<T>& span, double h) {
    const Items of(*span.pool);
    for (Index k = 0; k < span.count; ++k) {
      const Index i = span.items ? span.items[k] : k;
      const Mat<R, R, double> own = load_square<R>(span.pool->own_block(i));
      inner::prepare(of.law, of.item(i), own, h, of.memory[i]);
    }
  }

  static void sweep(const Span<T>& span, Sweep<T>& sums) {
    const PoolView<T>& pool = *span.pool;
    const Items of(pool);
    const bool relaxes = sums.relaxation != T(1), sums_more = sums.x || sums.tells_change;
    double energy = sums.energy;
    for (Index k = 0; k < span.count; ++k) {
      const Index i = span.items[k];
      if constexpr (is_round_cone<Law>())
        if (stays_open(pool, i)) continue;
      const Vec<R, double> lambda = load<R>(pool.lambda + std::ptrdiff_t(R) * i);
      const T* own = block_of(pool, i);
      Vec<R, double> next = of.solve_local(i, own, free_velocity<R>(pool, i), of.memory[i], lambda);
      if (relaxes) {
        next = lambda + double(sums.relaxation) * (next - lambda);
        of.clamp(i, next);
      }
      energy += accept(pool, i, k, lambda, next, own, sums_more, sums);
    }
    sums.energy = energy;
  }

  static void project_once(const Span<T>& span, Sweep<T>& sums) {
    const PoolView<T>& pool = *span.pool;
    const Items of(pool);
    const bool sums_more = sums.x || sums.tells_change;
    for (Index k = 0; k < span.count; ++k) {
      const Index i = span.items[k];
      const Vec<R, double> lambda = load<R>(pool.lambda + std::ptrdiff_t(R) * i);
      const T* own = block_of(pool, i);
      const Weights s = majorant(own);
      const Vec<R, double> next = lambda - over(of.natural_map(i, own, lambda, inner::velocity<R>(pool, i), s), s);
      sums.energy += accept(pool, i, k, lambda, next, own, sums_more, sums);
    }
  }

  /// Of laws that refine the step; the others have none in their table.
  static void descend(const Span<T>& span, Sweep<T>& sums) {
    if constexpr (refines<Law>(refine::projection_step)) {
      const PoolView<T>& pool = *span.pool;
      const Items of(pool);
      const auto& law = who_refines<refine::projection_step>(of.law);
      const double share = double(sums.relaxation);
      for (Index k = 0; k < span.count; ++k) {
        const Index i = span.items[k];
        if constexpr (is_round_cone<Law>())
          if (stays_open(pool, i)) continue;
        const Vec<R, double> lambda = load<R>(pool.lambda + std::ptrdiff_t(R) * i);
        const T* own = block_of(pool, i);
        Vec<R, double> next = law.projection_step(given<Law>(of.item(i)), as_square<R>(own), lambda, inner::velocity<R>(pool, i));
        if (share != 1) next = lambda + share * (next - lambda);
        sums.energy += accept(pool, i, k, lambda, next, own, sums.x || sums.tells_change, sums);
      }
    }
  }

  static void measure(const Span<T>& span, MeasureSums& sums) {
    const PoolView<T>& pool = *span.pool;
    const Items of(pool);
    MeasureSums here = sums;
    for (Index k = 0; k < span.count; ++k) {
      const Index i = span.items[k];
      const T* own = block_of(pool, i);
      add(of, i, own, Weights::of(own), inner::velocity<R>(pool, i), load<R>(pool.lambda + std::ptrdiff_t(R) * i),
          load<R>(pool.d + std::ptrdiff_t(R) * i), here);
    }
    sums = here;
  }

  static void extrapolate(const Span<T>& span, T* before, T beta) {
    const PoolView<T>& pool = *span.pool;
    const Items of(pool);
    for (Index k = 0; k < span.count; ++k, before += R) {
      const Index i = span.items[k];
      T* const at = pool.lambda + std::ptrdiff_t(R) * i;
      const Vec<R, double> here = load<R>(at), last = load<R>(before);
      if (here == last) continue;  // an open contact, most of all
      Vec<R, double> next = here + double(beta) * (here - last);
      store(here, before);
      of.clamp(i, next);
      store(next, at);
      impulse_changed<R>(pool, i, Vec<R, double>(next - here));
    }
  }

  static void clamp(const PoolView<T>& pool, Index i, T* lambda) {
    Vec<R, double> x = load<R>(lambda);
    Items(pool).clamp(i, x);
    store(x, lambda);
  }
  static void changed(const PoolView<T>& pool, Index i, const T* change) {
    impulse_changed<R>(pool, i, load<R>(change));
  }
  static void velocity(const PoolView<T>& pool, Index i, T* u) { store(inner::velocity<R>(pool, i), u); }
  static void add_share(const PoolView<T>& pool, Index i, const T* u, const T* lambda, MeasureSums& sums) {
    const Weights w = Weights::of(block_of(pool, i));
    auto own = zero<Mat<R, R, double>>();
    for (int k = 0; k < R; ++k) own(k, k) = w[k];
    add(Items(pool), i, own.data(), w, load<R>(u), load<R>(lambda), load<R>(pool.d + std::ptrdiff_t(R) * i), sums);
  }
  static double friction(const PoolView<T>& pool, Index i) {
    if constexpr (is_round_cone<Law>()) return double(Items(pool).item(i).parameters.friction);
    else return 0;
  }

  static constexpr LawTable<T> make_table() {
    LawTable<T> out{kinds.data(), prepare, sweep, project_once, measure, extrapolate, nullptr, changed, velocity, add_share, nullptr, is_answered_by_coulomb<Law>(), nullptr};
    if constexpr (refines<Law>(refine::clamp)) out.clamp = clamp;
    if constexpr (is_round_cone<Law>()) out.friction = friction;
    if constexpr (refines<Law>(refine::projection_step)) out.descend = descend;
    return out;
  }
  static const LawTable<T> table;

 private:
  [[gnu::always_inline]] static const T* block_of(const PoolView<T>& pool, Index i) { return pool.diagonal + std::ptrdiff_t(R * R) * i; }
  /// s ≥ λ_max(W_ii) in rows in m/s, s/ℓ² in those in rad/s, which weigh as much at the length ℓ.
  [[gnu::always_inline]] static Weights majorant(const T* own) {
    Mat<R, R, double> W = load_square<R>(own);
    if constexpr (Weights::is_mixed) {
      const Weights w = Weights::of(own);
      const double square = w.motion > 0 && w.turn > 0 ? w.motion / w.turn : 1, length = std::sqrt(square);
      for (int i = 0; i < R; ++i)
        for (int j = 0; j < R; ++j) W(i, j) *= (Weights::is_turn(i) ? length : 1) * (Weights::is_turn(j) ? length : 1);
      const double s = norm(W);
      return {s, s / square};
    } else {
      const double s = norm(W);
      return {s, s};
    }
  }

  /// Without impulse, and it goes on opening, of which its normal row tells.
  [[gnu::always_inline]] static bool stays_open(const PoolView<T>& pool, Index i) {
    const T* lambda = pool.lambda + std::ptrdiff_t(R) * i;
    if (lambda[0] != 0) return false;
    for (int k = 1; k < R; ++k)
      if (lambda[k] != 0) return false;
    return pool.is_matrix() && free_normal_velocity(pool, i) >= 0;
  }

  /// λ_i ← next, the k-th of its span. Returns w |Δλ|².
  [[gnu::always_inline]] static double accept(const PoolView<T>& pool, Index i, Index k, const Vec<R, double>& lambda, const Vec<R, double>& next,
                                              const T* own, bool sums_more, Sweep<T>& sums) {
    const Vec<R, double> change = next - lambda;
    store(next, pool.lambda + std::ptrdiff_t(R) * i);
    impulse_changed<R>(pool, i, change);
    const Weights weight = Weights::of(own);
    if (sums_more) {
      if (sums.x) sums.along += weighed(weight, change, Vec<R, double>(next - load<R>(sums.x + std::ptrdiff_t(R) * k)));
      if (sums.tells_change) {
        const double share = motion(weight, change, sums.length);
        sums.displacement += share;
        sums.most = std::max(sums.most, share);
      }
    }
    return weighed(weight, change, change);
  }

  [[gnu::always_inline]] static Vec<R, double> over(const Vec<R, double>& x, const Weights& s) {
    if constexpr (!Weights::is_mixed) return x / s.motion;
    Vec<R, double> out;
    for (int k = 0; k < R; ++k) out[k] = x[k] / s[k];
    return out;
  }
  /// |w x|, m/s.
  [[gnu::always_inline]] static double motion(const Weights& w, const Vec<R, double>& x, double length) {
    if constexpr (turns == 0) return w.motion * std::sqrt(squared_norm(x));
    Vec<R, double> out;
    for (int k = 0; k < R; ++k) out[k] = w[k] * x[k];
    return std::sqrt(square_of<turns>(out, length));
  }

  /// A contact that sticks has μ |u_t| in its map, and so μ times the rounding of u_t.
  [[gnu::always_inline]] static double amplification(double friction) { return friction > 1 ? friction * friction : 1; }

  /// Σ u_k² over the rows that go on into what they bound, of a law that says its `kinds`.
  [[gnu::always_inline]] static double square_of_closing(const Vec<R, double>& u, double length) {
    double sum = 0;
    if constexpr (requires { Law::kinds; }) {
      for (int k = 0; k < R; ++k) {
        if (kinds[k] != RowKind::lower && kinds[k] != RowKind::upper) continue;
        const double scale = Weights::is_turn(k) ? length : 1, x = scale * (kinds[k] == RowKind::lower ? std::min(u[k], 0.0) : std::max(u[k], 0.0));
        sum += x * x;
      }
    }
    return sum;
  }

  /// |F_i(w)|² and |F_i(1)|² of `Measure`, at once where the law knows them so, and what else it sums.
  template <class Own>
  [[gnu::always_inline]] static void add(const Items& of, Index i, const Own* own, const Weights& weight, const Vec<R, double>& u, const Vec<R, double>& lambda,
                                         const Vec<R, double>& d, MeasureSums& sums) {
    Vec<2, DoubleIn<T>> squares;
    if constexpr (refines<Law>(refine::natural_squares) && turns == 0) {
      squares = who_refines<refine::natural_squares>(of.law).natural_squares(given<Law>(of.item(i)), lambda, u, weight.motion);
    } else {
      squares[0] = square_of<turns>(of.natural_map(i, own, lambda, u, weight), sums.length);
      squares[1] = square_of<turns>(of.natural_map(i, own, lambda, u, Weights{}), sums.length);
    }
    const double closing = square_of_closing(u, sums.length), square = std::max(double(squares[0]), closing);
    sums.residual += square;
    sums.worst = std::max(sums.worst, square);
    sums.siconos += double(squares[1]);
    sums.closing += closing;
    sums.d += square_of<turns>(d, sums.length);
    sums.u += square_of<turns>(u, sums.length);
    sums.lambda += square_of<turns>(lambda, 1 / sums.length);
    double reach = 0;
    if constexpr (turns == 0) reach = weight.motion * weight.motion * squared_norm(lambda);
    else reach = motion(weight, lambda, sums.length), reach *= reach;
    if constexpr (is_round_cone<Law>()) reach *= amplification(of.item(i).parameters.friction);
    sums.reach = std::max(sums.reach, reach);
  }
};

// Tables stand outside of their classes, and large functions too: what is inside of one is inline, and a compiler makes its body
// in every file, also in one that leaves it to `delassus::compiled`.
template <class Law, class T>
constinit const LawTable<T> LawLoops<Law, T>::table = make_table();

/// The table of a law: a function, which a program can compile once without reading the class of each law in each of its files.
template <class Law, class T>
const LawTable<T>* law_table() {
  return &LawLoops<Law, T>::table;
}

/// What Newton's method asks of a law: apart from the loops, since naming a table compiles all of it.
template <class Law, class T>
void law_tangent(const PoolView<T>& pool, Index i, const double* w, const double* d, double* lambda, double* slope) {
  [[maybe_unused]] constexpr int R = Law::rows;
  if constexpr (refines<Law>(refine::tangent)) {
    const LawItems<Law, T> of(pool);
    Local<R> c{zero<Mat<R, R>>(), load<R>(d), load<R>(lambda)};
    for (int k = 0; k < R; ++k) c.W(k, k) = w[k];
    Mat<R, R> S;
    const auto& asked = who_refines<refine::tangent>(of.law);
    if constexpr (requires { asked.tangent(given<Law>(of.item(i)), c); }) S = asked.tangent(given<Law>(of.item(i)), c);
    else S = asked.tangent(given<Law>(of.item(i)), c, of.memory[i]);
    for (int k = 0; k < R * R; ++k) slope[k] = S.data()[k];
    store(c.lambda, lambda);
  }
}
template <class Law, class T>
void convex_law_tangent(const PoolView<T>& pool, Index i, const double* w, const double* d, double slip, double* lambda,
                        double* slope) {
  [[maybe_unused]] constexpr int R = Law::rows;
  const LawItems<Law, T> of(pool);
  Local<R> c{zero<Mat<R, R>>(), load<R>(d), load<R>(lambda)};
  for (int k = 0; k < R; ++k) c.W(k, k) = w[k];
  if constexpr (refines<Law>(refine::convex_tangent)) {
    const Mat<R, R> S = who_refines<refine::convex_tangent>(of.law).convex_tangent(given<Law>(of.item(i)), c, slip);
    for (int k = 0; k < R * R; ++k) slope[k] = S.data()[k];
    store(c.lambda, lambda);
  } else {
    law_tangent<Law>(pool, i, w, d, lambda, slope);
  }
}

}  // namespace delassus::inner
