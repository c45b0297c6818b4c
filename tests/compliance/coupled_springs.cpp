#include "scenes.hpp"

#include "catch.hpp"

#include <Eigen/Cholesky>

namespace coupled_springs_tests {

using namespace scenes;

TEST_CASE("compliance of soft rows stands on the diagonal of W, 1/(h^2 k + h c)") {
  const double h = 0.01, k = 300, c = 7;
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}};
  auto& set = loop.world().set<0>();
  const auto a = set.add({.position = {1.5, 0, 0}, .mass = 2.0});
  loop.add(DistanceJoint::Item{anchor(set, a), world_anchor({0, 0, 0}), 1.0, k, c});
  loop.step(h);
  REQUIRE(loop.problem().W.diagonal<0>(0)(0, 0) == Approx(1 / 2.0 + 1 / (h * h * k + h * c)).epsilon(1e-15));
}

// Each joint holds a particle of its own: what its impulse does to the other goes through the springs alone, and through a
// particle that no joint holds.
TEST_CASE("joints on particles that springs couple are solved together") {
  for (const double stiffness : {500., 1e5, 1e7})
    for (const bool has_middle : {false, true}) {
      AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{},
                         AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 100000}};
      auto& set = loop.world().set<0>();
      const auto a = set.add({.position = {0, 0, 0}, .mass = 1.0}), b = set.add({.position = {1, 0, 0}, .mass = 1.0});
      if (has_middle) {
        const auto middle = set.add({.position = {0.5, 0, 0}, .mass = 1.0});
        set.add_spring(a, middle, stiffness);
        set.add_spring(middle, b, stiffness);
      } else {
        set.add_spring(a, b, stiffness);
      }
      loop.add(DistanceJoint::Item{anchor(set, a), world_anchor({-1, 0, 0}), 1.1});
      loop.add(DistanceJoint::Item{anchor(set, b), world_anchor({2, 0, 0}), 1.1});
      const StepReport report = loop.step(0.01);
      CAPTURE(stiffness, has_middle);
      CHECK(report.status == Status::converged);
      auto problem = loop.problem();
      CHECK(problem.islands.count() == 1);
      CHECK(solve(problem, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure.residual <= 1e-8);
    }
}

TEST_CASE("springs that an explicit integrator leaves out of A tie no islands") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}};
  auto& set = loop.world().set<0>();
  const auto a = set.add({.position = {0, 0, 0}, .mass = 1.0}), b = set.add({.position = {1, 0, 0}, .mass = 1.0});
  set.add_spring(a, b, 500);
  loop.add(DistanceJoint::Item{anchor(set, a), world_anchor({-1, 0, 0}), 1.1});
  loop.add(DistanceJoint::Item{anchor(set, b), world_anchor({2, 0, 0}), 1.1});
  loop.step(0.01);
  CHECK(loop.problem().islands.count() == 2);
}

// A = M + h D + h² K with K = k [(1 − L/l)₊ (1 − e eᵀ) + e eᵀ], D = c e eᵀ, made dense here and factored whole.
TEST_CASE("particles coupled by springs have the W of the whole implicit system") {
  const double h = 0.02;
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}};
  auto& set = loop.world().set<0>();
  std::mt19937 random(9);
  std::uniform_real_distribution<double> draw(-1, 1);
  const int n = 8;
  std::vector<Vec3> x;
  std::vector<double> mass;
  std::vector<Particles::Handle> handles;
  for (int i = 0; i < n; ++i) {
    const double px = draw(random), py = draw(random);
    x.push_back(Vec3(px + i, py, draw(random)));
    mass.push_back(1 + 0.3 * i);
    handles.push_back(set.add({.position = x[i], .mass = mass[i]}));
  }
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int i = 0; i < n; ++i) A.block<3, 3>(3 * i, 3 * i) = mass[i] * Mat3::Identity();
  for (int i = 0; i + 1 < n; ++i) {
    const double k = 500, c = 3, rest = i % 2 ? 0.5 : 3;  // some stretched, some pressed
    set.add_spring(handles[i], handles[i + 1], k, c, rest);
    const Vec3 d = x[i] - x[i + 1];
    const double length = d.norm();
    const Mat3 along = d * d.transpose() / (length * length);
    const Mat3 K = k * (std::max(0.0, 1 - rest / length) * (Mat3::Identity() - along) + along);
    const Mat3 block = h * h * K + h * c * along;
    A.block<3, 3>(3 * i, 3 * i) += block;
    A.block<3, 3>(3 * i + 3, 3 * i + 3) += block;
    A.block<3, 3>(3 * i, 3 * i + 3) -= block;
    A.block<3, 3>(3 * i + 3, 3 * i) -= block;
  }
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(4, 3 * n);
  for (int r = 0; r < 4; ++r) {
    loop.add(DistanceJoint::Item{anchor(set, handles[r]), anchor(set, handles[r + 4]), 1.0});
    const Vec3 e = (x[r] - x[r + 4]).normalized();
    H.block<1, 3>(r, 3 * r) = e.transpose();
    H.block<1, 3>(r, 3 * (r + 4)) = -e.transpose();
  }
  loop.step(h);
  const Eigen::MatrixXd expected = H * Eigen::LDLT<Eigen::MatrixXd>(A).solve(H.transpose());
  const auto problem = loop.problem();
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(4, 4);
  const auto blocks = problem.W.blocks<0, 0>();
  for (int i = 0; i < 4; ++i) {
    W(i, i) = problem.W.diagonal<0>(i)(0, 0);
    for (Index e = blocks.start[i]; e < blocks.start[i + 1]; ++e) W(i, blocks.column[e]) = blocks.block[e](0, 0);
  }
  // cond(A) < 100, so both inverses are right to 1e-14; 1e-12 leaves two digits.
  REQUIRE((W - expected).cwiseAbs().maxCoeff() <= 1e-12 * expected.cwiseAbs().maxCoeff());
  REQUIRE(expected.cwiseAbs().minCoeff() > 1e-6 * expected.cwiseAbs().maxCoeff());  // the springs do couple all rows
}

TEST_CASE("the matrix-free operator refuses coupled springs and names the builder that takes them") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{}, MatrixFreeCompliance{}};
  auto& set = loop.world().set<0>();
  const auto a = set.add({.position = {0, 0, 0}, .mass = 1.0}), b = set.add({.position = {1, 0, 0}, .mass = 1.0});
  set.add_spring(a, b, 100);
  loop.add(DistanceJoint::Item{anchor(set, a), world_anchor({0, 0, 1}), 1.0});
  REQUIRE_THROWS_WITH(loop.step(0.01), Catch::Contains("springs between particles couple A under an implicit integrator") &&
                                           Catch::Contains("use AssembledCompliance"));
}

TEST_CASE("the matrix-free operator takes the same springs under an explicit integrator") {
  AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, MatrixFreeCompliance{}};
  auto& set = loop.world().set<0>();
  const auto a = set.add({.position = {0, 0, 0}, .mass = 1.0}), b = set.add({.position = {1, 0, 0}, .mass = 1.0});
  set.add_spring(a, b, 100);
  loop.add(DistanceJoint::Item{anchor(set, a), world_anchor({0, 0, 1}), 1.0});
  REQUIRE(loop.step(0.01).status == Status::converged);
}

}  // namespace coupled_springs_tests
