/// One island by its rows alone, for whichever bodies: all of W in the place of their masses.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/solvers/inner/newton_system.hpp>

#include <algorithm>
#include <cstddef>
#include <tuple>

namespace delassus::inner {

/// A `NewtonSystem` of any island. Where A couples blocks, each constraint has a block of its own instead, with the
/// change of what it sees, u. There H = 1, and G has a column of W, all that answers to an impulse:
///
///   J = 1 + W S.
///
/// That is dense: n² blocks, and n³ products of them in each factorization.
template <template <int> class Item, class Rows>
class WholeSystem : public NewtonSystem<Item, Rows> {
  using Base = NewtonSystem<Item, Rows>;
  using T = typename Rows::Scalar;
  using Base::items_, Base::pairs_, Base::sides_;

 public:
  using typename Base::Velocities;
  using Base::width;
  static constexpr Index most = 400;  ///< constraints

  /// False where Newton's method cannot act, or where blocks are coupled and there are more constraints than `most`
  /// or one with more rows than a block.
  bool gather(auto& problem) {
    return Base::gather(problem) || gather_rows(problem);
  }

 private:
  bool gather_rows(auto& problem) {
    Index count = 0;
    bool fits = Base::has_tangents(problem);
    problem.each([&](auto p, Index) {
      ++count;
      fits = fits && Rows::template rows_of<p> <= width;
    });
    if (!fits || count > most) return false;
    this->begin(std::size_t(count));
    Velocities before(std::size_t(count), Velocities::value_type::Zero());
    each_velocity(problem, [&](Index j, int k, double u) { before[std::size_t(j)][k] = u; });
    bool is_sound = true;
    Index block = 0;
    problem.each([&](auto p, Index i) { is_sound &= take<p>(problem, i, block++, before); });
    return is_sound && this->finish(problem.island());
  }

  /// f(j, k, u_k) for row k of the j-th constraint of the island.
  static void each_velocity(const auto& problem, auto&& f) {
    Index j = 0;
    problem.each([&](auto p, Index i) {
      const auto u = problem.template local<p>(i).d;
      for (int k = 0; k < int(u.size()); ++k) f(j, k, double(u[k]));
      ++j;
    });
  }

  /// W e_k = w (u(λ + e_k/w) − u(λ)).
  template <int p, class Problem>
  bool take(Problem& problem, Index i, Index block, const Velocities& before) {
    constexpr int r = Rows::template rows_of<p>;
    if constexpr (r <= width) {
      auto& sides = std::get<p>(sides_);
      const Index count = Index(before.size()), first = Index(sides.size());
      Item<r> c = Base::item_of(problem.template local<p>(i), i, first);
      sides.resize(std::size_t(first + count), {0, Mat<r, width>::Zero(), Mat<width, r>::Zero()});
      sides[first + block].H.template leftCols<r>().setIdentity();
      const Vec<r, T> lambda = problem.rows().template pool<p>().lambda[i];
      for (int k = 0; k < r; ++k) {
        Vec<r, T> pushed = lambda;
        pushed[k] += T(1 / c.weight);
        problem.template assign<p>(i, pushed);
        each_velocity(problem, [&](Index j, int l, double u) {
          sides[first + j].G(l, k) = c.weight * (u - before[std::size_t(j)][l]);
        });
        problem.template assign<p>(i, lambda);
      }
      for (Index j = 0; j < count; ++j) {
        sides[first + j].block = j;
        if (j != block) pairs_.push_back(std::minmax(j, block));
        this->add_to_balance(sides[first + j], 1 / c.weight);
      }
      return Base::add(c, std::get<p>(items_), first + count);
    } else {
      return false;
    }
  }
};

}  // namespace delassus::inner
