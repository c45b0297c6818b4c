/// Contacts and limits as they are when the joints of their island hold: W less what the joints take of it.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/long_vectors.hpp>
#include <delassus/math/small_products.hpp>
#include <delassus/solvers/inner/direct_system.hpp>
#include <delassus/solvers/inner/rows_alone.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

/// S = W_cc − W_cb W_bb⁻¹ W_bc over the constraints c that are not bilateral, dense, and u = d + S λ kept as
/// sweeps change λ: their island, with S in the place of W.
template <class T, class System>
class SchurComplement {
 public:
  /// Takes the constraints of `system` behind its bilateral ones, with the velocities that `whole` has for
  /// them.
  Island<T> build(System& system, const Island<T>& whole) {
    const Index first = system.bilateral();
    list_rows(system, first);
    S_.assign(std::size_t(size_) * std::size_t(size_), 0);
    u_.assign(size_, 0);
    add_own(system, first);
    for (Index from = 0; from < size_; from += most_columns) take(system, first, from, std::min(from + most_columns, size_));
    for (Index j = first; j < system.count(); ++j)
      for (int k = 0; k < system.node(j).rows; ++k) {
        double& own = column(row_[j - first] + k)[row_[j - first] + k];
        own = std::max(own, least * system.node(j).scale[k]);
      }
    return show(whole);
  }

 private:
  /// The constraints that were taken, in their order: whole spans of the island, since a law's rows are all
  /// equalities or none is swept without the others.
  Island<T> show(const Island<T>& whole) {
    pools_.clear(), spans_.clear(), first_.clear();
    std::size_t items = 0, squares = 0;
    for (const Span<T>& span : whole) {
      if (are_equalities(Island<T>::kinds(span), span.pool->rows)) continue;
      first_.push_back(Index(items));
      items += std::size_t(span.pool->items);
      squares += std::size_t(span.pool->rows * span.pool->rows) * std::size_t(span.pool->items);
      pools_.push_back(*span.pool);
      spans_.push_back(span);
    }
    place_.resize(items);
    diagonal_.resize(squares);
    T* diagonal = diagonal_.data();
    Index at = 0;
    T u[most_rows];
    for (std::size_t n = 0; n < spans_.size(); ++n) {
      PoolView<T>& pool = pools_[n];
      const int R = pool.rows;
      for (const Index i : spans_[n]) {
        place_[std::size_t(first_[n] + i)] = at;
        Island<T>::velocity(spans_[n], i, u);  // by W
        for (int c = 0; c < R; ++c) {
          u_[at + c] = double(u[c]);
          for (int k = 0; k < R; ++k)
            diagonal[std::ptrdiff_t(R * R) * i + k + R * c] = T(column(at + c)[at + k]);
        }
        at += R;
      }
      pool.pool = int(n);
      pool.diagonal = pool.own_diagonal = diagonal;
      pool.form = FormOfW::functions;
      pool.functions = {this, nullptr, residual, changed};
      diagonal += std::ptrdiff_t(R * R) * pool.items;
    }
    for (std::size_t n = 0; n < spans_.size(); ++n) {
      spans_[n].pool = &pools_[n];
      pools_[n].table->prepare(spans_[n], whole.h());
    }
    return whole.part(spans_.data(), int(spans_.size()));
  }
  static void residual(const FunctionsOfW<T>& of, int pool, Index i, T* u) {
    const auto& own = *static_cast<const SchurComplement*>(of.W);
    const Index at = own.place_[std::size_t(own.first_[std::size_t(pool)] + i)];
    for (int k = 0; k < own.pools_[std::size_t(pool)].rows; ++k) u[k] = T(own.u_[at + k]);
  }
  static void changed(const FunctionsOfW<T>& of, int pool, Index i, const T* change) {
    auto& own = *static_cast<SchurComplement*>(of.W);
    const Index at = own.place_[std::size_t(own.first_[std::size_t(pool)] + i)];
    for (int c = 0; c < own.pools_[std::size_t(pool)].rows; ++c) {
      const double by = double(change[c]);
      if (by == 0) continue;
      const double* s = own.column(at + c);
      for (Index k = 0; k < own.size_; ++k) own.u_[k] += by * s[k];
    }
  }

  double* column(Index c) { return &S_[std::size_t(c) * size_]; }
  const double* column(Index c) const { return &S_[std::size_t(c) * size_]; }

  /// A contact on what joints hold fast has no S but rounding: it is given this much of W_kk, and the rounds
  /// of the solver take the error of that out again.
  static constexpr double least = 1e-6;

  /// Columns that are solved for together: of a thousand hinges they are 5 MB.
  static constexpr Index most_columns = 128;

  /// Where the rows of each constraint begin and which blocks they act on.
  void list_rows(const System& system, Index first) {
    row_.clear();
    wanted_.assign(system.blocks(), -1);
    blocks_ = size_ = 0;
    for (Index j = first; j < system.count(); ++j) {
      const auto& node = system.node(j);
      row_.push_back(size_);
      size_ += node.rows;
      for (Index e = node.first; e < node.last; ++e)
        if (const Index b = system.side(e).block; system.is_held(b) && wanted_[b] < 0) wanted_[b] = blocks_++;
    }
  }

  /// W_cc.
  void add_own(const System& system, Index first) {
    for (Index j = first; j < system.count(); ++j) {
      const auto& node = system.node(j);
      const Index at = row_[j - first];
      for (int k = 0; k < node.rows; ++k) column(at + k)[at + k] += node.compliance[k];
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
            column(row_[j - first] + c)[row_[k - first] + r] += row_times_column(to.H, r, from.G, c);
      }
  }

  /// The columns from … end − 1: what their impulses make the joints do, and what that does to all others.
  void take(System& system, Index first, Index from, Index end) {
    const Index columns = end - from;
    X_.assign(std::size_t(system.rows()) * std::size_t(columns), 0);
    for (Index j = first; j < system.count(); ++j)
      for (int c = 0; c < system.node(j).rows; ++c) {
        const Index to = row_[j - first] + c - from;
        if (to < 0 || to >= columns) continue;
        for (Index e = system.node(j).first; e < system.node(j).last; ++e) system.disturb(system.side(e), c, X_.data() + to, columns);
      }
    system.solve(X_.data(), columns);
    constexpr int width = System::width;
    velocity_.assign(std::size_t(blocks_) * std::size_t(width * columns), 0);
    const auto velocity = [&](Index block, int v) { return &velocity_[std::size_t(block * width + v) * std::size_t(columns)]; };
    for (Index k = 0; k < system.bilateral(); ++k)
      for (Index e = system.node(k).first; e < system.node(k).last; ++e) {
        const auto& side = system.side(e);
        const Index to = wanted_[side.block];
        for (int r = 0; to >= 0 && r < system.node(k).rows; ++r)
          for (int v = 0; v < width; ++v)
            if (const double g = side.G(v, r); g != 0)
              add_multiple(g, &X_[std::size_t(system.first_row(k) + r) * std::size_t(columns)], velocity(to, v), columns);
      }
    for (Index j = first; j < system.count(); ++j)
      for (int r = 0; r < system.node(j).rows; ++r) {
        change_.assign(columns, 0);
        for (Index e = system.node(j).first; e < system.node(j).last; ++e) {
          const auto& side = system.side(e);
          for (int v = 0; wanted_[side.block] >= 0 && v < width; ++v)
            if (const double h = side.H(r, v); h != 0) add_multiple(h, velocity(wanted_[side.block], v), change_.data(), columns);
        }
        for (Index c = 0; c < columns; ++c) column(from + c)[row_[j - first] + r] += change_[c];
      }
  }

  Index size_ = 0;
  Index blocks_ = 0;     ///< that are wanted
  Array<double> S_, u_;  ///< S by columns
  Array<Index> row_;     ///< the first of a constraint
  Array<Index> wanted_;  ///< the number of a block that joints hold and others act on, or −1
  Array<PoolView<T>> pools_;
  Array<Span<T>> spans_;
  Array<Index> first_, place_;  ///< the first place of a pool; of an item its first row in S
  Array<T> diagonal_;
  Array<double> X_, velocity_, change_;  ///< one row behind the other
};

}  // namespace delassus::inner
