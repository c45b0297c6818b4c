#include "scenes.hpp"

#include "catch.hpp"

namespace matrix_free_tests {

using namespace scenes;

namespace {

/// Twelve bodies with forty overlapping contacts, their rows softened, one step in.
template <class Builder>
auto cluster_problem(Builder builder, unsigned seed) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}}, GivenContacts{}, builder,
                     GaussSeidel{.tolerance = 0, .max_iterations = 50, .min_iterations = 50}, SoftContact{}};
  loop.template get<GivenContacts>().points = add_cluster(rigid_bodies(loop), 12, 40, seed, -1e-3);
  loop.step(0.01);
  return loop.problem();
}

}  // namespace

// The two add the same products in another order; each sweep contracts such differences or carries them on, and fifty of
// them raise a few ulp to at most 1e-10 of the largest impulse.
TEST_CASE("assembled and matrix-free give the same impulses after the same number of sweeps") {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto p = cluster_problem(AssembledCompliance{}, seed);
    const auto q = cluster_problem(MatrixFreeCompliance{}, seed);
    const auto &x = p.rows.pool<0>().lambda, &y = q.rows.pool<0>().lambda;
    double largest = 0, difference = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      largest = std::max(largest, x[i].norm());
      difference = std::max(difference, (x[i] - y[i]).norm());
    }
    CAPTURE(seed);
    REQUIRE(difference <= 1e-10 * largest);
  }
}

// d + H (A⁻¹ Hᵀ λ) against the rows of the assembled operator at the same λ: both sum about ten products a row.
TEST_CASE("the matrix-free residual is the assembled one at any impulse") {
  auto p = cluster_problem(AssembledCompliance{}, 4);
  auto q = cluster_problem(MatrixFreeCompliance{}, 4);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i)
    p.rows.pool<0>().lambda[i] = q.rows.pool<0>().lambda[i] = Vec3{draw(random), draw(random), draw(random)};
  p.W.reset(p.rows);
  q.W.reset(q.rows);
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i) {
    const Vec3 x = p.W.residual<0>(p.rows, i), y = q.W.residual<0>(q.rows, i);
    REQUIRE((x - y).norm() <= 1e-12 * (1 + x.norm()));
    REQUIRE((p.W.diagonal<0>(i) - q.W.diagonal<0>(i)).norm() <= 1e-14 * p.W.diagonal<0>(i).norm());
  }
}

}  // namespace matrix_free_tests
