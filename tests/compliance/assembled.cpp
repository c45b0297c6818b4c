#include "scenes.hpp"

#include "catch.hpp"

#include <Eigen/Cholesky>

namespace assembled_tests {

using namespace scenes;

namespace {

/// Twelve bodies with forty contacts and six ball joints, one step in.
template <class Builder>
auto mixed_scene(Builder builder, unsigned seed, int sweeps) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}}, GivenContacts{},
                     builder, GaussSeidel{.tolerance = 0, .max_iterations = sweeps, .min_iterations = sweeps}};
  auto& set = rigid_bodies(loop);
  loop.template get<GivenContacts>().points = add_cluster(set, 12, 40, seed, -1e-3);
  for (int k = 0; k < 5; ++k)
    loop.add(BallJoint::Item{anchor(set, set.handle(k), Vec3(0.1, 0.2, k)), anchor(set, set.handle(k + 5), Vec3(1, 0, 0))});
  loop.add(BallJoint::Item{anchor(set, set.handle(7), Vec3(0, 0, 1)), world_anchor({1, 1, 1})});
  return loop;
}

constexpr int rows = 3 * 46;

/// H from the contacts and anchors alone, in the state the step starts from.
template <class Loop>
Eigen::MatrixXd dense_directions(Loop& loop) {
  const auto& set = rigid_bodies(loop);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(rows, 6 * set.blocks());
  int row = 0;
  for (const ContactPoint& p : loop.template get<GivenContacts>().points) {
    const Vec3 middle = 0.5 * (p.point_a + p.point_b);
    add_dense_rows(H, row, set, set.moves(p.a) ? p.a : -1, set.moves(p.b) ? p.b : -1, middle, contact_frame(p.normal));
    row += 3;
  }
  const auto joint = [&](Index a, const Vec3& local_a, Index b, const Vec3& end_b) {
    const Vec3 xa = set.pose(a).to_world(local_a), xb = b < 0 ? end_b : set.pose(b).to_world(end_b);
    add_dense_rows(H, row, set, b, set.moves(a) ? a : -1, 0.5 * (xa + xb), Mat3::Identity());
    row += 3;
  };
  for (int k = 0; k < 5; ++k) joint(k, Vec3(0.1, 0.2, k), k + 5, Vec3(1, 0, 0));
  joint(7, Vec3(0, 0, 1), -1, Vec3(1, 1, 1));
  return H;
}

template <class Problem>
Eigen::MatrixXd dense_operator(const Problem& problem) {
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(rows, rows);
  int first_a = 0;
  for_each_index<2>([&](auto a) {
    int first_b = 0;
    for_each_index<2>([&](auto b) {
      const auto blocks = problem.W.template blocks<a, b>();
      for (Index i = 0; i < problem.rows.template pool<a>().items(); ++i)
        for (Index e = blocks.start[i]; e < blocks.start[i + 1]; ++e)
          W.block<3, 3>(first_a + 3 * i, first_b + 3 * blocks.column[e]) = blocks.block[e];
      first_b += 3 * problem.rows.template pool<b>().items();
    });
    for (Index i = 0; i < problem.rows.template pool<a>().items(); ++i)
      W.block<3, 3>(first_a + 3 * i, first_a + 3 * i) = problem.W.template diagonal<a>(i);
    first_a += 3 * problem.rows.template pool<a>().items();
  });
  return W;
}

}  // namespace

// Each entry is a sum of about ten products of numbers that are themselves right to a few roundings.
TEST_CASE("the assembled W is H A^-1 H^T") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    auto loop = mixed_scene(AssembledCompliance{}, seed, 1);
    const Eigen::MatrixXd H = dense_directions(loop), inverse = dense_inverse(rigid_bodies(loop));
    const Eigen::MatrixXd expected = H * inverse * H.transpose();
    loop.step(0.01);
    const Eigen::MatrixXd W = dense_operator(loop.problem());
    REQUIRE((W - expected).cwiseAbs().maxCoeff() <= 1e-13 * expected.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("the assembled W is symmetric and positive semidefinite") {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    auto loop = mixed_scene(AssembledCompliance{}, seed, 1);
    loop.step(0.01);
    const Eigen::MatrixXd W = dense_operator(loop.problem());
    const double size = W.cwiseAbs().maxCoeff();
    REQUIRE((W - W.transpose()).cwiseAbs().maxCoeff() <= 1e-14 * size);
    // 138 rows on 66 velocities: half the eigenvalues are zero, computed to n ulp of the largest. Cholesky succeeds when
    // the matrix lifted by that much is positive definite, and fails when it is lowered by it.
    const double rounding = rows * 1e-15 * W.trace();
    const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(rows, rows);
    REQUIRE(Eigen::LLT<Eigen::MatrixXd>(W + rounding * one).info() == Eigen::Success);
    REQUIRE(Eigen::LLT<Eigen::MatrixXd>(W - rounding * one).info() != Eigen::Success);
  }
}

// A body that does not move answers no impulse: A^-1 = 0, and its products are no blocks of W. Each sphere has its one contact.
TEST_CASE("constraints that meet at a kinematic body alone have no block in W") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}}};
  auto& set = rigid_bodies(loop);
  set.add({.shape = Box{4, 1, 1}, .motion = Motion::kinematic});
  for (const double x : {-1., 0., 1.}) set.add({.position = {x, 0, 0.7}, .mass = 1., .shape = Sphere{0.2}});
  loop.step(0.01);
  const auto problem = loop.problem();
  REQUIRE(problem.rows.template pool<0>().items() == 3);
  CHECK(problem.W.template blocks<0, 0>().column.empty());
  for (Index i = 0; i < 3; ++i) CHECK(problem.W.template diagonal<0>(i)(0, 0) > 0);
}

}  // namespace assembled_tests
