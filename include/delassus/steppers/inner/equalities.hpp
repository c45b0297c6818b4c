/// The equalities of a whole world by one factorization, and soft rows as forces: for schemes that step by
/// themselves.
#pragma once

#include <delassus/compliance/compliance.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/rows/impulses.hpp>
#include <delassus/rows/rate.hpp>
#include <delassus/rows/soft.hpp>
#include <delassus/steppers/inner/direct_rows.hpp>
#include <delassus/step/bias.hpp>
#include <delassus/step/linearize.hpp>

#include <algorithm>
#include <tuple>
#include <type_traits>

namespace delassus {
namespace inner {

/// The paths of the bodies of a set, see `RigidPath`.
template <class Set>
using PathOf = typename Set::Path;

/// G of the ends of `rows` ← answer(set, s, block, Hᵀ), H of the same ends in `from`; zero where nothing moves.
template <class World, class Rows, class Answer>
void answer_ends(const World& world, Rows& rows, const Rows& from, const Answer& answer) {
  world.each([&](const auto& set, auto s) {
    each_pool(rows, [&](auto p, auto& pool) {
      auto& ends = inner::part<s>(pool.sets);
      const auto& H = inner::part<s>(from.template pool<p>().sets).H;
      ends.G.resize(H.size());
      for (std::size_t e = 0; e < H.size(); ++e) {
        const Mat<World::template width_of<s>, Rows::template rows_of<p>, typename Rows::Scalar> X = H[e].transpose();
        if (set.moves(ends.block[e]))
          ends.G[e] = answer(set, s, ends.block[e], X);
        else
          ends.G[e].setZero();
      }
    });
  });
}

/// v_next of set s of a world.
template <class World>
auto next_of(World& world) {
  return [&world](auto s) -> auto& { return world.template set<s>().v_next; };
}

}  // namespace inner

/// Solves H G δ = −r for all rows that are not soft, G = M⁻¹ Hᵀ or another answer of the bodies. Rows that
/// depend on each other share their load (ε = 1e-12 of W_kk). Without rows it is empty.
template <class Rows>
class Equalities {
 public:
  using T = typename Rows::Scalar;
  static constexpr bool has_rows = Rows::pool_count > 0;

  template <class Pool>
  static bool is_soft(const Pool& pool, Index i, int k) {
    return inner::is_spring(pool.stiffness[i][k], pool.damping[i][k]);
  }

  /// The largest |φ| of the rows that are not soft, m or rad; NaN where one is none.
  static double worst(const Rows& rows) {
    double most = 0, spoilt = 0;
    each_row(rows, [&](const auto& pool, Index i, int k) {
      const double size = std::abs(double(pool.phi[i][k]));
      if (!is_soft(pool, i, k)) most = std::max(most, size), spoilt += 0 * size;
    });
    return most + spoilt;
  }

  /// λ ← −t (k φ + c H v) in the soft rows of `lambda`, zero in the others.
  template <class World>
  static void pull(const World& world, const Rows& rows, Impulses<Rows>& lambda, double t) {
    lambda.resize_like(rows);
    each_pool(rows, [&](auto p, const auto& pool) {
      for (Index i = 0; i < pool.items(); ++i) {
        auto& out = inner::part<p>(lambda.pools)[i];
        out.setZero();
        bool any = false;
        for (int k = 0; k < pool.rows; ++k) any = any || is_soft(pool, i, k);
        if (!any) continue;
        const auto u = inner::rate(
            pool, i, world, [](const auto& set) -> const auto& { return set.velocity(); });
        for (int k = 0; k < pool.rows; ++k)
          out[k] = T(-t) * (pool.stiffness[i][k] * pool.phi[i][k] + pool.damping[i][k] * u[k]);
      }
    });
  }

  /// Takes H and G of `rows`; false when the matrix is singular or no number.
  bool factor(Rows& rows) {
    if constexpr (has_rows) {
      // A soft row has its impulse already: it yields to any other.
      each_row(rows, [](auto& pool, Index i, int k) {
        if (is_soft(pool, i, k)) pool.compliance[i][k] = T(1e30);
      });
      system_.take_all(rows);
      system_.analyse(0);
      return system_.factor(1e-12);
    } else {
      return true;
    }
  }

  /// δ for r(p, i); f(p, i, δ) gets it, zero in soft rows.
  template <class R, class F>
  void solve(const Rows& rows, const R& r, F&& f) {
    if constexpr (has_rows) {
      system_.load([&](auto p, Index i) {
        auto out = r(p, i);
        for (int k = 0; k < out.size(); ++k)
          if (is_soft(rows.template pool<p>(), i, k)) out[k] = T(0);
        return out;
      });
      system_.solve();
      system_.each([&](auto p, Index k) {
        const Index i = system_.node(k).item;
        Vec<Rows::template rows_of<p>, T> change;
        for (int j = 0; j < change.size(); ++j)
          change[j] = is_soft(rows.template pool<p>(), i, j) ? T(0) : T(system_.answer(k)[j]);
        f(p, i, change);
      });
    }
  }

  /// to_b += G_b λ_i for every block b of item i of pool p, `to` by set.
  template <int p, class Lambda, class To>
  static void push(const Rows& rows, Index i, const Lambda& lambda, To&& to) {
    for_each_index<Rows::set_count>([&](auto s) {
      const auto& blocks = inner::part<s>(rows.template pool<p>().sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        to(s)[blocks.block[e]].noalias() += blocks.G[e] * lambda;
    });
  }
  template <class To>
  static void push_all(const Rows& rows, const Impulses<Rows>& lambda, To&& to) {
    each_pool(rows, [&](auto p, const auto& pool) {
      for (Index i = 0; i < pool.items(); ++i) push<p>(rows, i, inner::part<p>(lambda.pools)[i], to);
    });
  }

 private:
  template <class R, class F>
  static void each_row(R& rows, F&& f) {
    each_pool(rows, [&](auto, auto& pool) {
      for (Index i = 0; i < pool.items(); ++i)
        for (int k = 0; k < pool.rows; ++k) f(pool, i, k);
    });
  }

  [[no_unique_address]] std::conditional_t<has_rows, inner::DirectRows<Rows>, std::tuple<>> system_;
};

}  // namespace delassus
