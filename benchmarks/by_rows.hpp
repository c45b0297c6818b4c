/// W by the algorithm of the component that is modelled: every row of H forward through all columns of an
/// LDLᵀ factor (Eigen's, minimum degree), then a dot product a pair of rows.
#pragma once

#include <delassus/core/index.hpp>
#include <delassus/math/linear.hpp>

#include <Eigen/SparseCholesky>

#include "against.hpp"

#include <tuple>
#include <vector>

using Sparse = Eigen::SparseMatrix<double>;
using Ldlt = Eigen::SimplicialLDLT<Sparse>;

/// L by rows, unit diagonal left out; H dense, a row of it a column here.
struct ByRows {
  using Index = delassus::Index;
  Sparse A;
  Ldlt ldlt;
  Eigen::SparseMatrix<double, Eigen::RowMajor> L;
  Eigen::VectorXd D, x;
  Eigen::MatrixXd H, Y, scaled, W;

  ByRows(const Sparse& matrix, Index rows) : A(matrix) {
    ldlt.analyzePattern(A);
    factor();
    H = Eigen::MatrixXd::Zero(A.rows(), rows);
    Y = H, scaled = H;
    W.resize(rows, rows);
    x = Eigen::VectorXd::Ones(A.rows());
  }

  void factor() {
    ldlt.factorize(A);
    D = ldlt.vectorD();
    L = ldlt.matrixL().nestedExpression().triangularView<Eigen::StrictlyLower>();
  }
  void solve() { x = ldlt.solve(x).eval(); }
  /// Of a step: factor, W, the solve of the free motion and that of the corrective one.
  double step_seconds() {
    const double factored = against::seconds([&] { factor(); }), built = against::seconds([&] { build(); });
    return factored + built + 2 * against::seconds([&] { solve(); });
  }

  /// The rows of a pool from row `first` on, as they act on set s.
  template <int s>
  void enter(const auto& pool, Index first) {
    const auto& blocks = delassus::inner::part<s>(pool.sets);
    for (Index i = 0; i < pool.items(); ++i)
      for (Index e = blocks.offset[i]; e < blocks.offset[i + 1]; ++e)
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < blocks.H[e].rows(); ++r)
            H(ldlt.permutationP().indices()[3 * blocks.block[e] + c],
              first + int(blocks.H[e].rows()) * i + r) += blocks.H[e](r, c);
  }

  void build() {
    const Index m = Index(H.cols()), n = Index(H.rows());
    const auto* start = L.outerIndexPtr();
    const auto* column = L.innerIndexPtr();
    const double* value = L.valuePtr();
    for (Index r = 0; r < m; ++r) {
      const double* b = &H(0, r);
      double *y = &Y(0, r), *z = &scaled(0, r);
      for (Index i = 0; i < n; ++i) {
        double sum = b[i];
        for (auto e = start[i]; e < start[i + 1]; ++e) sum -= value[e] * y[column[e]];
        y[i] = sum;
      }
      for (Index i = 0; i < n; ++i) z[i] = y[i] / D[i];
    }
    for (Index j = 0; j < m; ++j)
      for (Index i = j; i < m; ++i) W(i, j) = W(j, i) = scaled.col(j).dot(Y.col(i));
  }
};

/// The A of a soft body, as it enters it.
struct SparseOfBody {
  using Block = delassus::Mat3;
  std::vector<Eigen::Triplet<double>> triplets;
  Sparse A;

  explicit SparseOfBody(const auto& body) {
    body.enter(*this);
    const Eigen::Index n = 3 * Eigen::Index(body.blocks().size());
    A.resize(n, n);
    A.setFromTriplets(triplets.begin(), triplets.end());
  }
  void set_zero() { triplets.clear(); }
  void add_diagonal(delassus::Index i, const Block& b) { put(i, i, b); }
  void add_pair(delassus::Index i, delassus::Index j, const Block& b) {
    put(i, j, b), put(j, i, b.transpose());
  }

 private:
  void put(delassus::Index i, delassus::Index j, const Block& b) {
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) triplets.emplace_back(3 * i + r, 3 * j + c, b(r, c));
  }
};
