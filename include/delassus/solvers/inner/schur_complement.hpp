/// Contacts and limits as they are when the joints of their island hold: W less what the joints take of it.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/math/linear.hpp>
#include <delassus/math/long_vectors.hpp>
#include <delassus/math/small_products.hpp>
#include <delassus/solvers/inner/direct_system.hpp>
#include <delassus/solvers/inner/rows_alone.hpp>
#include <delassus/solvers/island.hpp>
#include <delassus/solvers/measure.hpp>

#include <algorithm>
#include <cstddef>

namespace delassus::inner {

inline constexpr int rounds_on_others = 4;  ///< of `SchurComplement::build` at most

/// S = W_cc − W_cb W_bb⁻¹ W_bc over the constraints c that are not bilateral, dense, and u = d + S λ kept as
/// sweeps change λ: their island, with S in the place of W. Those that are far from closing are left out: a
/// limit in the middle of its range, most of all. Each round asks for them anew, and the last has all.
template <class T, class System>
class SchurComplement {
 public:
  /// Takes the constraints of `system` behind its bilateral ones, with the velocities that `whole` has for
  /// them. In rounds after the first, 0, H and A are those of before.
  Island<T> build(System& system, const Island<T>& whole, int round) {
    taken_before_.swap(taken_);
    choose(system, whole, round + 1 == rounds_on_others);
    if (round > 0 && taken_ == taken_before_) return show(whole);
    list_rows(system);
    S_.assign(std::size_t(size_) * std::size_t(size_), 0);
    u_.assign(size_, 0);
    add_own(system);
    const Index asked = Index(asked_.size());
    for (Index from = 0; from < asked; from += most_columns)
      take(system, from, std::min(from + most_columns, asked));
    for (Index t = 0; t < Index(taken_.size()); ++t)
      for (int k = 0; k < node(system, t).rows; ++k) {
        double& own = column(row_[t] + k)[row_[t] + k];
        own = std::max(own, least * node(system, t).scale[k]);
      }
    return show(whole);
  }

 private:
  /// Lists the constraints that are taken, in their order, which is that of the island: whole spans of it but
  /// for what is left out, since a law's rows are all equalities or none is swept without the others.
  void choose(const System& system, const Island<T>& whole, bool all) {
    taken_.clear(), items_.clear(), spans_.clear();
    const MeasureSums nothing{.length = whole.length()};
    Index j = system.bilateral();
    for (const Span<T>& span : whole) {
      if (are_equalities(Island<T>::kinds(span), span.pool->rows)) continue;
      const std::size_t before = items_.size();
      for (const Index i : span) {
        if (all || !stays_away(system.node(j), span, i, nothing)) {
          taken_.push_back(j);
          items_.push_back(i);
        }
        ++j;
      }
      if (items_.size() > before) spans_.push_back({span.pool, nullptr, Index(items_.size() - before)});
    }
  }
  /// Without impulse, as its law wants it, and so it stays if it closes twice as fast, or no slower than it
  /// opens. Rows to which nothing answers, as those of a limit out of reach, are not asked.
  static bool stays_away(const auto& node, const Span<T>& span, Index i, MeasureSums sums) {
    const PoolView<T>& pool = *span.pool;
    const T *lambda = Island<T>::impulse(span, i), *bias = pool.bias + std::ptrdiff_t(pool.rows) * i;
    bool is_asked = false;
    for (int k = 0; k < pool.rows; ++k) {
      if (lambda[k] != 0) return false;
      is_asked = is_asked || node.scale[k] > 0;
    }
    if (is_asked) {
      T u[most_rows];
      Island<T>::velocity(span, i, u);
      bool has_sides = false;
      for (int k = 0; k < pool.rows; ++k) {
        const RowKind kind = Island<T>::kinds(span)[k];
        if (kind == RowKind::friction || !(node.scale[k] > 0)) continue;
        has_sides = true;
        if (kind == RowKind::equality ||
            !((kind == RowKind::lower ? u[k] : -u[k]) > std::abs(u[k] - bias[k])))
          return false;
      }
      if (!has_sides) return false;
    }
    pool.table->measure({&pool, &i, 1}, sums);
    return sums.residual == 0;
  }

  /// The constraints that were taken.
  Island<T> show(const Island<T>& whole) {
    pools_.clear(), first_.clear();
    std::size_t items = 0, squares = 0;
    for (const Span<T>& span : spans_) {
      first_.push_back(Index(items));
      items += std::size_t(span.pool->items);
      squares += std::size_t(span.pool->rows * span.pool->rows) * std::size_t(span.pool->items);
      pools_.push_back(*span.pool);
    }
    place_.resize(items);
    diagonal_.resize(squares);
    T* diagonal = diagonal_.data();
    const Index* listed = items_.data();
    Index at = 0;
    T u[most_rows];
    for (std::size_t n = 0; n < spans_.size(); ++n) {
      PoolView<T>& pool = pools_[n];
      const int R = pool.rows;
      spans_[n].items = listed;
      listed += spans_[n].count;
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

  /// Constraint t of those that were taken.
  const auto& node(const System& system, Index t) const { return system.node(taken_[t]); }

  /// Where the rows of each constraint begin and which blocks they act on.
  void list_rows(const System& system) {
    row_.clear();
    wanted_.assign(system.blocks(), -1);
    newest_.assign(system.blocks(), -1);
    sides_.clear();
    asked_.clear();
    blocks_ = size_ = 0;
    for (Index t = 0; t < Index(taken_.size()); ++t) {
      row_.push_back(size_);
      for (int k = 0; k < node(system, t).rows; ++k)
        if (node(system, t).scale[k] > 0) asked_.push_back({t, k});
      size_ += node(system, t).rows;
      for (Index e = node(system, t).first; e < node(system, t).last; ++e) {
        const Index b = system.side(e).block;
        if (system.is_held(b) && wanted_[b] < 0) wanted_[b] = blocks_++;
        sides_.push_back({e, t, newest_[b]});
        newest_[b] = Index(sides_.size()) - 1;
      }
    }
  }

  /// W_cc: what each side does to all on its block.
  void add_own(const System& system) {
    for (Index t = 0; t < Index(taken_.size()); ++t)
      for (int k = 0; k < node(system, t).rows; ++k)
        column(row_[t] + k)[row_[t] + k] += node(system, t).compliance[k];
    for (const ListedSide& from : sides_)
      for (Index n = newest_[system.side(from.side).block]; n >= 0; n = sides_[n].older) {
        const ListedSide& to = sides_[n];
        const int rows = node(system, to.of).rows, columns = node(system, from.of).rows;
        for (int c = 0; c < columns; ++c)
          for (int r = 0; r < rows; ++r)
            column(row_[from.of] + c)[row_[to.of] + r] +=
                row_times_column(system.side(to.side).H, r, system.side(from.side).G, c);
      }
  }

  /// The rows from … end − 1 of those that are asked as columns: what their impulses make the joints do, and
  /// what that does to all others.
  void take(System& system, Index from, Index end) {
    const Index asked = end - from, columns = (asked + 3) / 4 * 4;  // whole packets
    X_.assign(std::size_t(system.rows()) * std::size_t(columns), 0);
    for (Index c = 0; c < asked; ++c) {
      const auto& [t, k] = asked_[from + c];
      for (Index e = node(system, t).first; e < node(system, t).last; ++e)
        system.disturb(system.side(e), k, X_.data() + c, columns);
    }
    system.solve(X_.data(), columns);
    constexpr int width = System::width;
    velocity_.assign(std::size_t(blocks_) * std::size_t(width * columns), 0);
    const auto velocity = [&](Index block, int v) {
      return &velocity_[std::size_t(block * width + v) * std::size_t(columns)];
    };
    for (Index k = 0; k < system.bilateral(); ++k)
      for (Index e = system.node(k).first; e < system.node(k).last; ++e) {
        const auto& side = system.side(e);
        const Index to = wanted_[side.block];
        double g[System::w];
        for (int v = 0; to >= 0 && v < width; ++v) {
          for (int r = 0; r < system.node(k).rows; ++r) g[r] = side.G(v, r);
          add_multiples(g, system.node(k).rows, &X_[std::size_t(system.first_row(k)) * std::size_t(columns)],
                        columns, velocity(to, v), columns);
        }
      }
    for (const auto& [t, r] : asked_) {
      change_.assign(columns, 0);
      for (Index e = node(system, t).first; e < node(system, t).last; ++e) {
        const auto& side = system.side(e);
        if (wanted_[side.block] < 0) continue;
        double h[width];
        for (int v = 0; v < width; ++v) h[v] = side.H(r, v);
        add_multiples(h, width, velocity(wanted_[side.block], 0), columns, change_.data(), columns);
      }
      for (Index c = 0; c < asked; ++c) column(row_of(asked_[from + c]))[row_[t] + r] += change_[c];
    }
  }

  /// Row k of constraint t: one that bodies answer to.
  struct AskedRow {
    Index t;
    int k;
  };
  Index row_of(const AskedRow& asked) const { return row_[asked.t] + asked.k; }

  /// Side `side` of the system, of constraint `of`, and the one before it on its block, or −1.
  struct ListedSide {
    Index side, of, older;
  };

  Array<Index> taken_, taken_before_, items_;  ///< nodes of the system, and the items that they are
  Array<ListedSide> sides_;
  Array<AskedRow> asked_;
  Array<Index> newest_;  ///< of a block
  Index size_ = 0;
  Index blocks_ = 0;     ///< that are wanted
  Array<double> S_, u_;  ///< S by columns
  Array<Index> row_;     ///< the first of a constraint that was taken
  Array<Index> wanted_;  ///< the number of a block that joints hold and others act on, or −1
  Array<PoolView<T>> pools_;
  Array<Span<T>> spans_;
  Array<Index> first_, place_;  ///< the first place of a pool; of an item its first row in S
  Array<T> diagonal_;
  Array<double> X_, velocity_, change_;  ///< one row behind the other
};

}  // namespace delassus::inner
