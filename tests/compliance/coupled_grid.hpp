/// Bodies that are grids of nodes with a known A, and rows that hold them: the least that a builder of W asks
/// for.
#pragma once

#include <delassus/linear/multifrontal_cholesky.hpp>
#include <delassus/rows/row_system.hpp>

#include <random>
#include <span>
#include <vector>

#include "linear/block_graphs.hpp"

namespace coupled_grid {

using namespace delassus;

/// Some grids of 3 numbers a node, one after the other; each has its A, factored by itself.
struct Grids {
  using Scalar = double;
  using Velocity = Vec3;
  static constexpr int width = 3;

  std::vector<block_graphs::Blocks<3>> graph;
  std::vector<MultifrontalCholesky<3, double>> factor;
  std::vector<Index> first{0};

  void add(block_graphs::Blocks<3> g) {
    factor.emplace_back();
    factor.back().analyse(g.n, g.pairs, g.positions);
    g.fill(factor.back());
    factor.back().factor();
    first.push_back(first.back() + g.n);
    graph.push_back(std::move(g));
  }

  Index blocks() const { return first.back(); }
  bool moves(Index) const { return true; }
  bool is_coupled() const { return true; }
  Index body_of(Index block) const {
    return Index(std::upper_bound(first.begin(), first.end(), block) - first.begin()) - 1;
  }
  void solve(std::span<Velocity> x) const {
    for (std::size_t k = 0; k < factor.size(); ++k) {
      Array<Velocity> part(x.begin() + first[k], x.begin() + first[k + 1]);
      factor[k].solve(part);
      std::copy(part.begin(), part.end(), x.begin() + first[k]);
    }
  }
  /// Only for sets that are not coupled.
  template <int C>
  Mat<3, C, double> solve_block(Index, const Mat<3, C, double>& x) const {
    return x;
  }
};

/// The same with the compliance of nodes.
struct CompliantGrids : Grids {
  void node_compliance(std::span<const Index> nodes, std::span<double> C) const {
    const Index body = body_of(nodes[0]);
    own_.assign(nodes.begin(), nodes.end());
    for (Index& i : own_) i -= first[body];
    factor[body].compliance(own_, C);
  }

 private:
  mutable std::vector<Index> own_;
};

/// A world of one set.
template <class Set>
struct Alone {
  Set set;
  template <class F>
  void each(F&& f) const {
    f(set, std::integral_constant<int, 0>{});
  }
};

/// An item that acts on some nodes, its H drawn.
template <class Pool>
void add_item(Pool& pool, std::span<const Index> nodes, std::mt19937& random) {
  std::uniform_real_distribution<double> draw(-1, 1);
  auto& blocks = inner::part<0>(pool.sets);
  for (const Index node : nodes) {
    blocks.block.push_back(node);
    blocks.H.emplace_back().setZero();
    for (int k = 0; k < int(blocks.H.back().size()); ++k) blocks.H.back().data()[k] = draw(random);
  }
  pool.close();
}

}  // namespace coupled_grid
