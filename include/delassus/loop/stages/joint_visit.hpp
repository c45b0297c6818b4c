/// One joint between bodies that answer alone: its rows, its W, and what an impulse does.
#pragma once

#include <delassus/core/unrolled.hpp>
#include <delassus/loop/stages/bias.hpp>
#include <delassus/loop/stages/item_rows.hpp>
#include <delassus/math/positive.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

namespace delassus {

/// At the places where it is made. `sa` and `sb` are the sets of its ends, −1 for one that has no rows.
template <class World, class Law, int sa, int sb>
class JointVisit {
 public:
  static constexpr int R = Law::rows;
  using T = typename World::Scalar;
  using Item = typename Law::Item;

  double violation = 0;  ///< the largest |φ| of rows without a spring, m or rad

  template <class S>
  JointVisit(World& world, const Law& law, const Item& item, const S& stabilisation, double h)
      : world_(world), item_(item) {
    rows_.clear();
    law.linearize(item, std::as_const(world), ItemWriter<World, Rows, sa, sb>(world, rows_, item.a, item.b));
    unrolled<R>([&]<int k>() {
      unrolled<k + 1>([&]<int l>() { W_(k, l) = T(-0.0); });
      make_bias<k>(law, stabilisation, h);
    });
    answer<sa>(rows_.a, item.a.block);
    answer<sb>(rows_.b, item.b.block);
  }

  /// H v + bias, v one of the arrays of velocities.
  template <class Member>
  Vec<R, T> velocity(const Member& member) const {
    Vec<R, T> u;
    unrolled<R>([&]<int k>() { u[k] = bias_[k]; });
    add_velocity<sa>(rows_.a, item_.a.block, member, u);
    add_velocity<sb>(rows_.b, item_.b.block, member, u);
    return u;
  }
  /// δ = −(W + R)⁻¹ u.
  Vec<R, T> against(const Vec<R, T>& u) const {
    Mat<R, R, T> S;
    unrolled<R>([&]<int k>() {
      S(k, k) = W_(k, k) + yield_[k];
      unrolled<k>([&]<int l>() { S(k, l) = W_(k, l); });
    });
    return -solve_positive<R, T>(S, u);
  }
  /// (W + R) λ: what λ does to this joint alone.
  Vec<R, T> response(const Vec<R, T>& lambda) const {
    Vec<R, T> u;
    unrolled<R>([&]<int k>() {
      T sum = yield_[k] * lambda[k];
      unrolled<R>([&]<int l>() { sum += (k < l ? W_(l, k) : W_(k, l)) * lambda[l]; });
      u[k] = sum;
    });
    return u;
  }
  /// R λ.
  Vec<R, T> yields(const Vec<R, T>& lambda) const {
    Vec<R, T> u;
    unrolled<R>([&]<int k>() { u[k] = yield_[k] * lambda[k]; });
    return u;
  }
  /// v_next += G λ.
  void push(const Vec<R, T>& lambda) const {
    push_end<sa>(rows_.a, item_.a.block, lambda);
    push_end<sb>(rows_.b, item_.b.block, lambda);
  }
  T trace() const {
    T sum = 0;
    unrolled<R>([&]<int k>() { sum += W_(k, k) + yield_[k]; });
    return sum;
  }
  /// f(set, block) for the ends that answer to impulses.
  template <class F>
  void each_moving(F&& f) const {
    if constexpr (sa >= 0)
      if (world_.template set<sa>().moves(item_.a.block)) f(std::integral_constant<int, sa>{}, item_.a.block);
    if constexpr (sb >= 0)
      if (world_.template set<sb>().moves(item_.b.block)) f(std::integral_constant<int, sb>{}, item_.b.block);
  }

 private:
  template <int s>
  static constexpr auto no_rows_or_width() {
    if constexpr (s < 0)
      return NoRows{};
    else
      return RowsOfEnd<R, World::template width_of<s>, T>{};
  }
  using Rows = ItemRows<R, T, decltype(no_rows_or_width<sa>()), decltype(no_rows_or_width<sb>())>;

  template <int k, class S>
  void make_bias(const Law& law, const S& stabilisation, double h) {
    if (rows_.stiffness[k] > 0 || rows_.damping[k] > 0) {
      const inner::SoftRow row =
          inner::soft_row(double(rows_.stiffness[k]), double(rows_.damping[k]), double(rows_.phi[k]), h, 1);
      yield_[k] = T(row.compliance);
      bias_[k] = T(row.bias);
    } else {
      yield_[k] = T(0);
      if constexpr (requires { stabilisation.joint_compliance(h); })
        yield_[k] = T(stabilisation.joint_compliance(h));
      bias_[k] = T(stabilisation.equality(double(rows_.phi[k]), h));
      violation = std::max(violation, double(std::abs(rows_.phi[k])));
    }
    if constexpr (requires { law.speed(item_); }) bias_[k] -= T(law.speed(item_));
  }
  /// G and W of one end.
  template <int s, class End>
  void answer(End& end, Index block) {
    if constexpr (End::answers) {
      const auto& set = std::as_const(world_).template set<s>();
      const T over_mass = set.inverse_mass(block);
      unrolled<R>([&]<int k>() {
        end.G[k].linear = end.H[k].linear * over_mass;
        if constexpr (World::template width_of<s> == 6)
          end.G[k].angular = set.inverse_inertia(block) * end.H[k].angular;
        unrolled<k + 1>([&]<int l>() { W_(k, l) += end.H[l].dot(end.G[k]); });
      });
    }
  }
  template <int s, class End, class Member>
  void add_velocity(const End& end, Index block, const Member& member, Vec<R, T>& u) const {
    if constexpr (End::answers) {
      using Row = std::remove_cvref_t<decltype(end.H[0])>;
      const Row v(member(std::as_const(world_).template set<s>())[block]);
      unrolled<R>([&]<int k>() { u[k] += end.H[k].dot(v); });
    }
  }
  template <int s, class End>
  void push_end(const End& end, Index block, const Vec<R, T>& lambda) const {
    if constexpr (End::answers) {
      auto& v = world_.template set<s>().v_next[block];
      unrolled<R>([&]<int k>() {
        const auto row = end.G[k].whole();
        unrolled<std::remove_cvref_t<decltype(row)>::RowsAtCompileTime>(
            [&]<int j>() { v[j] += row[j] * lambda[k]; });
      });
    }
  }

  World& world_;
  const Item& item_;
  Rows rows_;
  Mat<R, R, T> W_;  ///< on and below the diagonal, without R
  std::array<T, R> bias_, yield_;
};

}  // namespace delassus
