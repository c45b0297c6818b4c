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
#include <delassus/rows/row_kind.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/rows/soft.hpp>
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
    each_pool(step.rows, [&](auto, const auto& pool) {
      step.world().each([&](const auto& set, auto s) {
        const auto& blocks = inner::part<s>(pool.sets);
        is_known_ = is_known_ && blocks.G.size() == blocks.H.size();
        for (const Index b : blocks.block)
          is_known_ = is_known_ && (set.moves(b) || is_zero(set.velocity()[b]));
      });
    });
  }
  bool is_known() const { return is_known_; }
  /// Of where the bodies are now from `whole`; false where the last step was not one of those.
  bool take(auto& step, const EndState<World>& whole) {
    if (!is_known_) return false;
    whole.difference(step.world(), places_, velocities_);
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
        step, [&](const auto& pool, Index i, int k) { residual_.push_back(rate(pool, i, k, x)); });
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
          step, [&](const auto& pool, Index i, int k) { push(pool, i, k, direction_[n++], way_); });
      n = 0;
      each_held_row<of_rates>(
          step, [&](const auto& pool, Index i, int k) { image_[n++] = rate(pool, i, k, way_); });
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
  /// f(pool, item, row).
  template <bool of_rates>
  static void each_held_row(auto& step, auto&& f) {
    each_pool(step.rows, [&](auto p, const auto& pool) {
      const auto& items = step.laws().template pool<p>();
      using Law = std::remove_cvref_t<decltype(items.law)>;
      constexpr auto kinds = row_kinds<Law>();
      for (Index i = 0; i < pool.items(); ++i) {
        bool sticks = of_rates;
        if constexpr (ContactLaw<Law>)
          sticks = sticks && !step.contact_cache.results[items.item(i).result].is_sliding;
        for (int k = 0; k < Law::rows; ++k) {
          const RowKind kind = kinds[std::size_t(k)];
          const bool holds = kind == RowKind::equality
                                 ? !is_spring(pool.stiffness[i][k], pool.damping[i][k])
                                 : pool.lambda[i][k] != T(0) && (sticks || kind != RowKind::friction);
          if (holds) f(pool, i, k);
        }
      }
    });
  }
  /// Row k of H x.
  static T rate(const auto& pool, Index i, int k, const Differences& x) {
    T sum = 0;
    for_each_index<int(World::set_count)>([&](auto s) {
      const auto& blocks = inner::part<s>(pool.sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        for (int j = 0; j < int(blocks.H[e].cols()); ++j)
          sum += blocks.H[e](k, j) * std::get<s>(x)[blocks.block[e]][j];
    });
    return sum;
  }
  /// x += M⁻¹ Hᵀ of row k, times λ.
  static void push(const auto& pool, Index i, int k, T lambda, Differences& x) {
    for_each_index<int(World::set_count)>([&](auto s) {
      const auto& blocks = inner::part<s>(pool.sets);
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        for (int j = 0; j < int(blocks.H[e].cols()); ++j)
          std::get<s>(x)[blocks.block[e]][j] += blocks.G[e](j, k) * lambda;
    });
  }
  static T dot_of(const Array<T>& a, const Array<T>& b) {
    T sum = 0;
    for (std::size_t n = 0; n < a.size(); ++n) sum += a[n] * b[n];
    return sum;
  }
  Differences places_, velocities_, way_;
  Array<T> residual_, direction_, image_;  ///< of held rows
  bool is_known_ = false;
};

}  // namespace delassus::inner
