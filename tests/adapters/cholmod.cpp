#include <delassus/adapters/cholmod.hpp>
#include <delassus/linear/multifrontal_cholesky.hpp>

#include "catch.hpp"
#include "linear/block_graphs.hpp"

#include <cmath>
#include <limits>

using namespace delassus;

// cond A < 200 (block_graphs.hpp) and |A⁻¹| ≤ 1: both are right to 200 ε times some tens.
TEST_CASE("CHOLMOD and our factor give the same solution and the same compliance of nodes") {
  const auto grid = block_graphs::grid<3>(5, 4, 6, 11);
  CholmodFactor<3> theirs;
  MultifrontalCholesky<3, double> ours;
  theirs.analyse(grid.n, grid.pairs);
  ours.analyse(grid.n, grid.pairs, grid.positions);
  for (int n = 0; n < 2; ++n) {  // the pattern serves again
    grid.fill(theirs), grid.fill(ours);
    REQUIRE(theirs.factor());
    REQUIRE(ours.factor());
  }
  std::vector<Vec3> x;
  for (Index i = 0; i < grid.n; ++i) x.push_back(Vec3(std::sin(i), std::cos(3 * i), 1));
  auto y = x;
  theirs.solve(x);
  ours.solve(y);
  for (Index i = 0; i < grid.n; ++i) CHECK((x[i] - y[i]).norm() < 1e-11);
  CHECK(x[0].norm() > 1e-3);

  const std::vector<Index> nodes{7, 100, 3, 55};
  std::vector<double> C(144), D(144);
  theirs.compliance(nodes, C);
  ours.compliance(nodes, D);
  for (int k = 0; k < 144; ++k) CHECK(std::abs(C[k] - D[k]) < 1e-11);
}

TEST_CASE("CHOLMOD says that a matrix is not positive definite, and does not solve with it") {
  const std::vector<std::pair<Index, Index>> pairs{{0, 1}};
  CholmodFactor<3> f;
  f.analyse(2, pairs);
  f.set_zero();
  f.add_diagonal(0, Mat3::Identity());
  f.add_diagonal(1, -Mat3::Identity().eval());
  CHECK_FALSE(f.factor());
  std::vector<Vec3> x(2, Vec3::Ones());
  CHECK_THROWS_WITH(f.solve(x), Catch::Contains("there is no factor"));
}

TEST_CASE(
    "CHOLMOD takes what is not finite for no matrix, goes on afterwards, and answers nothing to nothing") {
  const std::vector<std::pair<Index, Index>> pairs{{0, 1}};
  CholmodFactor<3> f;
  CHECK_FALSE(f.factor());  // there is no pattern
  f.analyse(2, pairs);
  const auto fill = [&](double last) {
    f.set_zero();
    f.add_diagonal(0, 4 * Mat3::Identity());
    f.add_diagonal(1, last * Mat3::Identity());
  };
  std::vector<Vec3> x(2, Vec3::Ones());
  for (const double last :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    fill(last);
    CHECK_FALSE(f.factor());
    CHECK_THROWS_WITH(f.solve(x), Catch::Contains("there is no factor"));
  }
  fill(16);  // squares of powers of two: no rounding
  REQUIRE(f.factor());
  f.solve(x);
  CHECK(x[0] == Vec3::Constant(0.25));
  CHECK(x[1] == Vec3::Constant(0.0625));
  std::vector<double> none;
  f.compliance({}, none);
  f.analyse(0, {});
  CHECK(f.factor());
  x.clear();
  f.solve(x);
}
