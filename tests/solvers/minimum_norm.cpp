// Where many λ make one motion, which one is chosen.
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/minimum_norm.hpp>

#include "catch.hpp"
#include "scenes.hpp"

#include <Eigen/Cholesky>

namespace minimum_norm_tests {

using namespace scenes;

namespace {

using Twist = std::array<double, 6>;  ///< linear, then angular

/// A box of 1 × 1 × 0.4 m and 2 kg on its lower corners, each given `copies` times, with a free velocity.
FrictionProblem table(int copies, const Twist& free, double friction) {
  const Twist inverse{0.5, 0.5, 0.5, 12 / 2.32, 12 / 2.32, 3};
  std::vector<std::array<Twist, 3>> H;
  for (int k = 0; k < 4 * copies; ++k) {
    const double x = k % 2 ? 0.5 : -0.5, y = k / 2 % 2 ? 0.5 : -0.5, z = -0.2;
    H.push_back({Twist{0, 0, 1, y, -x, 0}, Twist{1, 0, 0, 0, z, -y}, Twist{0, 1, 0, -z, 0, x}});
  }
  const auto product = [&](const Twist& a, const Twist& b, const Twist& weight) {
    double sum = 0;
    for (std::size_t k = 0; k < 6; ++k) sum += a[k] * weight[k] * b[k];
    return sum;
  };
  std::vector<Vec3> d;
  std::vector<GivenBlock> blocks;
  for (std::size_t i = 0; i < H.size(); ++i) {
    d.push_back(Vec3::Zero());
    for (std::size_t r = 0; r < 3; ++r) d[i][Index(r)] = product(H[i][r], free, {1, 1, 1, 1, 1, 1});
    for (std::size_t j = 0; j < H.size(); ++j) {
      GivenBlock W{Index(i), Index(j), Mat3::Zero()};
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 3; ++c) W.block(Index(r), Index(c)) = product(H[i][r], H[j][c], inverse);
      blocks.push_back(W);
    }
  }
  FrictionProblem p = make_friction_problem(std::vector<double>(H.size(), friction), d, blocks);
  double uneven = 0.01;
  for (Vec3& x : p.rows.pool<0>().lambda) x = Vec3(uneven += 0.02, 0, 0);  // a start that prefers some
  return p;
}

const AcceleratedGaussSeidel sweeps{.tolerance = 1e-11, .max_iterations = 100000};
const MinimumNorm smallest{sweeps};

/// The motion is that of the sweeps: the largest |u_i − v_i|.
double apart(const FrictionProblem& p, const FrictionProblem& q) {
  double most = 0;
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i)
    most = std::max(most, (p.W.residual<0>(p.rows, i) - q.W.residual<0>(q.rows, i)).norm());
  return most;
}
double norm(const FrictionProblem& p) {
  double sum = 0;
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i)
    sum += p.W.diagonal<0>(i).trace() / 3 * p.rows.pool<0>().lambda[i].squaredNorm();
  return std::sqrt(sum);
}

}  // namespace

// At rest Σλ_n = m |v| = 2 × 0.1: by symmetry the smallest is a quarter on each leg, none of it across.
TEST_CASE("the four legs of a table carry a quarter each where λ is to be smallest") {
  FrictionProblem p = table(1, {0, 0, -0.1, 0, 0, 0}, 0.5), q = p;
  REQUIRE(solve(q, sweeps).status < Status::max_iterations);
  REQUIRE(solve(p, smallest).status < Status::max_iterations);
  double unequal = 0;
  for (const Vec3& x : q.rows.pool<0>().lambda) unequal = std::max(unequal, std::abs(x[0] - 0.05));
  REQUIRE(unequal > 1e-3);  // what sweeps leave
  for (const Vec3& x : p.rows.pool<0>().lambda) REQUIRE((x - Vec3(0.05, 0, 0)).norm() < 1e-9);
  REQUIRE(apart(p, q) < 1e-10);
}

TEST_CASE("copies of a contact share its load equally, and as it would be without copies") {
  const Twist free{0.02, -0.01, -0.1, 0.02, -0.05, 0.01};  // it stands, its load off the middle
  FrictionProblem once = table(1, free, 0.9);
  REQUIRE(solve(once, smallest).status < Status::max_iterations);
  for (const int copies : {2, 5}) {
    FrictionProblem p = table(copies, free, 0.9);
    REQUIRE(solve(p, smallest).status < Status::max_iterations);
    const auto& lambda = p.rows.pool<0>().lambda;
    for (std::size_t k = 0; k < lambda.size(); ++k)
      REQUIRE((double(copies) * lambda[k] - once.rows.pool<0>().lambda[k % 4]).norm() < 1e-8);
  }
}

TEST_CASE("the smallest λ lies in the cones, moves bodies as the solve does, and is never larger") {
  std::minstd_rand random(3);
  std::uniform_real_distribution<double> any(-1, 1);
  int smaller = 0;
  for (int n = 0; n < 60; ++n) {
    Twist free{};
    for (double& x : free) x = 0.3 * any(random);
    free[2] = -0.2 - 0.1 * any(random);
    const double friction = n % 3 == 0 ? 0.1 : n % 3 == 1 ? 0.5 : 0;
    FrictionProblem p = table(1 + n % 2, free, friction), q = p;
    const SolveReport solved = solve(q, sweeps), r = solve(p, smallest);
    CAPTURE(n, friction, r.measure.residual);
    if (solved.status >= Status::max_iterations) continue;
    REQUIRE(r.measure.residual <=
            std::max(r.measure.floor, sweeps.tolerance));
    REQUIRE(apart(p, q) < 1e-8);
    REQUIRE(norm(p) <= norm(q) * (1 + 1e-9));
    smaller += norm(p) < 0.999 * norm(q);
    for (const Vec3& x : p.rows.pool<0>().lambda) {
      REQUIRE(x[0] >= 0);
      REQUIRE(x.tail<2>().norm() <= friction * x[0] * (1 + 1e-12) + 1e-15);
    }
  }
  REQUIRE(smaller > 10);
}

// A solve that ends just below its tolerance leaves impulses of as great an error, which the smallest λ may not add to.
TEST_CASE("the smallest λ of a solve that converged is within its tolerance") {
  std::minstd_rand random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  int converged = 0, smaller = 0;
  for (int n = 0; n < 400; ++n) {
    Twist free{};
    for (double& x : free) x = 0.1 * any(random);
    free[2] = -0.15 + 0.05 * any(random);
    const AcceleratedGaussSeidel loose{.tolerance = n % 2 ? 1e-3 : 1e-6, .criterion = n % 4 < 2 ? Criterion::residual : Criterion::siconos_error};
    FrictionProblem p = table(1 + n % 3, free, 0.5), q = p;
    solve(q, loose);
    const SolveReport r = solve(p, MinimumNorm{loose});
    CAPTURE(n, r.measure.residual, r.measure.siconos);
    if (r.status != Status::converged) continue;
    REQUIRE(loose.options().error(r.measure) <= loose.tolerance);
    ++converged;
    smaller += norm(p) < 0.999 * norm(q);
  }
  CHECK(converged > 300);
  CHECK(smaller > 100);
}

// The load lies on one side, 0.03 of 0.2 N·s across: an equal share of that is more than the light legs hold.
TEST_CASE("where an equal share would slip, the smallest λ goes as far as the cones let it") {
  FrictionProblem p = table(1, {0.03, 0, -0.1, 0, -0.2, 0}, 0.35), q = p;
  REQUIRE(solve(q, sweeps).status < Status::max_iterations);
  REQUIRE(solve(p, smallest).status < Status::max_iterations);
  REQUIRE(apart(p, q) < 1e-9);
  double nearest = 1;
  for (const Vec3& x : p.rows.pool<0>().lambda) {
    REQUIRE(x.tail<2>().norm() <= 0.35 * x[0] * (1 + 1e-12));
    nearest = std::min(nearest, 0.35 * x[0] - x.tail<2>().norm());
  }
  REQUIRE(nearest < 1e-9);             // a leg is at its limit
  REQUIRE(norm(p) < 0.999 * norm(q));  // and λ smaller than what sweeps found
}

// 10 kg on 16 balls and 40 N that go round on them. With w_i = tr(W_ii)/3, W_ii = 1/m + [r]ᵀ I⁻¹ [r], the
// smallest is F_i = (α + β x_i + γ y_i)/w_i, of which the load says what Σ F_i (1, x_i, y_i) is. A solve that
// ended at 1e-16 by chance is no reason to keep what it found: 1e-10 was asked for. That, of the speed g h
// √16 of all contacts together, is 4e-10 of a contact's own.
TEST_CASE("the loads of a box on many balls are the smallest in every step, however far it was solved") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     MinimumNorm{AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 5000}}};
  auto& set = rigid_bodies(loop);
  for (int k = 0; k < 16; ++k)
    set.add_fixed(Sphere{0.02}, {0.3 * (k % 4) - 0.45, 0.3 * (k / 4) - 0.45, -0.02});
  const auto box = set.add({.position = {0, 0, 0.1}, .mass = 10.0, .shape = Box{1, 1, 0.2}});
  const Vec3 over = set.inertia(box.index).diagonal().cwiseInverse();
  const auto weight = [&](const Vec3& r) {
    double sum = 3. / 10;
    for (int k = 0; k < 3; ++k) sum += over[k] * (r.squaredNorm() - r[k] * r[k]);
    return sum / 3;
  };
  double error = 0;
  for (int n = 0; n < 120; ++n) {
    const Vec3 at(0.3 * std::cos(n * 2 * EIGEN_PI / 120), 0.3 * std::sin(n * 2 * EIGEN_PI / 120), 0.1);
    set.apply_force(box, {0, 0, -40}, at);
    REQUIRE(loop.step(1. / 60).status == Status::converged);
    REQUIRE(loop.contacts().size() == 16);
    Mat3 sum = Mat3::Zero();
    const auto row = [](const ContactResult& c) {
      return Vec3(1, c.record.point().x(), c.record.point().y());
    };
    const auto w = [&](const ContactResult& c) { return weight(c.record.point() - Vec3(0, 0, 0.1)); };
    for (const ContactResult& c : loop.contacts()) sum += row(c) * row(c).transpose() / w(c);
    const Vec3 share = sum.inverse() * Vec3(10 * g + 40, 40 * at.x(), 40 * at.y());
    for (const ContactResult& c : loop.contacts())
      error = std::max(error, (c.impulse * 60 - Vec3(0, 0, row(c).dot(share) / w(c))).norm());
  }
  CAPTURE(error);
  CHECK(error <= 1e-8 * 10 * g);
}

// Six contacts between each two of a row of three bodies of 1, 30 and 900 kg and on a fixed one: 54 numbers of which 18 decide
// the motion. λ* with d = −W λ* solves it as it stands, and the smallest with that motion is x = √w λ, projected on the range of
// K = w^-½ H A^-½. Without rounding conjugate gradients need a product for each of the 18.
TEST_CASE("as many products as there are unknowns find the smallest λ, of bodies of any masses") {
  using Matrix = Eigen::MatrixXd;
  std::minstd_rand random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  constexpr int bodies = 3, each = 6, contacts = bodies * each, rows = 3 * contacts;
  double worst = 0, change = 0;
  int asked = 0;
  for (int n = 0; n < 60; ++n) {
    Matrix H = Matrix::Zero(rows, 6 * bodies), inverse = Matrix::Zero(6 * bodies, 6 * bodies);
    const double mass[bodies] = {1, 30, 900};
    for (int k = 0; k < 6 * bodies; ++k) inverse(k, k) = (k % 6 < 3 ? 1 : 5) / mass[k / 6];
    for (int i = 0; i < contacts; ++i) {
      const int body = i / each;
      for (int below = 0; below < (body > 0 ? 2 : 1); ++below) {
        const Vec3 arm(any(random), any(random), 0.2);
        Eigen::Matrix<double, 3, 6> J;  // normal, then the two directions across
        J << 0, 0, 1, arm.y(), -arm.x(), 0, 1, 0, 0, 0, arm.z(), -arm.y(), 0, 1, 0, -arm.z(), 0, arm.x();
        H.block<3, 6>(3 * i, 6 * (body - below)) = below ? Matrix(-J) : Matrix(J);
      }
    }
    const Matrix W = H * inverse * H.transpose();
    Eigen::VectorXd start(rows), root(rows);
    for (int i = 0; i < contacts; ++i) {
      start.segment<3>(3 * i) = Vec3(1 + 0.3 * any(random), 0.05 * any(random), 0.05 * any(random));
      root.segment<3>(3 * i).setConstant(std::sqrt(W.block<3, 3>(3 * i, 3 * i).trace() / 3));
    }
    const Eigen::VectorXd free = -W * start;
    std::vector<Vec3> d;
    std::vector<GivenBlock> blocks;
    for (int i = 0; i < contacts; ++i) {
      d.push_back(free.segment<3>(3 * i));
      for (int j = 0; j < contacts; ++j) blocks.push_back({i, j, W.block<3, 3>(3 * i, 3 * j)});
    }
    FrictionProblem p = make_friction_problem(std::vector<double>(contacts, 3.0), d, blocks);
    auto& lambda = p.rows.pool<0>().lambda;
    for (int i = 0; i < contacts; ++i) lambda[std::size_t(i)] = start.segment<3>(3 * i);

    const Matrix K = root.cwiseInverse().asDiagonal() * H * inverse.cwiseSqrt();
    const Eigen::VectorXd along = (K.transpose() * K).llt().solve(K.transpose() * (root.asDiagonal() * start));
    const Eigen::VectorXd least = root.cwiseInverse().asDiagonal() * (K * along);
    bool is_inside = true;
    for (int i = 0; i < contacts; ++i) is_inside = is_inside && least.segment<2>(3 * i + 1).norm() < 2.9 * least[3 * i];
    if (!is_inside) continue;
    ++asked;
    REQUIRE(solve(p, MinimumNorm{sweeps, rows}).status == Status::converged);
    for (int i = 0; i < contacts; ++i) {
      worst = std::max(worst, (lambda[std::size_t(i)] - least.segment<3>(3 * i)).norm());
      change = std::max(change, (lambda[std::size_t(i)] - start.segment<3>(3 * i)).norm());
    }
  }
  CAPTURE(asked);
  CHECK(asked > 10);
  CHECK(change > 0.1);
  CHECK(worst < 1e-7);  // 1e-13 of λ*, where the search ends, times the condition of KᵀK, up to 1e5
}

// Two rods side by side: in a loop, over many steps, each carries half of 1 kg × g.
TEST_CASE("two equal rods in a running loop carry half of the weight each") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{DistanceJoint{}},
                     MinimumNorm{AcceleratedGaussSeidel{}}};
  auto& set = rigid_bodies(loop);
  const auto ball = set.add({.position = {0, 0, -1}, .mass = 1.0, .shape = Sphere{0.1}});
  const auto one = loop.add(DistanceJoint::Item{anchor(set, ball), world_anchor({0, 0, 0}), 1});
  for (int n = 0; n < 20; ++n) loop.step(0.01);
  const auto two = loop.add(DistanceJoint::Item{anchor(set, ball), world_anchor({0, 0, 0}), 1});
  loop.step(0.01);
  REQUIRE(loop.impulse(one)[0] == Approx(loop.impulse(two)[0]).epsilon(1e-9));
  REQUIRE(std::abs(loop.impulse(one)[0]) == Approx(0.5 * g * 0.01).epsilon(1e-6));
}

}  // namespace minimum_norm_tests
