#include "lane_tests.hpp"

#include <Eigen/Eigenvalues>

namespace coulomb_lanes_tests {

using namespace lane_tests;

namespace {

/// Of contacts alone, after one sweep: the largest |Δλ_i|/(|W_ii⁻¹| |d_i| (1 + μ)) between the two sides.
double largest_difference(const Both& both) {
  double most = 0;
  for (std::size_t i = 0; i < both.lanes.items.size(); ++i) {
    const Mat3 W = Eigen::Map<const Mat3>(both.lanes.diagonal.data() + 9 * i);
    const double least = Eigen::SelfAdjointEigenSolver<Mat3>(W).eigenvalues()[0];
    const auto part = [i](const std::vector<double>& x) {
      return Vec3(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    };
    const double size = part(both.lanes.d).norm() / least * (1 + both.lanes.items[i].parameters.friction);
    most = std::max(most, (part(both.lanes.lambda) - part(both.scalar.lambda)).norm() / size);
  }
  return most;
}

}  // namespace

// Both sides read the same inverses. What they make of these differs by some 200 roundings of 1.1e-16 of the
// largest number they meet, |W_ii⁻¹| |d| (1 + μ), and by 20 times that where the curve whose root is sought
// is flat.
TEST_CASE("blocks from round to nearly singular get in lanes what each gets by itself") {
  for (const double friction : {0.0, 1e-6, 0.1, 0.5, 1.5, 10.0})
    for (const double softest : {0.7, 1e-3, 1e-6, 1e-9})
      for (const double size : {1.0, 1e-60, 1e60}) {
        INFO(friction << " " << softest << " " << size);
        Both both({.friction = friction, .size_of_d = size, .softest = softest, .is_alone = true}, 1001);
        for (int k = 0; k < 2; ++k) {
          both.sweep();
          CHECK(largest_difference(both) <= 5e-13);
        }
        const Cases cases(both.lanes);
        CHECK(cases.open > 100);
        CHECK(cases.slipping > 20);
        for (std::size_t i = 0; i < both.lanes.items.size(); ++i) {
          const double* x = &both.lanes.lambda[3 * i];
          CHECK(std::isfinite(x[0] + x[1] + x[2]));
          CHECK(std::hypot(x[1], x[2]) <= friction * x[0] * (1 + 1e-14));
        }
      }
}

TEST_CASE("a contact that begins to slip or to stick changes its case in lanes as by itself") {
  Both both({.friction = 1.5, .softest = 1e-3, .is_alone = true}, 1001);
  Numbers x;
  for (int k = 0; k < 20; ++k) {
    std::vector<double> d = both.scalar.d;
    for (double& one : d) one *= 1 + 0.3 * x();
    both.scalar.d = d, both.lanes.d = d;
    both.lanes.packed.give_back();
    both.lanes.packed.fill(nullptr);
    both.sweep();
    CHECK(largest_difference(both) <= 5e-13);
  }
}

}  // namespace coulomb_lanes_tests
