/// The bodies and constraints of one island, and the matrix of a Newton step in the bodies' velocities.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/cmath.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/linear/block_lu.hpp>
#include <delassus/math/small_products.hpp>
#include <delassus/solvers/inner/island_matrices.hpp>
#include <delassus/solvers/island.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace delassus::inner {

/// Asked between the pieces of what is long and no sweep.
template <class T>
struct CutOff {
  const Island<T>* island;  ///< null: never
  bool operator()(Index work) const { return island && island->is_cut_off(int(work)); }
};

/// A constraint of an island in the equations of Newton's method.
template <class T>
struct NewtonConstraint {
  const Span<T>* span;
  Index item;         ///< its number in the pool
  Index first, last;  ///< its sides
  Index at, slope;    ///< where its rows begin among those of the island, and its rows × rows numbers
  int rows;
  Index number;   ///< among the constraints
};

/// Constraints with H and G = A⁻¹ Hᵀ on each block that moves, narrower sets filled up with zeros, and
///
///   J = 1 + G S H,   S = −∂λ/∂u the slopes of the constraints.
///
/// A⁻¹ J is the matrix of the bodies with a stiff spring in every constraint; without A⁻¹ the system matrix A
/// itself is not needed. Everything is double, whatever the rows are. A list `by row` has a number for each row of the island.
template <class T, int width_>
class NewtonSystem {
 public:
  static constexpr int width = width_;
  using Constraint = NewtonConstraint<T>;
  using Velocity = Vec<width>;
  using Velocities = Array<Velocity>;  ///< one a block

  /// Takes the island over with its present λ as λ̂ and best; false where Newton's method cannot act: a
  /// law without a tangent, a set whose A couples blocks, or rows that nothing answers to.
  bool gather(const Island<T>& island) {
    if (!has_tangents(island) || !knows_answers(island)) return false;
    number_blocks(island);
    begin(island, blocks_.size());
    bool is_sound = true;
    for (const Span<T>& span : island)
      for (const Index i : span) is_sound &= !island.is_cut_off(1) && take(span, i);
    return is_sound && finish(island.island());
  }

  std::size_t blocks() const { return unit_.size(); }
  const Array<Constraint>& constraints() const { return constraints_; }

  /// Factors J; false when it is singular to working precision, or the island's time ends before that; null: no time ends.
  bool factor(const Island<T>* island) {
    const CutOff<T> ends{island};
    auto& J = *matrix_;
    J.set_identity(ends);
    for (const Constraint& c : constraints_) {
      if (ends(1)) break;
      if (is_zero(&slope[c.slope], c.rows * c.rows)) continue;
      if (c.rows == 3) add_stiffness(c, 3, J);
      else add_stiffness(c, c.rows, J);
    }
    return J.factor(ends);
  }
  /// What one factorization, with the evaluations that go with it, costs beside a sweep, counted in products
  /// of a 3 × 3 block with a vector: by instructions one of 6 × 6 blocks is 36 of them, and a constraint,
  /// gathered and measured too, 200.
  double cost_in_sweeps() {
    double entries = 0;
    count_.assign(blocks(), 0);
    for (const Side& side : sides_) ++count_[side.block];
    for (const double n : count_) entries += n * n;
    const double of_block = width * width * width / 6.0, constraints = double(constraints_.size());
    return (of_block * matrix_->products() + 200 * constraints) / (entries + 5 * constraints);
  }
  /// Σ w_i P², P = Σ m max|d|, the sum over the bodies: whatever rests on a contact, no more momentum goes
  /// through it when all come to rest, but for what wedges add. m is the largest mass by which a body
  /// answers; at a contact that is rows/tr(H G).
  double energy_of_stopping(const Island<T>& island) {
    double weights = 0, fastest = 0, mass = 0;
    mass_.assign(blocks(), 0.0);
    for (const Constraint& c : constraints_) {
      if (island.is_cut_off(1)) break;
      for (int k = 0; k < c.rows; ++k) weights += square_of_length(island, c, k) * weight[c.at + k] / c.rows;
      fastest = std::max(fastest, island.square_of_velocity(*c.span, Island<T>::free_of_impulses(*c.span, c.item)));
      for (Index s = c.first; s < c.last; ++s) {
        double trace = 0;
        for (int k = 0; k < c.rows; ++k)
          for (int j = 0; j < width; ++j) trace += square_of_length(island, c, k) * H(s)[k + c.rows * j] * G(s)[j + width * k];
        if (trace > 0) mass_[sides_[s].block] = std::max(mass_[sides_[s].block], c.rows / trace);
      }
    }
    for (const double m : mass_) mass += m;
    return weights * mass * mass * fastest;
  }
  bool is_negative() const { return matrix_->is_negative(); }  ///< det J < 0
  /// x ← J⁻¹ x.
  void solve(Velocities& x, const Island<T>* island) const { matrix_->solve(x, CutOff<T>{island}); }

  /// u += Σ H x over the sides of a constraint, and x += Σ s G λ.
  void add_rates(const Constraint& c, const Velocities& x, double* u) const {
    for (Index s = c.first; s < c.last; ++s) {
      const double *y = x[sides_[s].block].data(), *h = H(s);
      if (c.rows == 3) {
        double sum[3] = {u[0], u[1], u[2]};
        add_product(3, width, 1, h, y, sum);
        for (int k = 0; k < 3; ++k) u[k] = sum[k];
      } else {
        add_product(c.rows, width, 1, h, y, u);
      }
    }
  }
  void add_answers(const Constraint& c, const double* impulse, double share, Velocities& x) const {
    for (Index s = c.first; s < c.last; ++s) {
      double* y = x[sides_[s].block].data();
      if (c.rows == 3) add_answer(3, G(s), impulse, share, y);
      else add_answer(c.rows, G(s), impulse, share, y);
    }
  }

  Array<double> weight;            ///< by row: w
  Array<double> compliance;        ///< by row: on W's diagonal, beside H A⁻¹ Hᵀ
  Array<double> best;              ///< by row: λ of the smallest measured error
  Array<double> centre;            ///< by row: λ̂
  Array<double> lambda;            ///< by row: λ(u)
  Array<double> velocity;          ///< by row: u = d + W λ̂ + H y
  Array<double> slope;             ///< S, rows × rows a constraint


 protected:
  struct Side {
    Index block, at;  ///< at: where its H and G begin
  };

  static bool has_tangents(const Island<T>& island) {
    for (const Span<T>& span : island)
      if (!span.pool->tangent) return false;
    return true;
  }

  void begin(const Island<T>& island, std::size_t count) {
    constraints_.clear(), sides_.clear(), pairs_.clear();
    numbers_ = 0;
    for (auto* sums : {&unit_, &moved_}) sums->assign(count, zero<Velocity>());
    for (auto* list : {&weight, &compliance, &best, &centre, &lambda, &velocity}) list->assign(std::size_t(island.row_count()), 0.0);
    std::size_t squares = 0;
    for (const Span<T>& span : island) squares += std::size_t(span.pool->rows * span.pool->rows) * std::size_t(span.count);
    slope.assign(squares, 0.0);
  }
  bool finish(Index island) {
    balance();
    inner::sort(pairs_);
    inner::drop_repeats(pairs_);
    matrix_ = &matrices_.of(island, Index(blocks()), pairs_);
    return true;
  }

  /// The next constraint, without sides yet.
  Constraint& add(const Span<T>& span, Index i) {
    const int R = span.pool->rows;
    Constraint c{&span, i, Index(sides_.size()), Index(sides_.size()), 0, 0, R, Index(constraints_.size())};
    if (!constraints_.empty()) {
      const Constraint& last = constraints_.back();
      c.at = last.at + last.rows;
      c.slope = last.slope + last.rows * last.rows;
    }
    span.pool->weights(i, &weight[c.at]);
    T u[most_rows];
    Island<T>::velocity(span, i, u);
    const T* impulse = Island<T>::impulse(span, i);
    for (int k = 0; k < R; ++k) {
      best[c.at + k] = centre[c.at + k] = lambda[c.at + k] = double(impulse[k]);
      velocity[c.at + k] = double(u[k]);
    }
    return constraints_.emplace_back(c);
  }
  /// Room for another side of the last constraint; its numbers are what they were.
  Side& add_side(int rows, Index block) {
    const Index at = numbers_;
    numbers_ += rows * width;
    for (auto* list : {&H_, &G_})
      if (list->size() < std::size_t(numbers_)) list->resize(2 * std::size_t(numbers_));
    ++constraints_.back().last;
    return sides_.emplace_back(Side{block, at});
  }
  bool is_sound(const Constraint& c) const {
    for (int k = 0; k < c.rows; ++k)
      if (!(weight[c.at + k] > 0 && std::isfinite(weight[c.at + k]))) return false;
    return true;
  }

  const double* H(Index side) const { return &H_[sides_[side].at]; }
  const double* G(Index side) const { return &G_[sides_[side].at]; }
  double* H(Index side) { return &H_[sides_[side].at]; }
  double* G(Index side) { return &G_[sides_[side].at]; }

  /// What a side of a constraint adds to the sums.
  void add_to_balance(Index side, const Constraint& c) {
    double *unit = unit_[sides_[side].block].data(), *moved = moved_[sides_[side].block].data();
    double over[most_rows];
    for (int k = 0; k < c.rows; ++k) over[k] = 1 / weight[c.at + k];
    if (c.rows == 3) add_squares(3, H(side), G(side), over, unit, moved);
    else add_squares(c.rows, H(side), G(side), over, unit, moved);
  }
  static bool is_zero(const double* x, int count) {
    for (int k = 0; k < count; ++k)
      if (x[k] != 0) return false;
    return true;
  }

  Array<Constraint> constraints_;
  Array<Side> sides_;
  Array<double> H_, G_;
  Index numbers_ = 0;  ///< of H_ and of G_ that are in use
  Array<std::pair<Index, Index>> pairs_;  ///< of blocks that a constraint joins

 private:
  // Three rows, the contacts', are written with a constant.
  [[gnu::always_inline]] static void add_squares(int rows, const double* H, const double* G, const double* over, double* unit, double* moved) {
    for (int k = 0; k < width; ++k)
      for (int j = 0; j < rows; ++j) {
        unit[k] += over[j] * H[j + rows * k] * H[j + rows * k];
        moved[k] += over[j] * G[k + width * j] * G[k + width * j];
      }
  }
  /// By which the weight of row k becomes one in 1/kg.
  static double square_of_length(const Island<T>& island, const Constraint& c, int k) {
    return c.span->pool->turn(k) ? island.length() * island.length() : 1;
  }
  [[gnu::always_inline]] static void scale(int rows, const double* of_H, const double* of_G, double* H, double* G) {
    for (int k = 0; k < width; ++k)
      for (int j = 0; j < rows; ++j) H[j + rows * k] *= of_H[k], G[k + width * j] *= of_G[k];
  }
  [[gnu::always_inline]] static void add_answer(int rows, const double* G, const double* impulse, double share, double* y) {
    double sum[width];
    for (int j = 0; j < width; ++j) sum[j] = y[j];
    for (int k = 0; k < rows; ++k) {
      const double by = share * impulse[k];
      for (int j = 0; j < width; ++j) sum[j] += G[width * k + j] * by;
    }
    for (int j = 0; j < width; ++j) y[j] = sum[j];
  }
  /// J += G S H.
  [[gnu::always_inline]] void add_stiffness(const Constraint& c, int rows, BlockLu<width, double>& J) const {
    double SH[most_rows * width];
    for (Index s = c.first; s < c.last; ++s) {
      if (is_zero(H(s), rows * width)) continue;  // of a `WholeSystem` all but one
      for (int k = 0; k < rows * width; ++k) SH[k] = 0;
      add_product(rows, rows, width, &slope[c.slope], H(s), SH);
      for (Index t = c.first; t < c.last; ++t)
        add_product(width, rows, width, G(t), SH, J.at(sides_[t].block, sides_[s].block).data());
    }
  }
  /// Whether each block answers to its impulses alone, by G.
  static bool knows_answers(const Island<T>& island) {
    for (const Span<T>& span : island)
      for (const Index i : span)
        for (int s = 0; s < span.pool->sets; ++s)
          if (span.pool->set[s].has_entries(i) && !span.pool->set[s].G) return false;
    return true;
  }
  /// Whether entry e is on a block that moves: where A⁻¹ = 0, G is zero.
  static bool answers(const SetBlocksView<T>& set, int rows, Index e) {
    const T* G = set.G + std::ptrdiff_t(rows * set.width) * e;
    for (int k = 0; k < rows * set.width; ++k)
      if (G[k] != T(0)) return true;
    return false;
  }

  Index& number(int set, Index block) { return number_[std::size_t(block) * std::size_t(sets_) + std::size_t(set)]; }

  void number_blocks(const Island<T>& island) {
    for (const auto& block : blocks_) number(block.first, block.second) = -1;
    blocks_.clear();
    for (const Span<T>& span : island) {
      sets_ = span.pool->sets;
      for (const Index i : span)
        for (int s = 0; s < sets_; ++s) {
          const SetBlocksView<T>& set = span.pool->set[s];
          for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) {
            if (!answers(set, span.pool->rows, e)) continue;
            const Index b = set.block[e];
            if (const std::size_t room = (std::size_t(b) + 1) * std::size_t(sets_); number_.size() < room) number_.resize(room, -1);
            if (number(s, b) >= 0) continue;
            number(s, b) = 0;
            blocks_.push_back({s, b});
          }
        }
    }
    inner::sort(blocks_);
    for (std::size_t k = 0; k < blocks_.size(); ++k) number(blocks_[k].first, blocks_[k].second) = Index(k);
  }

  bool take(const Span<T>& span, Index i) {
    const PoolView<T>& pool = *span.pool;
    const int R = pool.rows;
    const Constraint c = add(span, i);
    const T* own = pool.own_block(i);
    for (int k = 0; k < R; ++k) {  // W_kk = (H A⁻¹ Hᵀ)_kk (1 + relative_compliance) + compliance
      const std::ptrdiff_t row = std::ptrdiff_t(R) * i + k;
      const double whole = double(own[k * (R + 1)]), relative_compliance = double(pool.relative_compliance[row]);
      compliance[c.at + k] = (whole * relative_compliance + double(pool.compliance[row])) / (1 + relative_compliance);
    }
    for (int s = 0; s < pool.sets; ++s) {
      const SetBlocksView<T>& set = pool.set[s];
      for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e) {
        if (!answers(set, R, e)) continue;
        const Side& side = add_side(R, number(s, set.block[e]));
        copy_side(set, R, e, &H_[side.at], &G_[side.at]);
        const Index last = Index(sides_.size()) - 1;
        for (Index t = c.first; t < last; ++t)
          if (sides_[t].block != side.block)
            pairs_.push_back({std::min(sides_[t].block, side.block), std::max(sides_[t].block, side.block)});
        add_to_balance(last, c);
      }
    }
    return is_sound(c);
  }

  static void copy_side(const SetBlocksView<T>& set, int R, Index e, double* to_H, double* to_G) {
    const T *H = set.H + std::ptrdiff_t(R * set.width) * e, *G = set.G + std::ptrdiff_t(R * set.width) * e;
    if (set.width == width) {
      for (int k = 0; k < R * width; ++k) to_H[k] = double(H[k]), to_G[k] = double(G[k]);
    } else {
      for (int k = 0; k < R * width; ++k) to_H[k] = to_G[k] = 0;
      for (int k = 0; k < set.width; ++k)
        for (int j = 0; j < R; ++j) to_H[j + R * k] = double(H[j + R * k]), to_G[k + width * j] = double(G[k + set.width * j]);
    }
  }

  /// Unknown k of a block in units of 1/√A_kk, A_kk ≈ |H_k|/|G_k| over its rows: of J's entries, which are in
  /// m, 1 and 1/m, the pivots inside a block are then the largest in any unit of length. To a power of two:
  /// that rounds nothing.
  void balance() {
    for (std::size_t b = 0; b < unit_.size(); ++b)
      for (int k = 0; k < width; ++k) {
        const double square = unit_[b][k] / moved_[b][k];  // A_kk²
        const bool is_sound = square > 0 && std::isfinite(square);
        const int power = is_sound ? std::ilogb(square) >> 2 : 0;
        unit_[b][k] = std::ldexp(1.0, power);
        moved_[b][k] = std::ldexp(1.0, -power);
      }
    for (const Constraint& c : constraints_)
      for (Index s = c.first; s < c.last; ++s) {
        const double *unit = unit_[sides_[s].block].data(), *moved = moved_[sides_[s].block].data();
        if (c.rows == 3) scale(3, moved, unit, H(s), G(s));
        else scale(c.rows, moved, unit, H(s), G(s));
      }
  }

  int sets_ = 0;
  Array<Index> number_;                  ///< of a block of a set here, or −1
  Array<std::pair<int, Index>> blocks_;  ///< (set, block), ascending
  IslandMatrices<BlockLu<width, double>> matrices_;
  BlockLu<width, double>* matrix_ = nullptr;
  Array<Index> count_;  ///< of sides on each block
  Array<double> mass_;
  Velocities unit_, moved_;  ///< of each unknown Σ H_k²/w and Σ G_k²/w over the rows, then √A_kk and its inverse
};

}  // namespace delassus::inner
