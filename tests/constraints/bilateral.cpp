#include <delassus/constraints/joints/bilateral.hpp>

#include "catch.hpp"

#include <random>

namespace bilateral_tests {

using namespace delassus;

// u = W λ + b is computed to ε (|W| |λ| + |b|) times the length of the sums, 4; an inverse alone leaves ε cond W = 1e-9 of that.
TEST_CASE("the visits of a step end at a velocity of rounding, however ill-conditioned the block is") {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> draw(-1, 1);
  const Bilateral<3> law;
  for (int n = 0; n < 200; ++n) {
    Mat3 turn;
    for (double& x : turn.reshaped()) x = draw(random);
    const Mat3 axes = turn.householderQr().householderQ();
    const Mat3 W = axes * Vec3(1, 1e-3, 1e-7).asDiagonal() * axes.transpose();
    const Vec3 b(draw(random), draw(random), draw(random));
    Bilateral<3>::Memory<double> memory;
    law.prepare(W, memory);
    Vec3 lambda;
    for (int visit = 0; visit < 4; ++visit) lambda = law.solve_local(0, W, b, memory);
    CAPTURE(n);
    REQUIRE((W * lambda + b).norm() <= 1e-15 * (W.norm() * lambda.norm() + b.norm()) * 4);
  }
}

// A visit answers to b alone: λ = −W⁻¹ b = (0, −2). Of the λ before, 75 N·s, it keeps the lift of the block, 64 ε tr W = 4e-14, over
// its smallest eigenvalue, 0.8.
TEST_CASE("what a joint answers does not depend on the visits before") {
  const Bilateral<2> law;
  const Mat<2, 2> W{{2, 0.5}, {0.5, 1}};
  Bilateral<2>::Memory<double> memory;
  law.prepare(W, memory);
  law.solve_local(0, W, Vec<2>(100, -30), memory);
  const Vec<2> lambda = law.solve_local(0, W, Vec<2>(1, 2), memory);
  REQUIRE(lambda[0] == Approx(0).margin(1e-11));
  REQUIRE(lambda[1] == Approx(-2).margin(1e-11));
}

}  // namespace bilateral_tests
