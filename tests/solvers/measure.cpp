#include "scenes.hpp"

#include <delassus/constraints/contact/pyramid.hpp>
#include <delassus/constraints/contact/rolling_coulomb.hpp>
#include <delassus/problems/friction_problem.hpp>
#include <delassus/problems/reference_check.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/solvers/measure.hpp>
#include <delassus/solvers/path_newton.hpp>

#include "catch.hpp"

#include <limits>

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
    const double closing = std::min(0.0, u[i]);
    scaled += std::max((w * x - euclidean_projection(w * x - tilde, mu)).squaredNorm(), closing * closing);
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

namespace {

/// One contact, W = w 1, from the impulse λ.
FrictionProblem one_contact(double friction, const Vec3& q, double w = 1, const Vec3& lambda = Vec3::Zero()) {
  FrictionProblem p = make_friction_problem({friction}, {q}, {{0, 0, Mat3(w * Mat3::Identity())}});
  p.rows.pool<0>().lambda[0] = lambda;
  return p;
}

/// What a box that comes down at 1 m/s beside a slip of 2 m/s has before it is solved, and after.
template <class Law>
void sees_penetration(const Law& law) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact<Law>{law}}, GaussSeidel{.tolerance = 1e-3, .max_iterations = 0, .min_iterations = 0}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.set_velocity(set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}}), {2, 0, -1}, {0, 0, 0});
  loop.step(1e-3);
  auto problem = loop.problem();
  const SolveReport before = solve(problem, GaussSeidel{.tolerance = 1e-3, .max_iterations = 0, .min_iterations = 0});
  CHECK(before.status == Status::max_iterations);
  CHECK(before.measure.closing > 0.4);  // 1/√5 of each velocity
  CHECK(before.measure.residual >= before.measure.closing);
  const SolveReport after = solve(problem, AcceleratedGaussSeidel{.tolerance = 1e-3, .min_iterations = 0});
  CHECK(after.status == Status::converged);
  CHECK(after.measure.closing <= 1e-3);
}

}  // namespace

// By hand: at λ = 0, −ũ = (1 − 2 μ, −2, 0) is outside of the polar cone by 1, so that |F| = 1/√(1 + μ²) and the errors are that
// over |q| = √5: 4e-4 for μ = 1000, though the contact goes on at 1 m/s. The solution is λ = (1, −2, 0), u = 0.
TEST_CASE("a contact that goes on into the other body is not solved, however steep its cone is") {
  const Vec3 q(-1, 2, 0);
  for (const double steep : {1e3, 1e4, 1e6}) {
    CAPTURE(steep);
    auto at_rest = one_contact(steep, q);
    const Measure m = solve(at_rest, only_measure).measure;
    CHECK(m.siconos == Approx(1 / std::sqrt(1 + steep * steep) / std::sqrt(5)).epsilon(1e-6));
    CHECK(m.closing == Approx(1 / std::sqrt(5)).epsilon(1e-14));
    CHECK(m.residual == m.closing);
    const auto ends_right = [&](const auto& solver) {
      auto p = one_contact(steep, q);
      CHECK(solve(p, solver).status == Status::converged);
      const Vec3 u = p.rows.pool<0>().lambda[0] + q;
      CHECK(u[0] >= -1e-3 * std::sqrt(5));
    };
    for (const Criterion criterion : {Criterion::residual, Criterion::siconos_error, Criterion::both_errors}) {
      ends_right(GaussSeidel{.tolerance = 1e-3, .min_iterations = 0, .criterion = criterion});
      ends_right(AcceleratedGaussSeidel{.tolerance = 1e-3, .min_iterations = 0, .criterion = criterion});
      ends_right(PathNewton{.tolerance = 1e-3, .criterion = criterion});
    }
    ends_right(GaussSeidel{.tolerance = 1e-3, .min_iterations = 0, .criterion = Criterion::last_change});
  }
}

TEST_CASE("what goes on into a contact is seen under every contact law") {
  sees_penetration(Coulomb{.friction = 1e4});
  sees_penetration(RollingCoulomb{.friction = 1e4, .rolling_friction = 0.1});
  sees_penetration(Pyramid{.friction = 1e4});
  sees_penetration(Frictionless{});
}

// |λ| of a heavy contact does not hide what a light one does, though Siconos' measure is divided by it: 1/10⁴ here.
TEST_CASE("by Siconos' criterion a light contact beside a heavy one is solved too") {
  FrictionProblem p = make_friction_problem({0.5, 0.5}, {Vec3(-1, 0, 0), Vec3(-1, 0, 0)},
                                            {{0, 0, Mat3(1e-4 * Mat3::Identity())}, {1, 1, Mat3(Mat3::Identity())}});
  p.rows.pool<0>().lambda[0] = Vec3(1e4, 0, 0);
  auto start = p;
  CHECK(solve(start, only_measure).measure.siconos == Approx(1e-4));
  CHECK(solve(p, GaussSeidel{.tolerance = 1e-3, .min_iterations = 0, .criterion = Criterion::siconos_error}).status == Status::converged);
  CHECK(p.rows.pool<0>().lambda[1][0] == Approx(1));
}

// ũ_n = u_n + μ |u_t|: where the contact sticks, |u_t| is rounding of the size ε w |λ|, and the map μ times that.
TEST_CASE("a contact that sticks in a very steep cone stalls at its rounding") {
  auto p = one_contact(1e12, {-1, 2, 0.3}, 3, {0.33, -0.7, -0.09});
  const SolveReport r = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-12});
  CHECK(r.status <= Status::stalled);
  CHECK(r.measure.closing <= 1e-15);
}

// The squares of 10¹⁵⁵ and of 10⁻¹⁶⁵ are no numbers, those of 10¹⁵⁰ are.
TEST_CASE("velocities whose squares are no numbers are a status, and no error is NaN") {
  const auto report = [](double size, const auto& solver) {
    auto p = one_contact(0.5, {-size, 2 * size, 0});
    const SolveReport r = solve(p, solver);
    CAPTURE(size);
    CHECK(!std::isnan(r.measure.residual));
    CHECK(!std::isnan(r.measure.siconos));
    CHECK(!std::isnan(r.measure.closing));
    return r.status;
  };
  const auto statuses = [&](const auto& solver) {
    for (const double size : {1.1e154, 1e155, 1e200, 8e307}) CHECK(report(size, solver) == Status::quarantined);
    for (const double size : {1e-155, 1e-165, 1e-300}) CHECK(report(size, solver) == Status::stalled);
    for (const double size : {1e-60, 1e150}) CHECK(report(size, solver) == Status::converged);
    CHECK(report(0, solver) == Status::converged);
  };
  for (const int least : {0, 1}) {
    statuses(GaussSeidel{.min_iterations = least});
    statuses(AcceleratedGaussSeidel{.min_iterations = least});
  }
  for (const double size : {1e155, 1e200, 1e-165}) CHECK(report(size, PathNewton{}) != Status::converged);
}

// λ of 10²⁰⁰ N·s from W = 10⁻²⁰⁰/kg: |λ|² is no number, though both velocities are.
TEST_CASE("an impulse whose square is no number does not make Siconos' measure vanish") {
  auto p = one_contact(0.5, {-1, 0, 0}, 1e-200, {5e199, 0, 0});
  const SolveReport r = solve(p, GaussSeidel{.max_iterations = 0, .min_iterations = 0, .criterion = Criterion::siconos_error});
  CHECK(r.status != Status::converged);
  CHECK(r.measure.residual == Approx(0.5));
}

TEST_CASE("rounding that hides a tenth of the motion is no end") {
  CHECK(Measure{.residual = 1e-3, .floor = 1e-2}.is_at_floor());
  CHECK(!Measure{.residual = 1e-3, .floor = 1e-4}.is_at_floor());
  CHECK(!Measure{.residual = 1e-3, .floor = 0.5}.is_at_floor());
}

}  // namespace measure_tests
