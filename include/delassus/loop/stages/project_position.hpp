/// Position projection: after the velocities are final, violations are closed by displacements alone.
#pragma once

#include <delassus/constraints/constraints.hpp>
#include <delassus/loop/stages/bias.hpp>
#include <delassus/loop/stages/correct.hpp>
#include <delassus/loop/stages/solve.hpp>

namespace delassus {

/// The laws of the position problem: equalities stay equalities, bounds stay bounds, friction rows are locked at zero.
/// One projected Gauss-Seidel pass over the rows of each block.
template <class Constraints, class T>
class PositionBook;
template <class... Laws, class T>
class PositionBook<Constraints<Laws...>, T> {
 public:
  template <int p, int R>
  void project(Index, Local<R, T>& c) const {
    for (int k = 0; k < R; ++k) {
      const T before = c.lambda[k];
      c.lambda[k] = bound<p>(k, before - c.d[k] / c.W(k, k));
      c.d += c.W.col(k) * (c.lambda[k] - before);
    }
  }
  template <int p, int R>
  Vec<R, T> natural_map(Index, const Local<R, T>& c, T scale) const {
    Vec<R, T> out;
    for (int k = 0; k < R; ++k) out[k] = scale * c.lambda[k] - bound<p>(k, scale * c.lambda[k] - c.d[k]);
    return out;
  }
  template <int p>
  static constexpr auto kinds() {
    return row_kinds<std::tuple_element_t<p, std::tuple<Laws...>>>();
  }
  /// No law is a round cone here, and each bounds what it is given.
  template <int p>
  static constexpr bool has_cone() {
    return false;
  }
  template <int p>
  static constexpr T friction(Index) {
    return 0;
  }
  template <int p>
  static constexpr bool clamps() {
    return true;
  }
  /// Row by row: the slope of a bound is 1/W_kk where it lets through, 0 where it holds.
  template <int p, int R, class N>
  Mat<R, R, N> tangent(Index, Local<R, N>& c) const {
    Mat<R, R, N> slope = Mat<R, R, N>::Zero();
    for (int k = 0; k < R; ++k) {
      const N free = c.lambda[k] - c.d[k] / c.W(k, k);
      c.lambda[k] = bound<p>(k, free);
      if (c.lambda[k] == free) slope(k, k) = N(1) / c.W(k, k);
    }
    return slope;
  }
  template <int p, int R>
  void clamp(Index, Vec<R, T>& lambda) const {
    for (int k = 0; k < R; ++k) lambda[k] = bound<p>(k, lambda[k]);
  }

 private:
  template <int p, class N>
  static N bound(int k, N x) {
    switch (kinds<p>()[k]) {
      case RowKind::equality: return x;
      case RowKind::lower: return std::max(N(0), x);
      case RowKind::upper: return std::min(N(0), x);
      case RowKind::friction: return N(0);
    }
    return x;
  }
};

/// d of the position problem: u⁺ + push(φ), close(φ) of a joint: the velocity the row has plus the rate its violation asks
/// for; an open contact only must not close. Where `at_end` has rows, the bodies are at the end of the step: equalities have
/// close(φ) of there alone. λ starts at zero.
template <class World, class Laws, class Rows, class S, class AtEnd>
void make_position_bias(const World& world, const Laws& laws, Rows& rows, const S& stabilisation, double h,
                        const AtEnd& at_end) {
  using T = typename Rows::Scalar;
  for_each_index<Laws::pool_count>([&](auto p) {
    using Law = std::remove_cvref_t<decltype(laws.template pool<p>().law)>;
    constexpr auto kinds = row_kinds<Law>();
    auto& pool = rows.template pool<p>();
    for (Index i = 0; i < pool.items(); ++i) {
      const auto u = inner::rate(pool, i, world, [](const auto& set) -> const auto& { return set.v_next; });
      pool.lambda[i].setZero();
      pool.d[i].setZero();
      for (int k = 0; k < Law::rows; ++k) {
        const double phi = double(pool.phi[i][k]), sign = kinds[k] == RowKind::upper ? -1 : 1;
        const bool is_soft = pool.stiffness[i][k] > 0 || pool.damping[i][k] > 0;
        if (kinds[k] == RowKind::equality) {
          double asked = stabilisation.close(phi, h) + double(u[k]);
          if constexpr (requires { at_end.pools; })
            asked = stabilisation.close(double(at_end.template pool<p>().phi[i][k]), h);
          pool.d[i][k] = is_soft ? T(0) : T(asked);
        } else if (kinds[k] != RowKind::friction && !is_soft)  // a spring is meant to give way
          pool.d[i][k] = T(sign * (sign * phi < 0 ? stabilisation.push(sign * phi, h) : sign * phi / h) + double(u[k]));
      }
    }
  });
}

/// What of w an island takes. Joints of the midpoint rule are closed by H, the rows of the middle, which need
/// not see what a gap at the end asks for: H w = −φ₊/h of a chain drawn straight is as long as H is blind. E,
/// the rows of the end, say what w does there. An island whose gaps would grow by them takes of w what closes
/// most,
///
///   s = argmin Σ (φ₊ + s h E w)²/W_kk = −Σ φ₊ (h E w)/W_kk / Σ (h E w)²/W_kk ≥ 0,   s < ½ where they grow.
///
/// An island with a contact or a limit takes all of w, which pushes those back as well.
template <class Laws, class Work, class S>
double share_that_closes(const Laws& laws, const Work& work, const S& stabilisation, Index island, double h) {
  double closed = 0, square = 0;
  bool are_joints = true;
  inner::each_item(work.islands, island, [&](auto p, Index i) {
    using Law = std::remove_cvref_t<decltype(laws.template pool<p>().law)>;
    constexpr auto kinds = row_kinds<Law>();
    are_joints &= inner::are_equalities(kinds);
    const auto& at_end = work.at_start.template pool<p>();
    const auto u = inner::rate(at_end, i, work.displacement);
    for (int k = 0; k < Law::rows; ++k) {
      const double W = double(work.W.template diagonal<p>(i)(k, k));
      const bool is_soft = at_end.stiffness[i][k] > 0 || at_end.damping[i][k] > 0;
      if (kinds[k] != RowKind::equality || is_soft || !(W > 0)) continue;
      closed -= stabilisation.close(double(at_end.phi[i][k]), h) * double(u[k]) / W;
      square += double(u[k]) * double(u[k]) / W;
    }
  });
  return are_joints && closed < 0.5 * square ? std::max(0.0, closed / square) : 1;
}

/// w of every island becomes the share of it that closes its joints.
template <class World, class Laws, class Work, class S>
void bound_displacements(const World& world, const Laws& laws, Work& work, const S& stabilisation, double h) {
  for (Index k = 0; k < work.islands.count(); ++k) {
    const double share = share_that_closes(laws, work, stabilisation, k, h);
    if (share == 1) continue;
    Index first = 0;
    world.each([&](const auto& set, auto s) {
      for (const Index b : set.active())
        if (work.islands.island_of(first + b) == k)
          std::get<s>(work.displacement)[b] *= typename World::Scalar(share);
      first += set.blocks();
    });
  }
}

/// w = A⁻¹ Hᵀ μ of the position problem, into `work.displacement`; returns how its solve ended where that
/// was far from closing the gaps (they are what is left of the last step's, and small): the worst island's. λ and d of the step are put back.
template <class World, class Laws, class Work, class S, class Solver, class Scratch>
Status find_displacements(World& world, const Laws& laws, Work& work, const S& stabilisation, const Solver& solver,
                        Scratch& scratch, double h) {
  for (auto& aside : work.aside) aside.resize_like(work.rows);
  for_each_index<Laws::pool_count>([&](auto p) {
    std::get<p>(work.aside[0].pools) = work.rows.template pool<p>().lambda;
    std::get<p>(work.aside[1].pools) = work.rows.template pool<p>().d;
  });
  make_position_bias(world, laws, work.rows, stabilisation, h, work.at_start);
  work.W.reset(work.rows);
  PositionBook<Laws, typename World::Scalar> book;
  NoObserver nobody;
  Status worst = Status::converged;
  constexpr double far = 0.05;  // of the largest velocity that closes a gap
  for (Index k = 0; k < work.islands.count(); ++k)
    if (!work.is_sick[k]) {
      const SolveReport r = solve_island(book, work.rows, work.W, work.islands, k, solver, work.solver, h, nobody);
      if (r.measure.residual > far) worst = worse(worst, r.status);
    }
  world.each([&](auto& set, auto s) {
    auto& to = std::get<s>(work.displacement);
    to.resize(set.blocks());
    for (auto& x : to) x.setZero();
    add_impulses<s>(inner::inverse_of<s>(work.W, set, 1), work.rows, to, std::get<s>(scratch));
  });
  if constexpr (requires { work.at_start.pools; }) bound_displacements(world, laws, work, stabilisation, h);
  for_each_index<Laws::pool_count>([&](auto p) {
    std::swap(std::get<p>(work.aside[0].pools), work.rows.template pool<p>().lambda);
    std::swap(std::get<p>(work.aside[1].pools), work.rows.template pool<p>().d);
  });
  return worst;
}

/// q ← q ⊕ h w.
template <class World, class Displacement>
void displace(World& world, const Displacement& displacement, double h) {
  world.each([&](auto& set, auto s) {
    for (const Index b : set.active())
      if (set.moves(b)) set.displace(b, typename World::Scalar(h) * std::get<s>(displacement)[b]);
  });
}

}  // namespace delassus
