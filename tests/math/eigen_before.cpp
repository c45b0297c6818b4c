// A file that has read Eigen before the library. Its singular values are in eigen_after.cpp: they take long to compile.
#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <delassus/delassus.hpp>

#include "catch.hpp"

namespace eigen_before_tests {

using namespace delassus;

TEST_CASE("Eigen's transforms and factorizations are there before the library") {
  const Quat turn(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
  const Eigen::Isometry3d move = Eigen::Translation3d(1, 2, 3) * turn;
  const Vec3 x(0.2, -1, 4);
  CHECK((move * x - (turn * x + Vec3(1, 2, 3))).norm() < 1e-14);
  CHECK((move.inverse() * (move * x) - x).norm() < 1e-14);
  Eigen::Matrix3d A;
  A << 2, 1, 0, 1, 3, 1, 0, 1, 4;
  CHECK((A * A.ldlt().solve(x) - x).norm() < 1e-14);
  const Eigen::Hyperplane<double, 3> plane(Vec3::UnitZ(), Vec3(0, 0, 1));
  CHECK(plane.signedDistance(x) == Approx(3));
}

}  // namespace eigen_before_tests
