/// A box of tetrahedra and its A = M + h² K: the matrix of one implicit step of a soft body.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <Eigen/SparseCore>

#include <array>
#include <utility>
#include <vector>

namespace tetrahedral_box {

using namespace delassus;

/// 12 × 12 numbers of a tetrahedron, as 4 × 4 blocks of its nodes.
struct Element {
  std::array<Index, 4> nodes;
  std::array<std::array<Mat3, 4>, 4> A;
};

/// nx × ny × nz nodes 1 cm apart, six tetrahedra a cell; 1000 kg/m³, 10 kPa, Poisson's number 0.3, h = 10 ms.
/// The face z = 0 is held by springs as stiff as the cells.
struct Box {
  Index nx, ny, nz;
  std::vector<Vec3> positions;
  std::vector<Element> elements;
  std::vector<std::pair<Index, Index>> pairs;

  Box(Index x, Index y, Index z) : nx(x), ny(y), nz(z) {
    for (Index k = 0; k < nz; ++k)
      for (Index j = 0; j < ny; ++j)
        for (Index i = 0; i < nx; ++i) positions.push_back(side * Vec3(i, j, k));
    for (Index k = 0; k + 1 < nz; ++k)
      for (Index j = 0; j + 1 < ny; ++j)
        for (Index i = 0; i + 1 < nx; ++i) add_cell(i, j, k);
    for (const Element& e : elements)
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b) pairs.emplace_back(e.nodes[a], e.nodes[b]);
  }

  Index nodes() const { return Index(positions.size()); }
  Index node(Index i, Index j, Index k) const { return i + nx * (j + ny * k); }
  double support(Index node) const { return node < nx * ny ? step * step * young * side : 0; }

  template <class F>
  void fill(F& f) const {
    using Block = typename F::Block;
    f.set_zero();
    for (Index i = 0; i < nodes(); ++i)
      f.add_diagonal(i, Block(typename Block::Scalar(support(i)) * Block::Identity()));
    for (const Element& e : elements)
      for (int a = 0; a < 4; ++a) {
        f.add_diagonal(e.nodes[a], e.A[a][a].template cast<typename Block::Scalar>());
        for (int b = 0; b < a; ++b)
          f.add_pair(e.nodes[a], e.nodes[b], e.A[a][b].template cast<typename Block::Scalar>());
      }
  }

  /// Both triangles.
  void triplets(std::vector<Eigen::Triplet<double>>& to) const {
    to.clear();
    for (const Element& e : elements)
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
              to.emplace_back(3 * e.nodes[a] + r, 3 * e.nodes[b] + c, e.A[a][b](r, c));
    for (Index i = 0; i < 3 * nx * ny; ++i) to.emplace_back(i, i, support(i / 3));
  }
  Eigen::SparseMatrix<double> sparse() const {
    std::vector<Eigen::Triplet<double>> t;
    triplets(t);
    Eigen::SparseMatrix<double> A(3 * nodes(), 3 * nodes());
    A.setFromTriplets(t.begin(), t.end());
    return A;
  }

 private:
  static constexpr double side = 0.01, density = 1000, young = 1e4, poisson = 0.3, step = 0.01;

  /// The six paths from one corner of a cell to the opposite one.
  void add_cell(Index i, Index j, Index k) {
    static constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (const auto& order : orders) {
      std::array<Index, 3> at{i, j, k};
      Element e;
      e.nodes[0] = node(i, j, k);
      for (int a = 0; a < 3; ++a) {
        ++at[order[a]];
        e.nodes[a + 1] = node(at[0], at[1], at[2]);
      }
      make(e);
      elements.push_back(e);
    }
  }

  /// K_ab = V (λ g_a g_bᵀ + μ g_b g_aᵀ + μ (g_a · g_b) 1), g the gradients of the linear shape functions.
  void make(Element& e) const {
    Mat3 D;
    for (int a = 0; a < 3; ++a) D.col(a) = positions[e.nodes[a + 1]] - positions[e.nodes[0]];
    const double volume = std::abs(D.determinant()) / 6;
    const Mat3 inverse = D.inverse();
    std::array<Vec3, 4> g;
    g[0].setZero();
    for (int a = 0; a < 3; ++a) {
      g[a + 1] = inverse.row(a).transpose();
      g[0] -= g[a + 1];
    }
    const double mu = young / (2 * (1 + poisson)),
                 lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        e.A[a][b] = step * step * volume *
                    (lambda * g[a] * g[b].transpose() + mu * g[b] * g[a].transpose() +
                     mu * g[a].dot(g[b]) * Mat3::Identity());
        if (a == b) e.A[a][b] += density * volume / 4 * Mat3::Identity();
      }
  }
};

/// Some 500, 1000, 3000 and 10 000 nodes.
inline Box box_of(Index nodes) {
  switch (nodes) {
    case 500:
      return Box(8, 8, 8);
    case 1000:
      return Box(10, 10, 10);
    case 3000:
      return Box(10, 15, 20);
    default:
      return Box(20, 20, 25);
  }
}

}  // namespace tetrahedral_box
