// Piles: one projection a visit in the metric of the own block, when momentum restarts, and what a pile
// costs.
#include <delassus/delassus.hpp>
#include <delassus/solvers/inner/pile_sweeps.hpp>

#include <random>

#include "catch.hpp"

namespace pile_sweeps_tests {

using namespace delassus;

namespace {

using Matrix = Mat<3, 3, double>;
using Vector = Vec<3, double>;

/// A contact alone: W = A Aᵀ + 0.1 1, b from all cases.
struct Lone {
  Matrix W;
  Vector b;
  Coulomb law;
  Coulomb::Parameters parameters;

  explicit Lone(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Matrix A;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) A(i, j) = uniform(random);
    W = A * A.transpose() + 0.1 * Matrix::Identity();
    for (int k = 0; k < 3; ++k) b[k] = uniform(random);
    b[0] -= 0.3;
    parameters.friction = 0.6 + 0.6 * uniform(random);
  }
  Vector exact() const {
    Coulomb::Memory<double> memory{};
    law.prepare(W, memory);
    return law.solve_local(parameters, W, b, memory);
  }
  Vector step(const Vector& lambda) const {
    return law.projection_step(parameters, W, lambda, Vector(W * lambda + b));
  }
};

/// 125 spheres let go with gaps in a box of planes; sweeps of the steps from `first` to `last`.
int sweeps_of_pile(int first, int last) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-3, .max_iterations = 4000}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (const Vec3& in : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)})
    set.add_fixed(HalfSpace{in, -0.5625});
  for (int k = 0; k < 125; ++k) {
    const int x = k % 5, y = k / 5 % 5, z = k / 25;
    const double off = 0.02 * ((z * 7 + x * 3 + y * 5) % 5 - 2);
    set.add({.position = {0.205 * (x - 2) + off, 0.205 * (y - 2) - off, 0.1 + 0.205 * z},
             .mass = 1.0,
             .shape = Sphere{0.1}});
  }
  int sum = 0;
  for (int step = 1; step <= last; ++step) {
    const StepReport report = loop.step(0.005);
    REQUIRE(report.status == Status::converged);
    if (step >= first) sum += report.sweeps;
  }
  return sum;
}

}  // namespace

TEST_CASE("a projection in the metric of the own block leaves the exact answer") {
  std::mt19937 random(1);
  int open = 0, slips = 0;
  for (int k = 0; k < 2000; ++k) {
    const Lone contact(random);
    const Vector exact = contact.exact();
    open += exact[0] == 0;
    slips += contact.law.is_sliding(contact.parameters, exact);
    // The answer is known to the rounding of W⁻¹ b, |W⁻¹| ≤ 10, and a slip to 16 ε of its root.
    REQUIRE((contact.step(exact) - exact).norm() < 1e-12 * (1 + exact.norm()));
  }
  REQUIRE(open > 200);
  REQUIRE(slips > 200);
}

TEST_CASE("a pile restarts where a sweep moves half as much again as the least") {
  inner::PileSweeps pile{SweepRule{}};
  REQUIRE_FALSE(pile.asks(-1, 1.0));
  REQUIRE_FALSE(pile.asks(-1, 1.49));
  REQUIRE(pile.asks(-1, 1.51));
  REQUIRE_FALSE(pile.asks(-1, 100.0));  // the first after a restart: nothing to compare it with
  REQUIRE(pile.asks(1, 50.0));
}

TEST_CASE("a pile of spheres is one by its W and takes few sweeps") {
  // 75 a step: the rules of other islands take more.
  REQUIRE(sweeps_of_pile(61, 90) <= 2250);
}

}  // namespace pile_sweeps_tests
