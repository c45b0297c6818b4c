/// One island by its rows alone, for whichever bodies: all of W in the place of their masses.
#pragma once

#include <delassus/math/linear.hpp>
#include <delassus/solvers/inner/newton_system.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// A `NewtonSystem` of any island. Where A couples blocks, each constraint has a block of its own instead, with the
/// change of what it sees, u. There H = 1, and G has a column of W, all that answers to an impulse:
///
///   J = 1 + W S.
///
/// That is dense: n² blocks, and n³ products of them in each factorization.
template <class T, int width_>
class WholeSystem : public NewtonSystem<T, width_> {
  using Base = NewtonSystem<T, width_>;

 public:
  using typename Base::Constraint, typename Base::Velocities;
  using Base::width;
  static constexpr Index most = 400;  ///< constraints

 protected:
  using Base::constraints_, Base::pairs_, Base::sides_;

 public:

  /// False where Newton's method cannot act, or where blocks are coupled and there are more constraints than `most`
  /// or one with more rows than a block.
  bool gather(Island<T>& island) {
    return Base::gather(island) || gather_rows(island);
  }

 private:
  bool gather_rows(Island<T>& island) {
    Index count = 0;
    bool fits = Base::has_tangents(island);
    for (const Span<T>& span : island) {
      count += span.count;
      fits = fits && span.pool->rows <= width;
    }
    if (!fits || count > most) return false;
    this->begin(island, std::size_t(count));
    Velocities before(std::size_t(count), zero<Vec<width>>());
    each_velocity(island, [&](Index j, int k, double u) { before[std::size_t(j)][k] = u; });
    bool is_sound = true;
    for (const Span<T>& span : island)
      for (const Index i : span) is_sound &= take(island, span, i, before);
    return is_sound && this->finish(island.island());
  }

  /// f(j, k, u_k) for row k of the j-th constraint of the island.
  static void each_velocity(const Island<T>& island, auto&& f) {
    Index j = 0;
    T u[most_rows];
    for (const Span<T>& span : island)
      for (const Index i : span) {
        island.velocity(span, i, u);
        for (int k = 0; k < span.pool->rows; ++k) f(j, k, double(u[k]));
        ++j;
      }
  }

  /// W e_k = w (u(λ + e_k/w) − u(λ)).
  bool take(Island<T>& island, const Span<T>& span, Index i, const Velocities& before) {
    const Index block = Index(constraints_.size()), count = Index(before.size());
    const Constraint c = this->add(span, i);
    const int R = c.rows;
    for (Index j = 0; j < count; ++j) this->add_side(R, j);
    for (Index j = 0; j < count; ++j)
      for (int k = 0; k < R * width; ++k) this->H(c.first + j)[k] = this->G(c.first + j)[k] = 0;
    for (int k = 0; k < R; ++k) this->H(c.first + block)[k + R * k] = 1;
    T present[most_rows], pushed[most_rows];
    for (int k = 0; k < R; ++k) present[k] = pushed[k] = island.impulse(span, i)[k];
    for (int k = 0; k < R; ++k) {
      pushed[k] = present[k] + T(1 / this->weight[c.at + k]);
      island.assign(span, i, pushed);
      pushed[k] = present[k];
      each_velocity(island, [&](Index j, int l, double u) {
        this->G(c.first + j)[l + width * k] = this->weight[c.at + k] * (u - before[std::size_t(j)][l]);
      });
      island.assign(span, i, present);
    }
    for (Index j = 0; j < count; ++j) {
      if (j != block) pairs_.push_back(std::minmax(j, block));
      this->add_to_balance(c.first + j, c);
    }
    return this->is_sound(c);
  }
};

}  // namespace delassus::inner
