/// Contacts and limits as they are when the joints of their island hold: W less what the joints take of it.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/solvers/inner/direct_system.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <tuple>
#include <vector>

namespace delassus::inner {

/// S = W_cc − W_cb W_bb⁻¹ W_bc over the constraints c that are not bilateral, dense, and u = d + S λ kept as
/// sweeps change λ: to a solver it is a compliance, and its own list of items.
template <class Rows>
class SchurComplement {
  using System = DirectSystem<Rows>;
  static constexpr int w = System::w;

 public:
  using T = typename Rows::Scalar;

  /// Takes the constraints of `system` behind its bilateral ones, with the velocities that `problem` has for
  /// them.
  void build(System& system, const auto& problem) {
    for (auto& items : items_) items.clear();
    const Index first = system.bilateral();
    size_ = w * (system.count() - first);
    S_.assign(std::size_t(size_) * size_, 0);
    u_.assign(size_, 0);
    add_own(system, first);
    for (Index j = first; j < system.count(); ++j) {
      take_from(system, first, j);
      for (int k = 0; k < system.node(j).rows; ++k) {
        double& own = column(w * (j - first) + k)[w * (j - first) + k];
        own = std::max(own, least * system.node(j).scale[k]);
      }
    }
    for_each_index<System::pools>([&](auto p) {
      constexpr int r = Rows::template rows_of<p>;
      auto& place = place_[p];
      for (Index j = first; j < system.count(); ++j) {
        const auto& node = system.node(j);
        if (node.pool != p) continue;
        items_[p].push_back(node.item);
        if (Index(place.size()) <= node.item) place.resize(node.item + 1);
        place[node.item] = w * (j - first);
        const Vec<r, T> u = problem.template local<p>(node.item).d;
        for (int k = 0; k < r; ++k) u_[place[node.item] + k] = double(u[k]);
      }
    });
  }

  std::span<const Index> items(int p, Index) const { return items_[p]; }

  template <int p>
  Mat<Rows::template rows_of<p>, Rows::template rows_of<p>, T> diagonal(Index i) const {
    constexpr int r = Rows::template rows_of<p>;
    Mat<r, r, T> own;
    const Index at = place_[p][i];
    for (int c = 0; c < r; ++c)
      for (int k = 0; k < r; ++k) own(k, c) = T(column(at + c)[at + k]);
    return own;
  }
  template <int p>
  Vec<Rows::template rows_of<p>, T> residual(const Rows&, Index i) const {
    Vec<Rows::template rows_of<p>, T> u;
    for (int k = 0; k < Rows::template rows_of<p>; ++k) u[k] = T(u_[place_[p][i] + k]);
    return u;
  }
  template <int p>
  void commit(const Rows&, Index i, const Vec<Rows::template rows_of<p>, T>& change) {
    for (int c = 0; c < Rows::template rows_of<p>; ++c) {
      const double by = double(change[c]);
      if (by == 0) continue;
      const double* s = column(place_[p][i] + c);
      for (Index k = 0; k < size_; ++k) u_[k] += by * s[k];
    }
  }

 private:
  double* column(Index c) { return &S_[std::size_t(c) * size_]; }
  const double* column(Index c) const { return &S_[std::size_t(c) * size_]; }

  /// A contact on what joints hold fast has no S but rounding: it is given this much of W_kk, and the rounds
  /// of the solver take the error of that out again.
  static constexpr double least = 1e-6;

  /// W_cc.
  void add_own(const System& system, Index first) {
    for (Index j = first; j < system.count(); ++j) {
      const auto& node = system.node(j);
      for (int k = 0; k < node.rows; ++k)
        column(w * (j - first) + k)[w * (j - first) + k] += node.compliance[k];
      for (Index e = node.first; e < node.last; ++e) add_velocity(system, first, j, e);
    }
  }
  /// What side e of constraint j does to all sides on its block.
  void add_velocity(const System& system, Index first, Index j, Index e) {
    const auto& from = system.side(e);
    for (Index k = first; k < system.count(); ++k)
      for (Index f = system.node(k).first; f < system.node(k).last; ++f) {
        const auto& to = system.side(f);
        if (to.block != from.block) continue;
        for (int c = 0; c < system.node(j).rows; ++c)
          for (int r = 0; r < system.node(k).rows; ++r)
            column(w * (j - first) + c)[w * (k - first) + r] += row_times_column(to.H, r, from.G, c);
      }
  }
  /// The columns of constraint j: what its impulses make the joints do, and what that does to all others.
  void take_from(System& system, Index first, Index j) {
    const auto& node = system.node(j);
    bool is_held = false;
    for (Index e = node.first; e < node.last; ++e) is_held |= system.is_held(system.side(e).block);
    if (!is_held) return;
    for (int c = 0; c < node.rows; ++c) {
      system.clear();
      for (Index e = node.first; e < node.last; ++e) system.disturb(system.side(e), c);
      system.solve();
      velocity_.assign(system.blocks(), zero<typename System::Twist>());
      for (Index k = 0; k < system.bilateral(); ++k)
        for (Index e = system.node(k).first; e < system.node(k).last; ++e)
          velocity_[system.side(e).block] += system.side(e).G * system.answer(k);
      double* s = column(w * (j - first) + c);
      for (Index k = first; k < system.count(); ++k)
        for (Index e = system.node(k).first; e < system.node(k).last; ++e) {
          const Vec<w> u = system.side(e).H * velocity_[system.side(e).block];
          for (int r = 0; r < system.node(k).rows; ++r) s[w * (k - first) + r] += u[r];
        }
    }
  }

  Index size_ = 0;
  Array<double> S_, u_;  ///< by columns; w entries a constraint
  std::array<Array<Index>, System::pools> items_, place_;
  std::vector<typename System::Twist> velocity_;
};

}  // namespace delassus::inner
