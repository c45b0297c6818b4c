// Frictionless rows alone are a linear complementarity problem, 0 ≤ λ ⟂ W λ + d ≥ 0, for which Lemke's method
// is an answer that shares nothing with sweeps.
#include <delassus/compliance/assembled.hpp>
#include <delassus/constraints/constraints.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/problem.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace linear_complementarity_tests {

using namespace delassus;

namespace {

/// A bound on a row that somebody else has linearised.
struct GivenBound : Frictionless {
  static constexpr bool is_contact = true;
  static constexpr auto refines = refine::natural_map | refine::clamp;
  struct Item {
    Parameters parameters{};
  };
  template <class T>
  Vec<1, T> solve_local(const Item& item, const Mat<1, 1, T>& W, const Vec<1, T>& b) const {
    return Frictionless::solve_local(item.parameters, W, b);
  }
  template <class T>
  Vec<1, T> natural_map(const Item& item, const Vec<1, T>& lambda, const Vec<1, T>& u, T scale) const {
    return Frictionless::natural_map(item.parameters, lambda, u, scale);
  }
  template <class T>
  void clamp(const Item& item, Vec<1, T>& lambda) const {
    Frictionless::clamp(item.parameters, lambda);
  }
};

using Numbers = std::vector<double>;

/// Row-major n × n.
struct Square {
  int n = 0;
  Numbers a;
  explicit Square(int size) : n(size), a(std::size_t(size) * std::size_t(size), 0.0) {}
  double& operator()(int i, int j) { return a[std::size_t(i) * std::size_t(n) + std::size_t(j)]; }
  double operator()(int i, int j) const { return a[std::size_t(i) * std::size_t(n) + std::size_t(j)]; }
};

/// Lemke's pivots on w = M z + q + z₀ 1: z₀ enters, and leaves at the solution. Every positive definite M has
/// one. Source: [CottleEtAl2009], algorithm 4.4.5.
Numbers lemke(const Square& M, const Numbers& q) {
  const int n = M.n, width = 2 * n + 2;  // columns: w, z, z₀, right side
  std::vector<long double> t(std::size_t(n) * std::size_t(width), 0.0L);
  const auto at = [&](int i, int j) -> long double& {
    return t[std::size_t(i) * std::size_t(width) + std::size_t(j)];
  };
  std::vector<int> basis;
  for (int i = 0; i < n; ++i) {
    at(i, i) = 1;
    for (int j = 0; j < n; ++j) at(i, n + j) = -(long double)(M(i, j));
    at(i, 2 * n) = -1;
    at(i, 2 * n + 1) = (long double)(q[std::size_t(i)]);
    basis.push_back(i);
  }
  const auto pivot = [&](int row, int column) {
    const long double over = 1 / at(row, column);
    for (int j = 0; j < width; ++j) at(row, j) *= over;
    for (int i = 0; i < n; ++i) {
      const long double share = at(i, column);
      if (i == row || share == 0) continue;
      for (int j = 0; j < width; ++j) at(i, j) -= share * at(row, j);
    }
    const int left = basis[std::size_t(row)];
    basis[std::size_t(row)] = column;
    return left;
  };
  int row = 0;
  for (int i = 1; i < n; ++i)
    if (at(i, 2 * n + 1) < at(row, 2 * n + 1)) row = i;
  if (at(row, 2 * n + 1) < 0) {
    int left = pivot(row, 2 * n);
    while (left != 2 * n) {
      const int enters = left < n ? left + n : left - n;
      row = -1;
      for (int i = 0; i < n; ++i)
        if (at(i, enters) > 0 &&
            (row < 0 || at(i, 2 * n + 1) * at(row, enters) < at(row, 2 * n + 1) * at(i, enters)))
          row = i;
      REQUIRE(row >= 0);
      left = pivot(row, enters);
    }
  }
  Numbers z(std::size_t(n), 0.0);
  for (int i = 0; i < n; ++i)
    if (basis[std::size_t(i)] >= n && basis[std::size_t(i)] < 2 * n)
      z[std::size_t(basis[std::size_t(i)] - n)] = double(at(i, 2 * n + 1));
  return z;
}

/// Positive definite: eigenvalues from 1 down to 1/`inner_condition` under n random reflections, then D A D
/// with D from 1 to 1/√`scales`: masses that differ.
Square random_matrix(std::mt19937& random, int n, double inner_condition, double scales) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0, 1);
  Square A(n);
  for (int i = 0; i < n; ++i) A(i, i) = std::pow(inner_condition, -double(i) / std::max(n - 1, 1));
  for (int k = 0; k < 4; ++k) {
    Numbers v(std::size_t(n), 0.0), Av(std::size_t(n), 0.0);
    double size = 0, vAv = 0;
    for (double& x : v) {
      x = normal(random);
      size += x * x;
    }
    for (double& x : v) x /= std::sqrt(size);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) Av[std::size_t(i)] += A(i, j) * v[std::size_t(j)];
    for (int i = 0; i < n; ++i) vAv += v[std::size_t(i)] * Av[std::size_t(i)];
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        A(i, j) += -2 * v[std::size_t(i)] * Av[std::size_t(j)] - 2 * Av[std::size_t(i)] * v[std::size_t(j)] +
                   4 * vAv * v[std::size_t(i)] * v[std::size_t(j)];
  }
  Numbers D;
  for (int i = 0; i < n; ++i) D.push_back(std::pow(scales, -0.5 * uniform(random)));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j)
      A(i, j) = A(j, i) = 0.5 * (A(i, j) + A(j, i)) * D[std::size_t(i)] * D[std::size_t(j)];
  for (int i = 0; i < n; ++i) A(i, i) *= D[std::size_t(i)] * D[std::size_t(i)];
  return A;
}

using Rows = RowSystem<double, Widths<>, 1>;
using Bounds = Problem<Constraints<GivenBound>, Rows, AssembledCompliance::Operator<Rows>>;

Bounds make_bounds(const Square& M, const Numbers& q) {
  Bounds p;
  auto& pool = p.rows.pool<0>();
  pool.reset(M.n);
  for (int i = 0; i < M.n; ++i) {
    pool.d[i][0] = q[std::size_t(i)];
    p.laws.pool<0>().items.push_back({});
  }
  p.W.resize_like(p.rows);
  const auto W = p.W.blocks<0, 0>();
  for (int i = 0; i < M.n; ++i) {
    p.W.diagonal<0>(i)(0, 0) = M(i, i);
    for (int j = 0; j < M.n; ++j) {
      if (j == i) continue;
      W.column.push_back(j);
      W.block.push_back(Mat<1, 1>(M(i, j)));
    }
    W.start[i + 1] = Index(W.column.size());
  }
  p.islands.take_all(ArraysOf(p.rows).all());
  return p;
}

}  // namespace

// The solution is where F(λ) = 0, and |λ − λ*| ≤ κ |F| up to a small factor, κ the condition once the
// diagonal is scaled away, which sweeps do not see. Sweeps end at |F| = 8 ε: 10⁵ times that is 2e-10.
TEST_CASE(
    "frictionless rows are solved to 1e-9 like Lemke's method does, up to a condition of 1e12 by their "
    "masses") {
  struct Case {
    int n;
    double condition, scales;
  };
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const Case c :
       {Case{10, 1e2, 1}, {10, 1e5, 1e7}, {60, 1e2, 1e7}, {60, 1e5, 1}, {200, 1e2, 1}, {200, 1e5, 1e7}}) {
    const Square M = random_matrix(random, c.n, c.condition, c.scales);
    Numbers q;
    for (int i = 0; i < c.n; ++i) q.push_back(normal(random) * std::sqrt(M(i, i)));
    const Numbers z = lemke(M, q);
    Bounds p = make_bounds(M, q);
    const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-14, .max_iterations = 100000});
    REQUIRE(r.status != Status::max_iterations);  // converged, or at the floor of rounding
    double worst = 0, largest = 0, active = 0;
    for (int i = 0; i < c.n; ++i) {
      const double root = std::sqrt(M(i, i)), lambda = p.rows.pool<0>().lambda[i][0];
      worst = std::max(worst, root * std::abs(lambda - z[std::size_t(i)]));
      largest = std::max(largest, root * z[std::size_t(i)]);
      active += z[std::size_t(i)] > 0;
    }
    REQUIRE(largest > 0.1);
    REQUIRE(active < c.n);
    REQUIRE(worst <= 1e-9 * largest);
  }
}

TEST_CASE("where sweeps do not get there the status says so") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Square M = random_matrix(random, 60, 1e12, 1);
  Numbers q;
  for (int i = 0; i < M.n; ++i) q.push_back(normal(random));
  Bounds p = make_bounds(M, q);
  const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-9, .max_iterations = 1000});
  REQUIRE(r.status == Status::max_iterations);
  REQUIRE(r.measure.residual > 1e-9);
}

}  // namespace linear_complementarity_tests
