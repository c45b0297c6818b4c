/// One joint between bodies that answer alone: its rows, its W, and what an impulse does.
#pragma once

#include <delassus/core/cmath.hpp>
#include <delassus/math/positive.hpp>
#include <delassus/math/twist.hpp>
#include <delassus/schemes/inner/item_rows.hpp>
#include <delassus/step/bias.hpp>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace delassus {

/// The velocities that a visit reads: those of the sweep, or those before all impulses.
enum class VisitVelocity { next, free };

/// At the places where it is made, in double whatever the sets are in: a short joint on a long arm has rows that single
/// precision cannot tell from redundant ones.
template <class World, int rows>
class JointVisit {
 public:
  static constexpr int R = rows;
  using Row = Vec<R>;

  double violation = 0;  ///< the largest |φ| of rows without a spring, m or rad

  template <class Law, class S>
  JointVisit(World& world, const Law& law, const typename Law::Item& item, const S& stabilisation, double h) {
    ItemRows<R> H;
    law.linearize(item, std::as_const(world), ItemWriter<World, R>(world, H, item.a, item.b));
    set_zero(W_);
    answer(world, item.a, H.a, a_);
    answer(world, item.b, H.b, b_);
    for (int k = 0; k < R; ++k) make_bias(law, item, H, k, stabilisation, h);
  }

  bool answers() const { return a_.next != nullptr || b_.next != nullptr; }
  /// H v + bias.
  template <VisitVelocity which>
  Row velocity() const {
    Row u = bias_;
    for (const End* end : {&a_, &b_}) {
      const Scalar* v = which == VisitVelocity::free ? end->free : end->any;
      for (int j = 0; j < end->width; ++j)
        for (int k = 0; k < R; ++k) u[k] += end->H[std::size_t(k)][j] * double(v[j]);
    }
    return u;
  }
  /// δ = −(W + R)⁻¹ u, zero where no end answers.
  Row against(const Row& u) const {
    Mat<R, R> S = W_;
    S.diagonal() += yield_;
    return -solve_positive<R, double>(S, u);
  }
  /// (W + R) λ: what λ does to this joint alone.
  Row response(const Row& lambda) const { return W_ * lambda + yields(lambda); }
  /// R λ.
  Row yields(const Row& lambda) const { return yield_.cwiseProduct(lambda); }
  /// v_next += G λ, of ends that answer.
  void push(const Row& lambda) const {
    for (const End* end : {&a_, &b_}) {
      if (end->next == nullptr) continue;
      for (int j = 0; j < end->width; ++j) {
        double change = 0;
        for (int k = 0; k < R; ++k) change += end->G[std::size_t(k)][j] * lambda[k];
        end->next[j] += Scalar(change);
      }
    }
  }
  /// W_kk + R_k.
  double own(int k) const { return W_(k, k) + yield_[k]; }
  /// f(set, block) for the ends that answer to impulses.
  template <class F>
  void each_moving(const World& world, F&& f) const {
    for (const End* end : {&a_, &b_})
      if (end->next != nullptr)
        with_set_of_body(world, *end->anchor, [&](auto s) { f(s, end->anchor->block); });
  }

 private:
  using Scalar = typename World::Scalar;
  struct End {
    RowsOfEnd<R> H, G;  ///< G: A⁻¹ Hᵀ, by its columns
    int width = 0;      ///< of the block's velocities; 0 in the world
    const Anchor* anchor = nullptr;
    const Scalar *any = nullptr, *free = nullptr;
    Scalar* next = nullptr;  ///< `any`, where the body answers
  };

  void answer(World& world, const Anchor& anchor, const RowsOfEnd<R>& H, End& end) {
    with_set_of_body(world, anchor, [&](auto s) {
      auto& set = world.template set<s>();
      using Set = std::remove_cvref_t<decltype(set)>;
      const Index block = anchor.block;
      end.anchor = &anchor;
      end.H = H;
      end.width = Set::width;
      end.any = set.v_next[block].data();
      end.free = set.v_free[block].data();
      if (!set.moves(block)) return;
      end.next = set.v_next[block].data();
      for (int k = 0; k < R; ++k) {
        auto& G = end.G[std::size_t(k)];
        set_zero(G);
        G.template head<3>() = double(set.inverse_mass(block)) * H[std::size_t(k)].template head<3>();
        if constexpr (Set::width == 6)
          G.template tail<3>() = set.inverse_inertia(block).template cast<double>() * H[std::size_t(k)].template tail<3>();
        for (int l = 0; l <= k; ++l) W_(k, l) += dot(H[std::size_t(l)], G);
        for (int l = 0; l < k; ++l) W_(l, k) = W_(k, l);
      }
    });
  }
  template <class Law, class S>
  void make_bias(const Law& law, const typename Law::Item& item, const ItemRows<R>& H, int k, const S& stabilisation, double h) {
    yield_[k] = 0;
    if (inner::is_spring(H.stiffness[k], H.damping[k])) {
      const inner::SoftRow row = inner::soft_row(H.stiffness[k], H.damping[k], H.phi[k], h, 1);
      yield_[k] = row.compliance;
      bias_[k] = row.bias;
    } else {
      yield_[k] = inner::joint_compliance_of(stabilisation, h);
      bias_[k] = stabilisation.equality(H.phi[k], h);
      violation = std::max(violation, std::abs(H.phi[k]));
    }
    if constexpr (refines<std::remove_cvref_t<decltype(law)>>(refine::speed)) bias_[k] -= law.speed(item);
    if (!answers()) yield_[k] = 0;
  }

  End a_, b_;
  Mat<R, R> W_;  ///< without R
  Row bias_, yield_;
};

}  // namespace delassus
