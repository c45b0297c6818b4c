/// Graphs of node blocks with a known matrix: what factorizations are tried on.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <Eigen/SparseCore>

#include <random>
#include <utility>
#include <vector>

namespace block_graphs {

using namespace delassus;
using Pairs = std::vector<std::pair<Index, Index>>;

/// A graph of nodes in space, and A = Σ over pairs of (e_i − e_j)(e_i − e_j)ᵀ ⊗ K_ij + shift 1: positive for
/// shift > 0.
template <int w>
struct Blocks {
  Index n = 0;
  Pairs pairs;
  std::vector<Vec3> positions;
  std::vector<Mat<w, w>> K;
  double shift = 1;

  void draw(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> draw(-1, 1);
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Mat<w, w> B = Mat<w, w>::NullaryExpr([&] { return draw(random); });
      K.push_back(B * B.transpose());
    }
  }
  template <class F>
  void fill(F& f) const {
    using Block = typename F::Block;
    f.set_zero();
    for (Index i = 0; i < n; ++i) f.add_diagonal(i, shift * Block::Identity());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Block B = K[k].template cast<typename Block::Scalar>();
      f.add_diagonal(pairs[k].first, B);
      f.add_diagonal(pairs[k].second, B);
      f.add_pair(pairs[k].first, pairs[k].second, -B);
    }
  }
  Eigen::SparseMatrix<double> sparse() const {
    std::vector<Eigen::Triplet<double>> t;
    const auto add = [&](Index i, Index j, const Mat<w, w>& B) {
      for (int r = 0; r < w; ++r)
        for (int c = 0; c < w; ++c) t.emplace_back(w * i + r, w * j + c, B(r, c));
    };
    for (Index i = 0; i < n; ++i) add(i, i, shift * Mat<w, w>::Identity());
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const auto [i, j] = pairs[k];
      add(i, i, K[k]), add(j, j, K[k]), add(i, j, -K[k]), add(j, i, -K[k].transpose());
    }
    Eigen::SparseMatrix<double> A(w * n, w * n);
    A.setFromTriplets(t.begin(), t.end());
    return A;
  }
};

/// nx × ny × nz nodes, each with its neighbours along the axes and the diagonals of a Kuhn mesh.
template <int w>
Blocks<w> grid(Index nx, Index ny, Index nz, unsigned seed) {
  Blocks<w> g;
  g.n = nx * ny * nz;
  for (Index k = 0; k < nz; ++k)
    for (Index j = 0; j < ny; ++j)
      for (Index i = 0; i < nx; ++i) {
        g.positions.push_back(Vec3(i, j, k));
        for (int d = 1; d < 8; ++d) {
          const Index a = i + d % 2, b = j + d / 2 % 2, c = k + d / 4;
          if (a < nx && b < ny && c < nz) g.pairs.emplace_back(i + nx * (j + ny * k), a + nx * (b + ny * c));
        }
      }
  g.draw(seed);
  return g;
}

/// The joints of n × n bodies in a square net, along and then down from each; joints meet where they share a
/// body.
struct Net {
  Index joints() const { return Index(positions.size()); }
  Pairs pairs = {};
  std::vector<Vec3> positions = {};

  explicit Net(Index n) {
    std::vector<std::vector<Index>> of(n * n);  // the joints of each body
    for (Index i = 0; i < n; ++i)
      for (Index k = 0; k < n; ++k)
        for (const auto& [di, dk] : {std::pair<Index, Index>(0, 1), {1, 0}}) {
          if (i + di >= n || k + dk >= n) continue;
          of[i * n + k].push_back(Index(positions.size()));
          of[(i + di) * n + k + dk].push_back(Index(positions.size()));
          positions.push_back(Vec3(k + 0.5 * dk, i + 0.5 * di, 0));
        }
    for (const auto& body : of)
      for (const Index a : body)
        for (const Index b : body)
          if (a < b) pairs.emplace_back(a, b);
  }
};

}  // namespace block_graphs
