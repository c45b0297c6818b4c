// Deformable bodies in the loop, held by joints.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include <limits>

#include "catch.hpp"
#include "soft_scenes.hpp"
#include "stages.hpp"

namespace soft_joints_tests {

using namespace delassus;
using namespace soft_scenes;

namespace {

using Soft = TetrahedralFem<Corotational>;

/// A soft bar clamped at one end; a rigid ball hangs on a point inside of an element and on a node, and
/// another bar, free, on a third.
struct Hanging {
  AnimationLoop<World<RigidBodies, Soft>, Constraints<BallJoint>, ImplicitEuler, AcceleratedGaussSeidel> loop;
  Soft& soft = bodies<Soft>(loop.world());
  RigidBodies& rigid = bodies<RigidBodies>(loop.world());
  Soft::BodyHandle bar, second;
  RigidBodies::Handle ball;

  explicit Hanging(double tolerance = 1e-10)
      : loop{World{RigidBodies{}, Soft{}}, Constraints{BallJoint{}},
             ImplicitEuler{.rayleigh_stiffness = 0.01},
             AcceleratedGaussSeidel{.tolerance = tolerance, .max_iterations = 5000}},
        bar(soft.add({.mesh = box_mesh({1, 0.2, 0.2}, {5, 1, 1}), .elasticity = {.young = 3e5}})),
        second(soft.add({.mesh = box_mesh({0.6, 0.2, 0.2}, {3, 1, 1}),
                         .elasticity = {.young = 1e5},
                         .position = {1, 0, 0}})),
        ball(rigid.add({.position = {0.5, 0.1, -0.5}, .mass = 3, .shape = Sphere{0.1}})) {
    soft.fix(bar, [](const Vec3& x) { return x[0] < 1e-9; });
    loop.add(BallJoint::Item{soft.anchor_at(bar, {0.47, 0.12, 0.05}),
                             anchor_at(rigid, ball, Vec3(0.47, 0.12, 0.05))});
    loop.add(BallJoint::Item{anchor(soft, soft.node(bar, 5)), anchor(soft, soft.node(second, 0))});
    loop.add(BallJoint::Item{anchor(soft, soft.node(bar, 11)), anchor(soft, soft.node(second, 4))});
  }
};

/// A dense matrix by plain loops: Eigen's would cost a gigabyte of compiler memory here.
struct Dense {
  Index rows, columns;
  std::vector<double> entry = std::vector<double>(std::size_t(rows) * columns, 0.0);

  double& operator()(Index i, Index j) { return entry[std::size_t(i) * columns + j]; }
  double operator()(Index i, Index j) const { return entry[std::size_t(i) * columns + j]; }
  /// this · otherᵀ.
  Dense times_transposed(const Dense& other) const {
    Dense product{rows, other.rows};
    for (Index i = 0; i < rows; ++i)
      for (Index j = 0; j < other.rows; ++j)
        for (Index k = 0; k < columns; ++k) product(i, j) += (*this)(i, k) * other(j, k);
    return product;
  }
  double largest() const {
    double most = 0;
    for (const double x : entry) most = std::max(most, std::abs(x));
    return most;
  }
  double distance(const Dense& other) const {
    double most = 0;
    for (std::size_t k = 0; k < entry.size(); ++k) most = std::max(most, std::abs(entry[k] - other.entry[k]));
    return most;
  }
  /// The smallest pivot of Cholesky's factorization: positive if and only if the matrix is positive definite.
  double smallest_pivot() const {
    Dense A = *this;
    double least = std::numeric_limits<double>::infinity();
    for (Index k = 0; k < rows; ++k) {
      least = std::min(least, A(k, k));
      for (Index i = k + 1; i < rows; ++i)
        for (Index j = k + 1; j < rows; ++j) A(i, j) -= A(i, k) * A(k, j) / A(k, k);
    }
    return least;
  }
};

/// W, rows in the order of the items.
template <class Problem>
Dense dense(const Problem& problem) {
  const Index n = problem.rows.template pool<0>().items();
  Dense W{3 * n, 3 * n};
  const auto blocks = problem.W.template blocks<0, 0>();
  for (Index i = 0; i < n; ++i) {
    const auto put = [&](Index column, const Mat3& block) {
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) W(3 * i + k, 3 * column + l) = block(k, l);
    };
    put(i, problem.W.template diagonal<0>(i));
    for (Index e = blocks.start[i]; e < blocks.start[i + 1]; ++e) put(blocks.column[e], blocks.block[e]);
  }
  return W;
}

/// H, columns: 6 for the ball, then 3 a node.
template <class Problem>
Dense dense_jacobian(const Problem& problem, Index nodes) {
  const auto& pool = problem.rows.template pool<0>();
  Dense H{3 * pool.items(), 6 + 3 * nodes};
  const auto add = [&](const auto& set, Index i, int width, Index first) {
    for (Index e = set.offset[i]; e < set.offset[i + 1]; ++e)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < width; ++l) H(3 * i + k, first + width * set.block[e] + l) += set.H[e](k, l);
  };
  for (Index i = 0; i < pool.items(); ++i) {
    add(inner::part<0>(pool.sets), i, 6, 0);
    add(inner::part<1>(pool.sets), i, 3, 6);
  }
  return H;
}

}  // namespace

TEST_CASE("W of soft and rigid bodies is symmetric, positive, and H A^-1 H^T of a dense A") {
  Hanging s;
  for (int n = 0; n < 20; ++n) s.loop.step(0.01);
  // A is that of a step's start: the stages up to W, then A⁻¹ column by column, a solve for every unit
  // impulse.
  stage::begin(s.loop.data(), 0.01);
  linearize_to_build(s.loop.data());
  const auto problem = s.loop.problem();
  const Index nodes = s.soft.blocks();
  const Dense W = dense(problem), H = dense_jacobian(problem, nodes);
  Dense inverse{H.columns, H.columns};
  for (int k = 0; k < 6; ++k) {
    Vec<6> e = Vec<6>::Zero();
    e[k] = 1;
    const Vec<6> x = s.rigid.solve_block<1>(0, e);
    for (int l = 0; l < 6; ++l) inverse(l, k) = x[l];
  }
  for (Index j = 0; j < 3 * nodes; ++j) {
    std::vector<Vec3> x(nodes, Vec3::Zero());
    x[j / 3][j % 3] = 1;
    s.soft.solve(x);
    for (Index b = 0; b < nodes; ++b)
      for (int k = 0; k < 3; ++k) inverse(6 + 3 * b + k, 6 + j) = x[b][k];
  }
  const Dense full = H.times_transposed(inverse).times_transposed(H);
  CHECK(full.rows == 9);
  CHECK(W.distance(full) < 1e-10 * full.largest());
  Dense transposed{9, 9};
  for (Index i = 0; i < 9; ++i)
    for (Index j = 0; j < 9; ++j) transposed(i, j) = W(j, i);
  CHECK(W.distance(transposed) < 1e-13 * W.largest());
  CHECK(W.smallest_pivot() > 0);
  // The ball's joint and the others share no node: only A⁻¹ couples them.
  double coupling = 0;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 3; j < 9; ++j) coupling = std::max(coupling, std::abs(W(i, j)));
  CHECK(coupling > 1e-4 * W.largest());
}

TEST_CASE("the corrective motion is W lambda seen from the constraints, H (v_next - v_free) = W lambda") {
  Hanging s;
  for (int n = 0; n < 5; ++n) {
    s.loop.step(0.01);
    const auto problem = s.loop.problem();
    const Dense W = dense(problem), H = dense_jacobian(problem, s.soft.blocks());
    Dense change{1, H.columns}, lambda{1, H.rows};
    for (int k = 0; k < 6; ++k) change(0, k) = s.rigid.v_next[0][k] - s.rigid.v_free[0][k];
    for (Index b = 0; b < s.soft.blocks(); ++b)
      for (int k = 0; k < 3; ++k) change(0, 6 + 3 * b + k) = s.soft.v_next[b][k] - s.soft.v_free[b][k];
    for (Index i = 0; i < H.rows; ++i) lambda(0, i) = problem.rows.pool<0>().lambda[i / 3][i % 3];
    REQUIRE(lambda.largest() > 1e-3);
    const Dense motion = H.times_transposed(change), expected = W.times_transposed(lambda);
    // 64 ε of v_free, which the stage rounds off, and the roundings of two sums.
    CHECK(motion.distance(expected) < 1e-12 * expected.largest() + 1e-13);
  }
}

TEST_CASE("joints between soft bodies hold to the solver's tolerance, and all is one island") {
  Hanging s(1e-10);
  double worst = 0;
  for (int n = 0; n < 100; ++n) {
    const StepReport report = s.loop.step(0.005);
    REQUIRE(report.status == Status::converged);
    REQUIRE(report.islands == 1);
    // u⁺ = W λ + d of every row, m/s, against velocities of about 1 m/s.
    const auto problem = s.loop.problem();
    for (Index i = 0; i < 3; ++i)
      worst = std::max(worst, problem.W.template residual<0>(problem.rows, i).norm());
  }
  CHECK(worst > 0);
  CHECK(worst < 1e-8);
  CHECK(s.loop.report().max_joint_violation <
        1e-4);  // second order in h: |v × ω| h² of some links that swing
}

TEST_CASE("what a soft column hangs on carries its weight when it has come to rest") {
  AnimationLoop loop{World{Soft{}}, Constraints{BallJoint{}},
                     ImplicitEuler{.rayleigh_mass = 5, .rayleigh_stiffness = 0.05},
                     AcceleratedGaussSeidel{.tolerance = 1e-12, .max_iterations = 5000}};
  auto& soft = bodies<Soft>(loop.world());
  const auto column =
      soft.add({.mesh = box_mesh({0.2, 0.2, 1}, {1, 1, 5}), .elasticity = {.young = 1e5}, .density = 500});
  std::vector<ConstraintHandle<BallJoint>> hooks;
  for (Index k = 20; k < 24; ++k) {
    const auto node = soft.node(column, k);
    hooks.push_back(loop.add(BallJoint::Item{world_anchor(soft.position(node)), anchor(soft, node)}));
  }
  for (int n = 0; n < 2000; ++n) loop.step(0.01);
  Vec3 sum = Vec3::Zero();
  for (const auto hook : hooks) sum += loop.impulse(hook) / 0.01;
  CHECK(std::abs(std::abs(sum[2]) - 500 * 0.04 * 9.81) < 1e-8);  // decayed by exp(−5/2 · 20)
  CHECK(std::abs(sum[0]) + std::abs(sum[1]) < 1e-8);
}

TEST_CASE("a soft body that is given a force that is no number stays where it was, and no other notices") {
  const auto run = [](bool is_nonfinite) {
    AnimationLoop loop{World{Soft{}}, Constraints{BallJoint{}}, ImplicitEuler{}};
    auto& soft = bodies<Soft>(loop.world());
    std::vector<Soft::BodyHandle> bars;
    for (int k = 0; k < 2; ++k) {
      bars.push_back(soft.add({.mesh = cube(1), .elasticity = {.young = 1e4}, .position = {3.0 * k, 0, 0}}));
      const auto node = soft.node(bars[k], 7);
      loop.add(BallJoint::Item{world_anchor(soft.position(node)), anchor(soft, node)});
    }
    std::vector<Vec3> x;
    for (int n = 0; n < 20; ++n) {
      const double nan = std::numeric_limits<double>::quiet_NaN();
      if (is_nonfinite && n == 5) soft.apply_force(soft.node(bars[0], 2), {nan, 0, 0});
      loop.step(0.01);
      if (is_nonfinite && n == 5) CHECK(loop.report().status == Status::quarantined);
      if (is_nonfinite) CHECK(is_finite(soft.position(soft.node(bars[0], 2))));
      for (Index k = 0; k < 8; ++k) x.push_back(soft.position(soft.node(bars[1], k)));
    }
    CHECK(loop.report().islands == 2);
    CHECK(loop.problem().W.template blocks<0, 0>().column.empty());  // W has no block between the two bodies
    return x;
  };
  CHECK(run(false) == run(true));
}

TEST_CASE("a soft body that is taken out takes its joints with it, and the others go on") {
  Hanging s;
  for (int n = 0; n < 5; ++n) s.loop.step(0.01);
  CHECK(s.loop.report().rows == 9);
  s.loop.remove(s.second);
  s.loop.step(0.01);
  CHECK(s.loop.report().rows == 3);
  CHECK(s.loop.report().status == Status::converged);
  CHECK_THROWS_AS(s.loop.remove(s.second), InvalidArgument);
}

}  // namespace soft_joints_tests
