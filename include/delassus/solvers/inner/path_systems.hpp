/// The matrix of smoothed rows: in the velocities of the bodies, or in the impulses where there are none.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/linear/block_lu.hpp>
#include <delassus/linear/dense_elimination.hpp>
#include <delassus/solvers/inner/newton_system.hpp>
#include <delassus/solvers/inner/path_item.hpp>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace delassus::inner {

/// With y the change of the bodies' velocities that δλ = P D δ/w makes, −∂r/∂x δ = ρ is
///
///   δ = (1 + E) F (ρ − P H y),   (1 + G S H) y = G S P⁻¹ ρ,   S = P E F P/w,   F = (B + P C P E/w)⁻¹:
///
/// one sparse factorization with six unknowns a body, however many contacts they have. Rank of W does not
/// matter.
template <class T, int width>
class PathBodies : private NewtonSystem<T, width> {
  using Base = NewtonSystem<T, width>;
  using Constraint = typename Base::Constraint;
  using Base::constraints_, Base::compliance;
  static constexpr int most = most_rows;

 public:
  using Base::gather, Base::constraints, Base::slope, Base::lambda, Base::velocity;
  static constexpr double largest_ratio = 1e10;  ///< of E, whose rounding the passes of `solve` take back

  bool factor(PathRows<double>& rows, const Array<double>&) {
    double scaled[most * most];
    for (const Constraint& c : constraints_) {
      const int R = c.rows;
      const double *E = &rows.E[c.slope], *B = &rows.B[c.slope];
      bent_.resize(R);
      for (int k = 0; k < R; ++k)
        for (int l = 0; l < R; ++l)
          bent_.at(k, l) = B[k + R * l] + rows.shape[c.at + k] * compliance[c.at + k] * rows.scale[c.at + k] * E[k + R * l];
      if (!bent_.factor()) return false;
      double* folded = &rows.folded[c.slope];
      for (int l = 0; l < R; ++l) {
        for (int k = 0; k < R; ++k) folded[k + R * l] = k == l;
        bent_.solve({folded + R * l, std::size_t(R)});
      }
      std::fill(scaled, scaled + R * R, 0.0);
      add_product(R, R, R, E, folded, scaled);
      for (int k = 0; k < R; ++k)
        for (int l = 0; l < R; ++l) slope[c.slope + k + R * l] = rows.scale[c.at + k] * scaled[k + R * l] * rows.shape[c.at + l];
    }
    return Base::factor(nullptr);
  }
  /// Whether det(−∂r/∂x) < 0: between it and the matrix that is factored lie positive ones.
  bool is_negative() const { return Base::is_negative(); }
  /// Leaves δ in `lambda`, ρ being `side`. With g = (1 + E)⁻¹ δ what a pass has left of ρ is
  /// ρ − B g − P (W + C) P E g/w, which goes in again: where contacts carry, E is large, and so is the
  /// rounding of the matrix.
  void solve(PathRows<double>& rows) {
    rows.error.assign(rows.error.size(), 0.0);
    lambda = rows.side;
    double first[most], second[most];
    for (int pass = 0;; ++pass) {
      begin_push();
      for (const Constraint& c : constraints_) {
        multiply(c, rows.folded, &lambda[c.at], first);
        multiply(c, rows.E, first, second);
        push(c, rows, second);
      }
      Base::solve(y_, nullptr);
      for (const Constraint& c : constraints_) {
        std::fill(first, first + c.rows, 0.0);
        this->add_rates(c, y_, first);
        for (int k = 0; k < c.rows; ++k) lambda[c.at + k] -= rows.shape[c.at + k] * first[k];
        multiply(c, rows.folded, &lambda[c.at], second);
        for (int k = 0; k < c.rows; ++k) rows.error[c.at + k] += second[k];
      }
      if (pass == passes - 1) break;
      begin_push();
      for (const Constraint& c : constraints_) {
        multiply(c, rows.E, &rows.error[c.at], first);
        push(c, rows, first);
      }
      for (const Constraint& c : constraints_) {
        multiply(c, rows.E, &rows.error[c.at], first);
        for (int k = 0; k < c.rows; ++k) first[k] *= compliance[c.at + k] * rows.scale[c.at + k];
        this->add_rates(c, y_, first);
        multiply(c, rows.B, &rows.error[c.at], second);
        for (int k = 0; k < c.rows; ++k) lambda[c.at + k] = rows.side[c.at + k] - second[k] - rows.shape[c.at + k] * first[k];
      }
    }
    for (const Constraint& c : constraints_) {
      multiply(c, rows.E, &rows.error[c.at], first);
      for (int k = 0; k < c.rows; ++k) lambda[c.at + k] = rows.error[c.at + k] + first[k];
    }
  }
  /// Leaves W δλ in `velocity`, δλ being `error`.
  void answer(const PathRows<double>& rows) {
    begin_push();
    for (const Constraint& c : constraints_) this->add_answers(c, &rows.error[c.at], 1, y_);
    for (const Constraint& c : constraints_) {
      for (int k = 0; k < c.rows; ++k) velocity[c.at + k] = compliance[c.at + k] * rows.error[c.at + k];
      this->add_rates(c, y_, &velocity[c.at]);
    }
  }

 private:
  static constexpr int passes = 3;

  static void multiply(const Constraint& c, const Array<double>& A, const double* x, double* out) {
    std::fill(out, out + c.rows, 0.0);
    add_product(c.rows, c.rows, 1, &A[c.slope], x, out);
  }
  void begin_push() { y_.assign(this->blocks(), zero<Vec<width>>()); }
  /// y += Σ G P x/w.
  void push(const Constraint& c, const PathRows<double>& rows, const double* x) {
    double impulse[most];
    for (int k = 0; k < c.rows; ++k) impulse[k] = rows.scale[c.at + k] * x[k];
    this->add_answers(c, impulse, 1, y_);
  }

  BasicDenseElimination<double> bent_;
  typename Base::Velocities y_;
};

/// One pool of rows with an assembled W. With δλ = P D δ/w,
///
///   (W + w P⁻¹ B E⁻¹ P⁻¹) δλ = P⁻¹ ρ,   δ = (1 + E⁻¹) w P⁻¹ δλ:
///
/// what is added to W grows where a contact opens, and where it carries it keeps W's null space from being
/// one.
template <class T, int R>
class PathImpulses {
  static constexpr double least = 1e-14;  ///< of w, added to W: above the rounding of its null space
  using Constraint = NewtonConstraint<T>;
  using Block = Mat<R, R>;

 public:
  static constexpr double largest_ratio = 1e12;  ///< of E: its inverse stands beside W

  bool gather(const Island<T>& island) {
    constraints_.clear(), own_.clear(), entries_.clear(), pairs_.clear();
    if (island.end() - island.begin() != 1) return false;
    const Span<T>& span = *island.begin();
    const PoolView<T>& pool = *span.pool;
    if (pool.rows != R || !pool.is_matrix() || !pool.table->friction || span.count != pool.items) return false;
    for (Index i = 0; i < span.count; ++i) {
      if (span.items[i] != i || !(pool.table->friction(pool, i) > 0)) return false;
      constraints_.push_back({&span, i, 0, 0, R * i, R * R * i, R, i});
      own_.push_back(block_of(pool.own_block(i)));
      if (pool.block_rows == 0) continue;
      const BlockRowsView<T>& W = pool.blocks[0];
      for (Index e = W.start[i]; e < W.start[i + 1]; ++e) {
        entries_.push_back({i, W.column[e], block_of(W.block + std::ptrdiff_t(R * R) * e)});
        pairs_.emplace_back(i, W.column[e]);
      }
    }
    matrix_.analyse(span.count, pairs_);
    for (auto* rows : {&lambda, &velocity}) rows->assign(std::size_t(R) * std::size_t(span.count), 0.0);
    slope.assign(std::size_t(R * R) * std::size_t(span.count), 0.0);
    return true;
  }
  const Array<Constraint>& constraints() const { return constraints_; }

  bool factor(PathRows<double>& rows, const Array<double>& weight) {
    matrix_.set_identity();
    for (const Constraint& c : constraints_) {
      Block own = own_[std::size_t(c.item)];
      const Block bent = square(rows.B, c) * square(rows.inverse, c);
      for (int k = 0; k < R; ++k) {
        for (int l = 0; l < R; ++l) own(k, l) += bent(k, l) / (rows.shape[c.at + k] * rows.scale[c.at + l]);
        own(k, k) += least * weight[std::size_t(c.number)];
      }
      matrix_.at(c.item, c.item) = own;
      for (int k = 0; k < R * R; ++k) slope[c.slope + k] = own.data()[k];
    }
    for (const Entry& e : entries_) matrix_.at(e.row, e.column) = e.block;
    return matrix_.factor();
  }
  bool is_negative() const { return matrix_.is_negative(); }
  void solve(PathRows<double>& rows) {
    for (std::size_t k = 0; k < rows.side.size(); ++k) rows.side[k] /= rows.shape[k];
    rows.error.assign(rows.error.size(), 0.0);
    for (int pass = 0; pass < 3; ++pass) {  // pivots inside blocks alone leave a residual, which goes in again
      y_.resize(constraints_.size());
      for (const Constraint& c : constraints_)
        y_[std::size_t(c.item)] = vector(rows.side, c.item) - square(slope, c) * vector(rows.error, c.item);
      for (const Entry& e : entries_) y_[std::size_t(e.row)] -= e.block * vector(rows.error, e.column);
      matrix_.solve(y_);
      for (const Constraint& c : constraints_)
        for (int k = 0; k < R; ++k) rows.error[c.at + k] += y_[std::size_t(c.item)][k];
    }
    for (const Constraint& c : constraints_) {
      Vec<R> change;
      for (int k = 0; k < R; ++k) change[k] = rows.error[c.at + k] / rows.scale[c.at + k];
      const Vec<R> across = square(rows.inverse, c) * change;
      for (int k = 0; k < R; ++k) lambda[c.at + k] = change[k] + across[k];
    }
  }
  void answer(const PathRows<double>& rows) {
    for (const Constraint& c : constraints_) add_velocity(c.item, own_[std::size_t(c.item)] * vector(rows.error, c.item), true);
    for (const Entry& e : entries_) add_velocity(e.row, e.block * vector(rows.error, e.column), false);
  }

  Array<double> slope, lambda, velocity;

 private:
  struct Entry {
    Index row, column;
    Block block;
  };

  static Block block_of(const T* from) {
    Block out;
    for (int k = 0; k < R * R; ++k) out.data()[k] = double(from[k]);
    return out;
  }
  static Block square(const Array<double>& list, const Constraint& c) { return block_of_numbers(&list[c.slope]); }
  static Block block_of_numbers(const double* from) {
    Block out;
    for (int k = 0; k < R * R; ++k) out.data()[k] = from[k];
    return out;
  }
  static Vec<R> vector(const Array<double>& list, Index i) {
    Vec<R> out;
    for (int k = 0; k < R; ++k) out[k] = list[std::size_t(R * i + k)];
    return out;
  }
  void add_velocity(Index i, const Vec<R>& u, bool is_first) {
    for (int k = 0; k < R; ++k) velocity[std::size_t(R * i + k)] = (is_first ? 0 : velocity[std::size_t(R * i + k)]) + u[k];
  }

  Array<Constraint> constraints_;
  Array<Block> own_;      ///< W_ii
  Array<Entry> entries_;  ///< W_ij, i ≠ j
  Array<std::pair<Index, Index>> pairs_;
  BlockLu<R, double> matrix_;
  Array<Vec<R>> y_;
};

template <class Rows, class T = typename Rows::Scalar>
using PathSystem = std::conditional_t<(Rows::widest > 0), PathBodies<T, std::max(1, Rows::widest)>, PathImpulses<T, std::max(1, Rows::highest)>>;

}  // namespace delassus::inner
