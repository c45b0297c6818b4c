// Friction problems of up to six contacts, solvable or not, by sweeps: the impulses are finite and on the
// cone, and what is called converged is.
#include "shapes.hpp"

#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include <algorithm>
#include <vector>

using namespace delassus;
using fuzz::Bytes, fuzz::expect;

namespace {

Mat3 matrix(Bytes& bytes, double size) {
  Mat3 m;
  for (int c = 0; c < 3; ++c) m.col(c) = fuzz::vector(bytes, size);
  return m;
}

/// W = G Gᵀ with G of n × `bodies` blocks: symmetric, and singular where there are fewer bodies than
/// contacts; or any matrix whose diagonal is positive.
std::vector<GivenBlock> blocks(Bytes& bytes, int n, double scale) {
  const bool is_given = bytes.chance(64);
  const int bodies = 1 + bytes.below(4);
  std::vector<Mat3> G;
  for (int k = 0; k < n * bodies; ++k) G.push_back(bytes.chance(100) ? Mat3(Mat3::Zero()) : matrix(bytes, 1));
  std::vector<GivenBlock> out;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Mat3 W = is_given ? matrix(bytes, 1) : Mat3(Mat3::Zero());
      for (int k = 0; !is_given && k < bodies; ++k)
        W += Mat3(G[std::size_t(i * bodies + k)] * G[std::size_t(j * bodies + k)].transpose());
      if (i == j)
        for (int k = 0; k < 3; ++k) W(k, k) = std::abs(W(k, k)) + 1e-6;
      out.push_back({i, j, Mat3(scale * W)});
    }
  return out;
}

void check(const FrictionProblem& p, const SolveReport& report, double tolerance) {
  // Sweeps on a W that no bodies have may run away; then the status says so.
  if (report.status == Status::quarantined) return;
  expect(std::isfinite(report.measure.residual), "the residual is not finite and the status does not say so");
  expect(report.status != Status::converged || report.measure.residual <= tolerance,
         "what is called converged has a larger residual");
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i) {
    const Vec3& lambda = p.rows.pool<0>().lambda[i];
    const double mu = p.laws.pool<0>().item(i).parameters.friction, size = lambda.norm();
    expect(is_finite(lambda), "an impulse is not finite");
    // On the cone up to the rounding of its two square roots, and of μ λ_n.
    expect(lambda[0] >= 0 && std::hypot(lambda[1], lambda[2]) <= mu * lambda[0] + 1e-12 * (1 + mu) * size,
           "an impulse lies outside of the cone");
  }
}

template <class Solver>
void solve_and_check(FrictionProblem p, const Solver& solver) {
  check(p, solve(p, solver), solver.tolerance);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes bytes(data, size);
  const int n = 1 + bytes.below(6);
  const double scale = bytes.magnitude(-9, 9), speed = bytes.magnitude(-9, 9);
  std::vector<double> friction;
  std::vector<Vec3> q;
  for (int i = 0; i < n; ++i) {
    friction.push_back(bytes.chance(40) ? std::abs(bytes.between(0, 1e6)) : bytes.between(0, 2));
    q.push_back(speed * fuzz::vector(bytes, 1));
  }
  FrictionProblem p = make_friction_problem(friction, q, blocks(bytes, n, scale));
  if (bytes.chance(64))  // a guess, on the cone or not
    for (Vec3& lambda : p.rows.pool<0>().lambda) lambda = speed / scale * fuzz::vector(bytes, 1);
  solve_and_check(p, AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 60});
  solve_and_check(p, GaussSeidel{.tolerance = 1e-8, .max_iterations = 60});
  return 0;
}
