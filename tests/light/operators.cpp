// One W in three forms, by a number; A with entries between bodies; rows that yield.
#include "scenes_of_step.hpp"

#include "catch.hpp"

#include <Eigen/Cholesky>

namespace light_operator_tests {

using namespace light;

namespace {

/// W without d: column by column from the primitive.
template <class Step>
Eigen::MatrixXd dense(Step& step) {
  Rows<double>& rows = step.rows;
  const Index n = rows.count();
  Eigen::MatrixXd W(n, n);
  const Array<double> lambda = rows.lambda, d = rows.d;
  rows.d.assign(std::size_t(n), 0);
  rows.lambda.assign(std::size_t(n), 0);
  for (Index c = 0; c < n; ++c) {
    rows.lambda[c] = 1;
    step.W.reset();
    for (int p = 0; p < int(step.pools.list.size()); ++p) {
      const light::Pool<double>& pool = *step.pools.list[p];
      const int R = pool.sweeping->rows;
      for (Index i = 0; i < pool.items; ++i) {
        const Index row = pool.first_row + R * i;
        double u[6];
        step.W.free(p, i, u);
        for (int k = 0; k < R; ++k) W(row + k, c) = u[k];
        for (int k = 0; k < R && c >= row && c < row + R; ++k)
          W(row + k, c) += step.W.diagonal(p, i)[k + R * (c - row)];
      }
    }
    rows.lambda[c] = 0;
  }
  rows.d = d;
  rows.lambda = lambda;
  step.W.reset();
  return W;
}

/// H of all rows over all velocities.
template <class Step>
Eigen::MatrixXd dense_rows(const Step& step) {
  const Rows<double>& r = step.rows;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(r.count(), step.world.velocities);
  for (Index i = 0; i < r.items(); ++i)
    for (Index e = r.entry[i]; e < r.entry[i + 1]; ++e)
      for (int k = 0; k < r.rows_of(i); ++k)
        for (int j = 0; j < r.entries[e].width; ++j)
          H(r.row[i] + k, r.entries[e].velocity + j) += r.H[r.entries[e].place + k + r.rows_of(i) * j];
  return H;
}

/// A of the mixed scene: masses, and h² K + h C of the springs of the cube, made from the formula of
/// `Springs`.
template <class Loop>
Eigen::MatrixXd dense_inverse(const Loop& loop, double stiffness, double h) {
  const auto& world = loop.world();
  const auto& rigid = world.template set<0>();
  const Index r = 6 * rigid.blocks(), b = 3 * world.template set<1>().blocks();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(r + b + 24, r + b + 24);
  inverse.topLeftCorner(r, r) = scenes::dense_inverse(rigid);
  inverse.block(r, r, b, b) = Eigen::MatrixXd::Identity(b, b) / 0.1;
  Eigen::MatrixXd A = 0.2 * Eigen::MatrixXd::Identity(24, 24);
  const auto corner = [](int k) { return 0.4 * Vec3(k & 1, k >> 1 & 1, k >> 2); };
  for (int i = 0; i < 8; ++i)
    for (int j = i + 1; j < 8; ++j) {
      const Vec3 e = (corner(i) - corner(j)).normalized();  // at rest: K = k e eᵀ, D = c e eᵀ
      const Mat3 block = (h * h * stiffness + h * 1.0) * e * e.transpose();
      A.block<3, 3>(3 * i, 3 * i) += block;
      A.block<3, 3>(3 * j, 3 * j) += block;
      A.block<3, 3>(3 * i, 3 * j) -= block;
      A.block<3, 3>(3 * j, 3 * i) -= block;
    }
  inverse.bottomRightCorner(24, 24) = A.llt().solve(Eigen::MatrixXd::Identity(24, 24));
  return inverse;
}

}  // namespace

TEST_CASE("W over rigid bodies, particles and a soft body is H A^-1 H^T with A = M + h C + h^2 K") {
  const double stiffness = 2000, h = 0.01;
  const auto loop = mixed(stiffness);
  FlatStep step(loop);
  REQUIRE(step.world.sets[2].is_coupled);
  const Eigen::MatrixXd H = dense_rows(step);
  Eigen::MatrixXd expected = H * dense_inverse(loop, stiffness, h) * H.transpose();
  for (Index k = 0; k < step.rows.count(); ++k) expected(k, k) += step.rows.compliance[k];
  const Eigen::MatrixXd W = dense(step);
  CHECK((W - expected).norm() <= 1e-12 * expected.norm());
  CHECK((W - W.transpose()).norm() <= 1e-12 * W.norm());
}

TEST_CASE("W as blocks, through the bodies and row by row as is cheaper is one matrix") {
  const auto loop = mixed();
  FlatStep blocks(loop), bodies(loop, 0), cheaper(loop, 4);
  const Eigen::MatrixXd W = dense(blocks);
  CHECK((dense(bodies) - W).norm() <= 1e-13 * W.norm());
  CHECK((dense(cheaper) - W).norm() <= 1e-13 * W.norm());
  const auto count = [](const auto& step) {
    Index through_bodies = 0;
    for (Index i = 0; i < step.rows.items(); ++i) through_bodies += !step.W.has_blocks(i);
    return through_bodies;
  };
  CHECK(count(blocks) == 0);
  CHECK(count(cheaper) > 0);
  CHECK(count(bodies) > count(cheaper));
  CHECK(count(bodies) < bodies.rows.items());  // what acts on the soft body keeps its blocks
}

// A y that takes every change has rounding of its own, and H y is another sum than that over blocks.
TEST_CASE("sweeps through the bodies are the library's without a matrix") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                     MatrixFreeCompliance{}, scenes::GivenContacts{}, delassus::GaussSeidel{}};
  auto& set = loop.world().set<0>();
  loop.policy<role::Collision>().points = scenes::add_cluster(set, 12, 40, 3);
  for (int k = 1; k < 5; ++k)
    loop.add(BallJoint::Item{anchor(set, set.handle(k), {0.5, 0, 0}),
                             anchor(set, set.handle(k + 1), {-0.5, 0, 0})});
  stop_before_solve(loop, 1.0 / 60);
  FlatStep step(loop, 0);
  delassus::solve(step.problem, delassus::GaussSeidel{.tolerance = 0, .max_iterations = 25});
  const SolveReport mine = step.solve(light::GaussSeidel{.tolerance = 0, .max_iterations = 25});
  CHECK(mine.sweeps == 25);
  CHECK(difference(step.rows.lambda, impulses(step.problem)) <= 1e-12);
}

TEST_CASE("all three forms are swept to the same impulses on bodies of three kinds") {
  const auto loop = mixed();
  FlatStep blocks(loop), bodies(loop, 0), cheaper(loop, 4);
  const light::GaussSeidel sweeps{.tolerance = 0, .max_iterations = 30};
  blocks.solve(sweeps);
  bodies.solve(sweeps);
  cheaper.solve(sweeps);
  CHECK(difference(bodies.rows.lambda, blocks.rows.lambda) <= 1e-12);
  CHECK(difference(cheaper.rows.lambda, blocks.rows.lambda) <= 1e-12);
}

// λ = −(W + C)⁻¹ d for equalities, C the rows' compliance. The sweeps end at 1e-13 of |d|.
TEST_CASE("soft and rigid rows of joints are met as the dense system says") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, delassus::GaussSeidel{}};
  auto& set = loop.world().set<0>();
  std::array<Particles::Handle, 5> bead;
  for (int k = 0; k < 5; ++k)
    bead[k] = set.add({.position = {0.3 * k, 0.1 * k * k, 0}, .velocity = {0, 0, 1.0 * k}, .mass = 1.0 + k});
  for (int k = 0; k < 4; ++k)
    loop.add(DistanceJoint::Item{anchor(set, bead[k]), anchor(set, bead[k + 1]), 0.5, k % 2 ? 400.0 : 0.0,
                                 k % 2 ? 3.0 : 0.0});
  stop_before_solve(loop, 0.01);
  for (const Index most_partners : {Delassus<double>::all_blocks, Index(0)}) {
    FlatStep step(loop, most_partners);
    CHECK(step.rows.compliance[0] == 0);
    CHECK(step.rows.compliance[1] == Approx(1 / (0.01 * 0.01 * 400 + 0.01 * 3)).epsilon(1e-14));
    const Eigen::VectorXd expected =
        -dense(step).llt().solve(Eigen::Map<const Eigen::VectorXd>(step.rows.d.data(), 4));
    CHECK(step.solve(light::GaussSeidel{.tolerance = 1e-13}).status == Status::converged);
    CHECK((Eigen::Map<const Eigen::VectorXd>(step.rows.lambda.data(), 4) - expected).norm() <=
          1e-11 * expected.norm());
  }
}

// Two joints hold a bead at two points. With ε w on the diagonal, w = 1/m for each, (W + ε w) λ = −d has the
// solution below.
TEST_CASE("rows that contradict each other have bounded impulses when each yields by a share") {
  AnimationLoop loop{World{Particles{}}, Constraints{BallJoint{}}, delassus::GaussSeidel{}};
  auto& set = loop.world().set<0>();
  set.gravity.setZero();
  const double m = 2, share = 0.1;
  const auto bead = set.add({.position = {0, 0, 0}, .mass = m});
  loop.add(BallJoint::Item{anchor(set, bead), world_anchor({1, 0, 0})});
  loop.add(BallJoint::Item{anchor(set, bead), world_anchor({-1, 0, 0})});
  stop_before_solve(loop, 0.01);
  for (const Index most_partners : {Delassus<double>::all_blocks, Index(0)}) {
    FlatStep step(loop, most_partners);
    CHECK(step.solve(light::GaussSeidel{.tolerance = 1e-10}).status == Status::max_iterations);
    step.rows.lambda.assign(6, 0);
    step.W.soften(share);
    step.W.reset();
    CHECK(step.solve(light::GaussSeidel{.tolerance = 1e-13}).status == Status::converged);
    const double d = step.rows.d[0];
    CHECK(step.rows.d[3] == -d);
    CHECK(step.rows.lambda[0] == Approx(-m * d / share).epsilon(1e-11));
    CHECK(step.rows.lambda[3] == Approx(m * d / share).epsilon(1e-11));
  }
}

}  // namespace light_operator_tests
