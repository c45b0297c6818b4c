#include <delassus/math/linear.hpp>
#include <delassus/solvers/inner/anderson.hpp>

#include "catch.hpp"

namespace anderson_tests {

using namespace delassus;

namespace {

/// x ← A x + b on four numbers: a sweep without laws.
struct Linear {
  Mat<4, 4> A = Mat<4, 4>::Zero();
  Vec<4> b{1, -2, 3, 0.5}, x = Vec<4>::Zero();

  int row_count() const { return 4; }
  void gather(Array<double>& to) const { to.assign(x.data(), x.data() + 4); }
  void scatter(std::span<const double> from) { x = Eigen::Map<const Vec<4>>(from.data()); }
  double error() const { return (A * x + b - x).norm(); }
  /// Returns how far it moved.
  double sweep(const SweepRule&) {
    const Vec<4> z = A * x + b, change = z - x;
    x = z;
    return change.squaredNorm();
  }
};

/// Goes on until the sweeps are used up or the error is small.
struct Count {
  const Linear& problem;
  int limit, sweeps = 0;
  bool goes_on(double) { return ++sweeps < limit && problem.error() > 1e-9; }
};

Linear slow() {
  Linear p;
  p.A.diagonal() << 0.9, 0.95, -0.5, 0.97;
  p.A(0, 3) = 0.3;
  return p;
}

}  // namespace

// On a linear map of n numbers mixing n changes is GMRES, which ends after n + 1 steps in exact arithmetic [WalkerNi2011]; the
// regularisation of 1e-10 and rounding leave a few more. Plain sweeps need 700: 0.97^k = 1e-9.
TEST_CASE("mixing ends a slow linear iteration of four numbers in a few sweeps") {
  Linear p = slow();
  p.x = Vec<4>(5, -30, 1, 10);  // the solution is less than ten times as large
  Count count{p, 100};
  inner::History history;
  inner::anderson(p, count, history, SweepRule{});
  REQUIRE(p.error() <= 1e-9);
  REQUIRE(count.sweeps <= 20);
}

// x ← x + 1 has no fixed point; mixing would go to infinity, and may go to ten times the first z.
TEST_CASE("mixing does not run away where there is no solution") {
  Linear p;
  p.A.setIdentity();
  p.A(0, 0) = 0.5;
  Count count{p, 50};
  inner::History history;
  inner::anderson(p, count, history, SweepRule{});
  REQUIRE(p.x.norm() <= 50 * 10 * p.b.norm());
}

}  // namespace anderson_tests
