// The library reads a part of Eigen's geometry; what a file includes after it has all of it.
#include <delassus/math/linear.hpp>

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include "catch.hpp"

namespace eigen_after_tests {

using namespace delassus;

TEST_CASE("Eigen's transforms and factorizations are there after the library") {
  const Quat turn(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
  const Eigen::Isometry3d move = Eigen::Translation3d(1, 2, 3) * turn;
  const Vec3 x(0.2, -1, 4);
  CHECK((move * x - (turn * x + Vec3(1, 2, 3))).norm() < 1e-14);
  CHECK((move.inverse() * (move * x) - x).norm() < 1e-14);
  Eigen::Matrix3d A;
  A << 2, 1, 0, 1, 3, 1, 0, 1, 4;
  CHECK((A * A.ldlt().solve(x) - x).norm() < 1e-14);
  CHECK((A * A.jacobiSvd(Eigen::ComputeFullU | Eigen::ComputeFullV).solve(x) - x).norm() < 1e-13);
  const Eigen::Hyperplane<double, 3> plane(Vec3::UnitZ(), Vec3(0, 0, 1));
  CHECK(plane.signedDistance(x) == Approx(3));
  CHECK(Eigen::umeyama(Eigen::Matrix3d(A), Eigen::Matrix3d(A), false).isIdentity(1e-12));
}

}  // namespace eigen_after_tests
