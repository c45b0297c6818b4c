/// The bodies and constraints of one island, and the matrix of a Newton step in the bodies' velocities.
#pragma once

#include <delassus/core/array.hpp>
#include <delassus/core/sort.hpp>
#include <delassus/linear/block_lu.hpp>
#include <delassus/math/small_products.hpp>
#include <delassus/rows/local.hpp>
#include <delassus/rows/row_system.hpp>
#include <delassus/solvers/inner/island_matrices.hpp>
#include <delassus/solvers/inner/newton_item.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace delassus::inner {

template <template <int> class Item, class Rows>
class NewtonSystem;

/// One `Item<R>` a constraint, with its H and G on each block that moves, and
///
///   J = 1 + G S H,   S = −∂λ/∂u the `slope` of the items.
///
/// A⁻¹ J is the matrix of the bodies with a stiff spring in every constraint; without A⁻¹ the system matrix A
/// itself is not needed.
template <template <int> class Item, class T, int... w, int... R>
class NewtonSystem<Item, RowSystem<T, Widths<w...>, R...>> {
 public:
  using Rows = RowSystem<T, Widths<w...>, R...>;
  static constexpr int pools = Rows::pool_count;
  static constexpr int width = std::max({1, w...});
  using Velocities = Array<Vec<width>>;  ///< one a block, narrower sets filled up with zeros
  using Never = typename BlockLu<width, double>::Never;

  /// Takes the island over with its present λ as λ̂ and best; false where Newton's method cannot act: a
  /// law without a tangent, a set whose A couples blocks, or rows that nothing answers to.
  bool gather(auto& problem) {
    static_assert(sizeof...(w) > 0,
                  "delassus: Newton's method needs the bodies of a problem, and this one, as a "
                  "FrictionProblem, has W alone; "
                  "solve it by AcceleratedGaussSeidel");
    if (!has_tangents(problem) || !knows_answers(problem)) return false;
    number_blocks(problem);
    begin(blocks_.size());
    bool is_sound = true;
    problem.each([&](auto p, Index i) { is_sound &= !problem.is_cut_off(1) && take<p>(problem, i); });
    return is_sound && finish(problem.island());
  }

  std::size_t blocks() const { return unit_.size(); }

  /// f(p, item, sides of pool p) for every constraint.
  void each(auto&& f) {
    for_each_index<pools>([&](auto p) {
      for (auto& c : std::get<p>(items_)) f(p, c, std::get<p>(sides_));
    });
  }

  /// The same until `ends(n)`, asked after the work of n products of blocks of bodies, says so.
  void each_until(auto&& ends, auto&& f) {
    for_each_index<pools>([&](auto p) {
      for (auto& c : std::get<p>(items_)) {
        if (ends(1)) return;
        f(p, c, std::get<p>(sides_));
      }
    });
  }

  /// Factors J; false when it is singular to working precision, or it ends before that.
  template <class Ends = Never>
  bool factor(Ends&& ends = {}) {
    auto& J = *matrix_;
    J.set_identity(ends);
    each_until(ends, [&](auto, auto& c, auto& sides) {
      if (is_zero(c.slope)) return;
      for (Index s = c.first; s < c.last; ++s) {
        if (is_zero(sides[s].H)) continue;  // of a `WholeSystem` all but one
        auto SH = zero<std::remove_cvref_t<decltype(sides[s].H)>>();
        add_product(c.slope, sides[s].H, SH);
        for (Index t = c.first; t < c.last; ++t)
          add_product(sides[t].G, SH, J.at(sides[t].block, sides[s].block));
      }
    });
    return J.factor(ends);
  }
  /// What one factorization, with the evaluations that go with it, costs beside a sweep, counted in products
  /// of a 3 × 3 block with a vector: by instructions one of 6 × 6 blocks is 36 of them, and a constraint,
  /// gathered and measured too, 200.
  double cost_in_sweeps() {
    double constraints = 0, entries = 0;
    Array<Index>& on_block = count_;
    on_block.assign(blocks(), 0);
    each([&](auto, auto& c, auto& sides) {
      for (Index s = c.first; s < c.last; ++s) ++on_block[sides[s].block];
      ++constraints;
    });
    for (const double n : on_block) entries += n * n;
    const double of_block = width * width * width / 6.0;
    return (of_block * matrix_->products() + 200 * constraints) / (entries + 5 * constraints);
  }
  /// Σ w_i P², P = Σ m max|d|, the sum over the bodies: whatever rests on a contact, no more momentum goes
  /// through it when all come to rest, but for what wedges add. m is the largest mass by which a body
  /// answers; at a contact that is rows/tr(H G).
  double energy_of_stopping(auto& problem) {
    double weights = 0, fastest = 0, mass = 0;
    mass_.assign(blocks(), 0.0);
    const auto ends = [&](int work) { return problem.is_cut_off(work); };
    each_until(ends, [&](auto p, auto& c, auto& sides) {
      constexpr int r = Rows::template rows_of<p>;
      weights += c.weight;
      fastest = std::max(fastest, double(squared_norm(problem.rows().template pool<p>().d[c.item])));
      for (Index s = c.first; s < c.last; ++s) {
        double trace = 0;
        for (int k = 0; k < r; ++k)
          for (int j = 0; j < width; ++j) trace += sides[s].H(k, j) * sides[s].G(j, k);
        if (trace > 0) mass_[sides[s].block] = std::max(mass_[sides[s].block], r / trace);
      }
    });
    for (const double m : mass_) mass += m;
    return weights * mass * mass * fastest;
  }
  bool is_negative() const { return matrix_->is_negative(); }  ///< det J < 0
  /// x ← J⁻¹ x.
  template <class Ends = Never>
  void solve(Velocities& x, Ends&& ends = {}) const {
    matrix_->solve(x, ends);
  }

 protected:
  template <class Problem>
  static bool has_tangents(const Problem& problem) {
    bool has = true;
    problem.each([&](auto p, Index) {
      if (!has_tangent<typename Problem::BookType, p, Rows::template rows_of<p>>) has = false;
    });
    return has;
  }

  void begin(std::size_t blocks) {
    for_each_index<pools>([&](auto p) { std::get<p>(items_).clear(), std::get<p>(sides_).clear(); });
    pairs_.clear();
    for (auto* sums : {&unit_, &moved_}) sums->assign(blocks, zero<Vec<width>>());
  }
  bool finish(Index island) {
    balance();
    inner::sort(pairs_);
    inner::drop_repeats(pairs_);
    matrix_ = &matrices_.of(island, Index(blocks()), pairs_);
    return true;
  }

  template <int r>
  static Item<r> item_of(const Local<r, T>& local, Index item, Index first) {
    Item<r> c{};
    c.item = item;
    c.first = first;
    c.weight = double(trace(local.W)) / r;
    c.best = c.centre = c.lambda = local.lambda.template cast<double>();
    c.velocity = local.d.template cast<double>();
    for (Vec<r>* x : {&c.compliance, &c.error, &c.move}) set_all(*x, 0.0);
    return c;
  }
  /// Whether it has a weight.
  template <int r>
  static bool add(Item<r>& c, Array<Item<r>>& items, Index last) {
    c.last = last;
    items.push_back(c);
    return c.weight > 0 && std::isfinite(c.weight);
  }
  /// What `side` of a constraint with 1/w = `over` adds to the sums.
  template <int r>
  void add_to_balance(const NewtonSide<r, width>& side, double over) {
    const auto b = std::size_t(side.block);
    for (int k = 0; k < width; ++k) {
      double unit = 0, moved = 0;
      for (int j = 0; j < r; ++j) unit += side.H(j, k) * side.H(j, k), moved += side.G(k, j) * side.G(k, j);
      unit_[b][k] += over * unit;
      moved_[b][k] += over * moved;
    }
  }

  std::tuple<Array<Item<R>>...> items_;
  std::tuple<Array<NewtonSide<R, width>>...> sides_;
  Array<std::pair<Index, Index>> pairs_;  ///< of blocks that a constraint joins

 private:
  /// Whether each block answers to its impulses alone, by G.
  static bool knows_answers(const auto& problem) {
    bool knows = true;
    problem.each([&](auto p, Index i) {
      const auto& pool = problem.rows().template pool<p>();
      for_each_index<Rows::set_count>([&](auto s) {
        const auto& set = std::get<s>(pool.sets);
        if (set.offset[i + 1] > set.offset[i] && set.G.size() != set.H.size()) knows = false;
      });
    });
    return knows;
  }

  /// f(s, e) for every entry of item i on a block that moves: where A⁻¹ = 0, G is zero.
  static void each_side(const auto& pool, Index i, auto&& f) {
    for_each_index<Rows::set_count>([&](auto s) {
      const auto& set = std::get<s>(pool.sets);
      for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e)
        if (!is_zero(set.G[e])) f(s, e);
    });
  }

  void number_blocks(const auto& problem) {
    for (const auto& [s, b] : blocks_) number_[s][b] = -1;
    blocks_.clear();
    problem.each([&](auto p, Index i) {
      const auto& pool = problem.rows().template pool<p>();
      each_side(pool, i, [&](auto s, Index e) {
        const Index b = std::get<s>(pool.sets).block[e];
        auto& number = number_[s];
        if (Index(number.size()) <= b) number.resize(b + 1, -1);
        if (number[b] >= 0) return;
        number[b] = 0;
        blocks_.emplace_back(s, b);
      });
    });
    inner::sort(blocks_);
    for (std::size_t k = 0; k < blocks_.size(); ++k) number_[blocks_[k].first][blocks_[k].second] = Index(k);
  }

  template <int p, class Problem>
  bool take(const Problem& problem, Index i) {
    constexpr int r = Rows::template rows_of<p>;
    const auto& pool = problem.rows().template pool<p>();
    const Local<r, T> local = problem.template local<p>(i);
    auto& sides = std::get<p>(sides_);
    Item<r> c = item_of(local, i, Index(sides.size()));
    for (int k = 0; k < r; ++k) {  // W_kk = (H A⁻¹ Hᵀ)_kk (1 + relative_compliance) + compliance
      const double whole = double(local.W(k, k)), relative_compliance = double(pool.relative_compliance[i][k]);
      c.compliance[k] = (whole * relative_compliance + double(pool.compliance[i][k])) / (1 + relative_compliance);
    }
    each_side(pool, i, [&](auto s, Index e) {
      const auto& set = std::get<s>(pool.sets);
      constexpr int narrow = Rows::template width_of<s>;
      NewtonSide<r, width> side{number_[s][set.block[e]], zero<Mat<r, width>>(), zero<Mat<width, r>>()};
      for (int k = 0; k < narrow; ++k)
        for (int j = 0; j < r; ++j) side.H(j, k) = double(set.H[e](j, k)), side.G(k, j) = double(set.G[e](k, j));
      for (Index t = c.first; t < Index(sides.size()); ++t)
        if (sides[t].block != side.block) pairs_.push_back(std::minmax({sides[t].block, side.block}));
      add_to_balance(side, 1 / c.weight);
      sides.push_back(side);
    });
    return add(c, std::get<p>(items_), Index(sides.size()));
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
    for_each_index<pools>([&](auto p) {
      for (auto& side : std::get<p>(sides_)) {
        const auto b = std::size_t(side.block);
        for (int k = 0; k < width; ++k)
          for (int j = 0; j < Rows::template rows_of<p>; ++j) side.H(j, k) *= moved_[b][k], side.G(k, j) *= unit_[b][k];
      }
    });
  }

  std::array<Array<Index>, sizeof...(w)> number_;  ///< of a block of a set here, or −1
  Array<std::pair<int, Index>> blocks_;            ///< (set, block), ascending
  IslandMatrices<BlockLu<width, double>> matrices_;
  BlockLu<width, double>* matrix_ = nullptr;
  Array<Index> count_;  ///< of sides on each block
  Array<double> mass_;
  Velocities unit_, moved_;  ///< of each unknown Σ |H_k|²/w and Σ |G_k|²/w, then √A_kk and its inverse
};

}  // namespace delassus::inner
