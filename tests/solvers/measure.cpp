#include "scenes.hpp"

#include "catch.hpp"

namespace measure_tests {

using namespace scenes;

namespace {

/// The two errors of Siconos' and ours from the formulas, on dense arrays: W, q, r per contact (n, t1, t2) and mu.
struct Errors {
  double err, err_s;
};

Vec3 euclidean_projection(const Vec3& x, double mu) {
  const double t = std::sqrt(x[1] * x[1] + x[2] * x[2]);
  if (t <= mu * x[0]) return x;
  if (mu * t <= -x[0]) return Vec3::Zero();
  const double n = (x[0] + mu * t) / (1 + mu * mu);
  return Vec3(n, mu * n * x[1] / t, mu * n * x[2] / t);
}

Errors errors(const Eigen::MatrixXd& W, const Eigen::VectorXd& q, const Eigen::VectorXd& r, double mu) {
  const Eigen::VectorXd u = W * r + q;
  double plain = 0, scaled = 0;
  for (int i = 0; i < r.size(); i += 3) {
    const double w = (W(i, i) + W(i + 1, i + 1) + W(i + 2, i + 2)) / 3;
    Vec3 tilde = u.segment<3>(i);
    tilde[0] += mu * tilde.tail<2>().norm();
    const Vec3 x = r.segment<3>(i);
    plain += (x - euclidean_projection(x - tilde, mu)).squaredNorm();
    scaled += (w * x - euclidean_projection(w * x - tilde, mu)).squaredNorm();
  }
  const double velocity = std::max(q.norm(), u.norm());
  return {std::sqrt(plain) / std::max(velocity, r.norm()), std::sqrt(scaled) / velocity};
}

constexpr double mu = 0.7;

auto cluster_loop(unsigned seed) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}, GivenContacts{}};
  loop.get<GivenContacts>().points = add_cluster(rigid_bodies(loop), 8, 20, seed, -1e-3, false);
  return loop;
}

/// W, q and λ of a problem of one pool of contacts and one island, dense.
template <class Problem>
void dense(const Problem& problem, Eigen::MatrixXd& W, Eigen::VectorXd& q, Eigen::VectorXd& r) {
  const auto& pool = problem.rows.template pool<0>();
  const Index n = 3 * pool.items();
  W.setZero(n, n);
  q.resize(n);
  r.resize(n);
  const auto blocks = problem.W.template blocks<0, 0>();
  for (Index i = 0; i < pool.items(); ++i) {
    W.block<3, 3>(3 * i, 3 * i) = problem.W.template diagonal<0>(i);
    for (Index e = blocks.start[i]; e < blocks.start[i + 1]; ++e)
      W.block<3, 3>(3 * i, 3 * blocks.column[e]) = blocks.block[e];
    q.segment<3>(3 * i) = pool.d[i];
    r.segment<3>(3 * i) = pool.lambda[i];
  }
}

constexpr GaussSeidel only_measure{.max_iterations = 0, .min_iterations = 0};

}  // namespace

// Sums of 60 squares that are right to a few roundings each.
TEST_CASE("residual and siconos are the two errors of the formulas, at any impulse") {
  Eigen::MatrixXd W;
  Eigen::VectorXd q, r;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto loop = cluster_loop(seed);
    REQUIRE(loop.step(0.01).islands == 1);
    auto problem = loop.problem();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> draw(-1, 1);
    for (auto& x : problem.rows.pool<0>().lambda) x = Vec3{draw(random), draw(random), draw(random)};
    const Measure m = solve(problem, only_measure).measure;
    dense(problem, W, q, r);
    const Errors expected = errors(W, q, r, mu);
    REQUIRE(m.residual == Approx(expected.err_s).epsilon(1e-12));
    REQUIRE(m.siconos == Approx(expected.err).epsilon(1e-12));
  }
}

TEST_CASE("what a step reports are the two errors of its own impulses") {
  Eigen::MatrixXd W;
  Eigen::VectorXd q, r;
  int converged = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    auto loop = cluster_loop(seed);
    const StepReport report = loop.step(0.01);
    dense(loop.problem(), W, q, r);
    const Errors expected = errors(W, q, r, mu);
    // u = q + W r: terms of the size of Σ|W_ij r_j| cancel, and each sum of n of them rounds n times.
    const double reach = (W.cwiseAbs() * r.cwiseAbs()).maxCoeff(), velocity = std::max(q.norm(), (W * r + q).norm());
    const double rounding = double(r.size()) * std::numeric_limits<double>::epsilon() * reach / velocity;
    CAPTURE(seed, rounding, report.residual - expected.err_s);
    REQUIRE(std::abs(report.residual - expected.err_s) <= rounding);
    REQUIRE(std::abs(report.natural_map_error - expected.err) <= rounding * (1 + r.norm() / velocity));
    REQUIRE((report.status == Status::converged) == (expected.err_s <= 1e-6));
    converged += report.status == Status::converged;
  }
  REQUIRE(converged >= 10);
  REQUIRE(converged < 20);  // some of these wedged problems send the sweeps round in circles, and the report says so
}

// u scales with the velocities and λ with them and the mass: the residual is free of both scales, Siconos' measure is not.
TEST_CASE("the residual does not change when all masses or all velocities are scaled") {
  Eigen::MatrixXd W;
  Eigen::VectorXd q, r;
  auto loop = cluster_loop(3);
  loop.step(0.01);
  auto problem = loop.problem();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1, 1);
  for (auto& x : problem.rows.pool<0>().lambda) x = Vec3{draw(random), draw(random), draw(random)};
  const Measure before = solve(problem, only_measure).measure;
  const double size = 1024;  // velocities and impulses by a power of two: no rounding
  for (auto& x : problem.rows.pool<0>().lambda) x *= size;
  for (auto& x : problem.rows.pool<0>().d) x *= size;
  REQUIRE(solve(problem, only_measure).measure.residual == Approx(before.residual).epsilon(1e-14));
}

}  // namespace measure_tests
