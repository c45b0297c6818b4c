/// How two ends of a step in contact differ along what contacts and joints let go: the motion, not the noise
/// of what they hold.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/law.hpp>
#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/rows/row_arrays.hpp>
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/schemes/inner/end_state.hpp>

#include <cstddef>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// The midpoint rule holds contacts for the mean of v and v₊. What v has across them goes to and fro, of
/// order h² and another for every size of a step, and moves nothing; a gap is closed by the next step. So
/// differences x of places and velocities are taken without them,
///
///   x ← x − M⁻¹ Hᵀ (H M⁻¹ Hᵀ)⁻¹ H x,
///
/// by conjugate gradients, H the rows of the last half that push and hold, and of velocities those that
/// stick.
template <class World>
class ArcDifference {
  using T = typename World::Scalar;
  using Differences = typename World::template PerSet<VelocitiesOf>;
  static constexpr int most_iterations = 100;
  static constexpr T least_left = T(1e-8);  ///< of |H x|², where the last iteration ends

 public:
  /// Before Advance: whether rows are known block by block, and touch no body that is led. Its velocity is
  /// the mean of a step, by which that of what sticks to it differs for good.
  void look(auto& step) {
    is_known_ = true;
    const AllRows<T> pools = step.arrays.all();
    step.world().each([&](const auto& set, auto s) {
      for (const RowArrays<T>& pool : pools) {
        const SetArrays<T>& ends = pool.set[int(s)];
        is_known_ = is_known_ && ends.G->size() == ends.H->size();
        for (const Index b : *ends.block) is_known_ = is_known_ && (set.moves(b) || is_zero(set.velocity()[b]));
      }
    });
  }
  bool is_known() const { return is_known_; }
  /// Of where the bodies are now from `whole`; false where the last step was not one of those.
  bool take(auto& step, const EndState<World>& whole) {
    if (!is_known_) return false;
    whole.difference(step.world(), places_, velocities_);
    find_sliding(step);
    drop<false>(step, places_);
    drop<true>(step, velocities_);
    return true;
  }
  /// As `EndState::error`.
  template <class Lengths>
  EndError error(const World& world, const Lengths& lengths, double tau) const {
    EndError most;
    world.each([&](const auto& set, auto s) {
      for (const Index b : set.active()) {
        if (!set.moves(b)) continue;
        const double L = lengths.of(Index(s), b), place = size(std::get<s>(places_)[b], L),
                     velocity = size(std::get<s>(velocities_)[b], L);
        double sum = place + tau * velocity;
        if (!std::isfinite(sum)) sum = std::numeric_limits<double>::infinity();
        if (sum > most.sum || most.set < 0) most = {place, velocity, sum, Index(s), b};
      }
    });
    return most;
  }

 private:
  template <class Velocity>
  static double size(const Velocity& x, double L) {
    double sum = norm(converted<double>(linear_part(x))) / L;
    if constexpr (int(Velocity::RowsAtCompileTime) == 6) sum += norm(converted<double>(angular_part(x)));
    return sum;
  }
  /// `of_rates`: without what sticks too; a place that slipped on the way to sticking is one that differs.
  template <bool of_rates>
  void drop(auto& step, Differences& x) {
    residual_.clear();
    each_held_row<of_rates>(
        step, [&](const RowArrays<T>& pool, Index i, int k) { residual_.push_back(rate(pool, i, k, x)); });
    direction_.resize(residual_.size()), image_.resize(residual_.size());
    for (std::size_t n = 0; n < residual_.size(); ++n) direction_[n] = residual_[n];
    T size = dot_of(residual_, residual_);
    const T enough = least_left * size;
    for (int iteration = 0; iteration < most_iterations && size > enough; ++iteration) {
      step.world().each([&](const auto& set, auto s) {
        auto& y = std::get<s>(way_);
        y.resize(std::size_t(set.blocks()));
        for (auto& v : y) set_zero(v);
      });
      std::size_t n = 0;
      each_held_row<of_rates>(
          step, [&](const RowArrays<T>& pool, Index i, int k) { push(pool, i, k, direction_[n++], way_); });
      n = 0;
      each_held_row<of_rates>(
          step, [&](const RowArrays<T>& pool, Index i, int k) { image_[n++] = rate(pool, i, k, way_); });
      const T effort = dot_of(direction_, image_);
      if (!(effort > T(0))) return;
      const T share = size / effort;
      for_each_index<int(World::set_count)>([&](auto s) {
        for (std::size_t b = 0; b < std::get<s>(x).size(); ++b)
          std::get<s>(x)[b] -= share * std::get<s>(way_)[b];
      });
      for (n = 0; n < residual_.size(); ++n) residual_[n] -= share * image_[n];
      const T before = std::exchange(size, dot_of(residual_, residual_));
      for (n = 0; n < residual_.size(); ++n) direction_[n] = residual_[n] + size / before * direction_[n];
    }
  }
  /// Which contacts slide.
  void find_sliding(auto& step) {
    slides_.clear(), first_contact_.clear();
    each_pool(step.rows, [&](auto p, const auto& pool) {
      const auto& items = step.laws().template pool<p>();
      if constexpr (ContactLaw<std::remove_cvref_t<decltype(items.law)>>) {
        first_contact_.push_back(Index(slides_.size()));
        for (Index i = 0; i < pool.items(); ++i) slides_.push_back(step.contact_cache.results[items.item(i).result].is_sliding);
      } else {
        first_contact_.push_back(-1);
      }
    });
  }
  /// f(pool, item, row).
  template <bool of_rates>
  void each_held_row(auto& step, auto&& f) const {
    const AllRows<T> pools = step.arrays.all();
    for (std::size_t p = 0; p < pools.size(); ++p) {
      const RowArrays<T>& pool = pools[p];
      const RowKind* const kinds = step.pools.all()[p].law->kinds;
      const Index first = first_contact_[p];
      for (Index i = 0; i < pool.items(); ++i) {
        const bool sticks = of_rates && (first < 0 || !slides_[first + i]);
        for (int k = 0; k < pool.rows; ++k) {
          const std::size_t row = std::size_t(i) * std::size_t(pool.rows) + std::size_t(k);
          const bool pushes = kinds[k] == RowKind::equality || ((*pool.lambda)[row] != T(0) && (sticks || kinds[k] != RowKind::friction));
          if (pushes && !pool.is_soft(row)) f(pool, i, k);  // a spring's motion is the body's own
        }
      }
    }
  }
  /// Row k of H x.
  static T rate(const RowArrays<T>& pool, Index i, int k, const Differences& x) {
    T sum = 0;
    for_each_index<int(World::set_count)>([&](auto s) {
      const SetArrays<T>& ends = pool.set[s];
      for (Index e = (*ends.offset)[i]; e < (*ends.offset)[i + 1]; ++e)
        for (int j = 0; j < ends.width; ++j)
          sum += (*ends.H)[(std::size_t(e) * std::size_t(ends.width) + std::size_t(j)) * std::size_t(pool.rows) + std::size_t(k)] *
                 std::get<s>(x)[(*ends.block)[e]][j];
    });
    return sum;
  }
  /// x += M⁻¹ Hᵀ of row k, times λ.
  static void push(const RowArrays<T>& pool, Index i, int k, T lambda, Differences& x) {
    for_each_index<int(World::set_count)>([&](auto s) {
      const SetArrays<T>& ends = pool.set[s];
      for (Index e = (*ends.offset)[i]; e < (*ends.offset)[i + 1]; ++e)
        for (int j = 0; j < ends.width; ++j)
          std::get<s>(x)[(*ends.block)[e]][j] +=
              (*ends.G)[(std::size_t(e) * std::size_t(pool.rows) + std::size_t(k)) * std::size_t(ends.width) + std::size_t(j)] * lambda;
    });
  }
  static T dot_of(const Array<T>& a, const Array<T>& b) {
    T sum = 0;
    for (std::size_t n = 0; n < a.size(); ++n) sum += a[n] * b[n];
    return sum;
  }
  Differences places_, velocities_, way_;
  Array<T> residual_, direction_, image_;  ///< of held rows
  Array<char> slides_;           ///< contacts, pool by pool
  Array<Index> first_contact_;   ///< of a pool in `slides_`; −1: of joints
  bool is_known_ = false;
};

}  // namespace delassus::inner
