#include <delassus/constraints/contact/cone.hpp>
#include <delassus/constraints/contact/coulomb.hpp>

#include "catch.hpp"

#include <random>
#include <vector>

namespace coulomb_tests {

using namespace delassus;

namespace {

struct Draw {
  std::mt19937 random{11};
  double operator()(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
  Vec3 vector(double size) { return {(*this)(-size, size), (*this)(-size, size), (*this)(-size, size)}; }

  /// Positive definite with a condition number of at most about 100; `skewness` > 0 makes it unsymmetric.
  Mat3 block(double skewness) {
    Mat3 a;
    for (int i = 0; i < 9; ++i) a(i) = (*this)(-1, 1);
    return a * a.transpose() + 0.05 * Mat3::Identity() + skewness * skew(vector(1));
  }
};

Vec3 solve_contact(const Mat3& W, const Vec3& b, double friction) {
  const Coulomb law;
  Coulomb::Memory<double> memory;
  law.prepare(W, memory);
  return law.solve_local({friction}, W, b, memory);
}

/// Every solution of the law, by another road than the library's: no multiplier α, no elimination. In a slip along the
/// angle a, λ = λ_n (1, μ cos a, μ sin a) and u_n = 0 give λ_n; a is right where u_t is antiparallel to λ_t, that is where
/// their cross product changes sign. 7200 angles are tried and each change of sign is bisected.
struct BruteForce {
  Mat3 W;
  Vec3 b;
  double friction;

  Vec3 at(double angle) const {
    const Vec3 ray(1, friction * std::cos(angle), friction * std::sin(angle));
    return (-b[0] / W.row(0).dot(ray)) * ray;
  }
  double across(double angle) const {
    const Vec3 u = W * at(angle) + b;
    return u[1] * std::sin(angle) - u[2] * std::cos(angle);
  }
  std::vector<Vec3> solutions() const {
    std::vector<Vec3> found;
    if (b[0] >= 0) found.push_back(Vec3::Zero());
    const Vec3 stick = -W.partialPivLu().solve(b);
    if (stick.tail<2>().norm() <= friction * stick[0]) found.push_back(stick);
    const int count = 7200;
    const double step = 2 * M_PI / count;
    for (int k = 0; k < count; ++k) {
      double low = k * step, high = low + step;
      const bool is_up = across(low) < 0;
      if (is_up == (across(high) < 0)) continue;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        ((across(middle) < 0) == is_up ? low : high) = middle;
      }
      const Vec3 lambda = at(low), u = W * lambda + b;
      if (lambda[0] > 0 && std::abs(u[0]) < 1e-9 && u.tail<2>().dot(lambda.tail<2>()) <= 0) found.push_back(lambda);
    }
    return found;
  }
};

}  // namespace

// The natural map is a difference of numbers of size w |λ| <= cond(W) |b|; with cond <= 100 and the lift of 64 ulp of the
// trace, 1e-12 |b| is a few hundred roundings.
TEST_CASE("one contact meets Coulomb's law exactly") {
  Draw draw;
  for (int n = 0; n < 20000; ++n) {
    const Mat3 W = draw.block(n % 2 ? 0.02 : 0);
    const Vec3 b = draw.vector(2);
    const double friction = n % 10 == 0 ? 0 : draw(0, 2);
    const Vec3 lambda = solve_contact(W, b, friction), u = W * lambda + b;
    const Vec3 error = coulomb_natural_map<double>(lambda, u, friction, W.trace() / 3);
    CAPTURE(n, friction);
    REQUIRE(error.norm() <= 1e-12 * std::max(b.norm(), W.norm() * lambda.norm()));
  }
}

// Bisection leaves the angle within 1e-15 rad, the change of λ with it is at most cond(W) times that.
TEST_CASE("one contact has the impulse that a search over all slip directions finds") {
  Draw draw;
  int slips = 0;
  for (int n = 0; n < 600; ++n) {
    const Mat3 W = draw.block(n % 2 ? 0.02 : 0);
    Vec3 b = draw.vector(2);
    b[0] = -std::abs(b[0]);
    const double friction = draw(0, 2);
    const Vec3 lambda = solve_contact(W, b, friction);
    double nearest = 1e300;
    for (const Vec3& s : BruteForce{W, b, friction}.solutions()) nearest = std::min(nearest, (s - lambda).norm());
    slips += std::abs(lambda.tail<2>().norm() - friction * lambda[0]) < 1e-12 * lambda.norm();
    CAPTURE(n, friction);
    REQUIRE(nearest <= 1e-11 * (1 + lambda.norm()));
  }
  REQUIRE(slips > 100);
}

TEST_CASE("the multiplier remembered from the last visit changes no result") {
  Draw draw;
  const Coulomb law;
  for (int n = 0; n < 200; ++n) {
    const Mat3 W = draw.block(0);
    Coulomb::Memory<double> memory;
    law.prepare(W, memory);
    for (int visit = 0; visit < 5; ++visit) {
      const Vec3 b = draw.vector(1);
      const Vec3 lambda = law.solve_local({0.4}, W, b, memory);
      // Both meet the same law to 1e-12; where it has one solution (mu = 0.4, mild blocks) they agree to cond times that.
      REQUIRE((lambda - solve_contact(W, b, 0.4)).norm() <= 1e-10 * (1 + lambda.norm()));
    }
  }
}

TEST_CASE("a slipping impulse lies on the cone to rounding") {
  Draw draw;
  for (int n = 0; n < 2000; ++n) {
    const double friction = draw(0.01, 2);
    const Vec3 b(-draw(0.1, 1), draw(-9, 9), draw(-9, 9));
    const Vec3 lambda = solve_contact(Mat3::Identity(), b, friction);
    if (b.tail<2>().norm() <= -friction * b[0]) continue;
    REQUIRE(lambda.tail<2>().norm() == Approx(friction * lambda[0]).epsilon(1e-15));
    REQUIRE(Coulomb{}.is_sliding({friction}, lambda));
  }
}

TEST_CASE("without friction Coulomb's law is Signorini's") {
  Draw draw;
  for (int n = 0; n < 500; ++n) {
    const Mat3 W = draw.block(0);
    const Vec3 b = draw.vector(1);
    const Vec3 lambda = solve_contact(W, b, 0);
    REQUIRE(lambda.tail<2>().norm() == 0);
    REQUIRE(lambda[0] == Approx(std::max(0.0, -b[0] / W(0, 0))).epsilon(1e-12).margin(1e-14));
  }
}

// The Schur complement of a block of condition c keeps epsilon c = 2e-8; fifty times that covers the two solves on it.
TEST_CASE("a block of condition 1e8 still meets the law to 1e-6") {
  Draw draw;
  for (int n = 0; n < 5000; ++n) {
    const Mat3 turn = Eigen::AngleAxisd(draw(0, 3), draw.vector(1).normalized()).toRotationMatrix();
    const Mat3 W = turn * Vec3(1, draw(0, 1), 1e-8).asDiagonal() * turn.transpose();
    const Vec3 b = W * draw.vector(1);
    const Vec3 lambda = solve_contact(W, b, 0.6);
    const Vec3 error = coulomb_natural_map<double>(lambda, W * lambda + b, 0.6, W.trace() / 3);
    CAPTURE(n);
    REQUIRE(error.norm() <= 1e-6 * std::max(b.norm(), W.norm() * lambda.norm()));
  }
}

// n stands alone, so that λ_n = −b_n/W_nn = 1. It slips: λ_t lies on the cone, against u_t.
TEST_CASE("a block that is stiff in one direction keeps the law in the others") {
  for (const double stiff : {1e4, 1e8, 1e9, 1e12}) {
    const Mat3 W = Vec3(1, 1, stiff).asDiagonal();
    const Vec3 b(-1, 1, 0.3), lambda = solve_contact(W, b, 0.5), u = W * lambda + b;
    CAPTURE(stiff);
    CHECK(std::abs(lambda[0] - 1) < 1e-14);
    CHECK(lambda.tail<2>().norm() == Approx(0.5).epsilon(1e-14));
    CHECK(std::abs(u[1] * lambda[2] - u[2] * lambda[1]) < 1e-12);
    CHECK(u.tail<2>().dot(lambda.tail<2>()) < 0);
  }
}

TEST_CASE("a singular block gives a finite impulse inside the cone") {
  Draw draw;
  for (int n = 0; n < 5000; ++n) {
    const Vec3 x = draw.vector(1), y = draw.vector(1);
    const Mat3 W = x * x.transpose() + (n % 2) * y * y.transpose();
    const Vec3 lambda = solve_contact(W, draw.vector(1), 0.6);
    CAPTURE(n);
    REQUIRE(is_finite(lambda));
    REQUIRE(lambda[0] >= 0);
    REQUIRE(lambda.tail<2>().norm() <= 0.6 * lambda[0] * (1 + 1e-15));
  }
}

TEST_CASE("in single precision the law holds to single precision") {
  Draw draw;
  const Coulomb law;
  for (int n = 0; n < 5000; ++n) {
    const Mat<3, 3, float> W = draw.block(0).cast<float>();
    const Vec<3, float> b = draw.vector(2).cast<float>();
    const double friction = draw(0, 2);
    Coulomb::Memory<float> memory;
    law.prepare(W, memory);
    const Vec3 lambda = law.solve_local({friction}, W, b, memory).cast<double>(), u = W.cast<double>() * lambda + b.cast<double>();
    const Vec3 error = coulomb_natural_map<double>(lambda, u, friction, W.cast<double>().trace() / 3);
    // The bound of double precision times 2^29, the ratio of the two roundings.
    REQUIRE(error.norm() <= 5e-4 * std::max(double(b.norm()), double(W.norm()) * lambda.norm()));
  }
}

// The fourth powers of 1e-70 m/s have all their digits, those of slower ones have not.
TEST_CASE("a contact that closes too slowly for its powers stays open, one that is faster meets the law") {
  const Mat3 W = Vec3(1, 2, 3).asDiagonal();
  CHECK(solve_contact(W, {-9e-71, 3e-69, -2e-69}, 0.5) == Vec3::Zero());
  CHECK(solve_contact(W, {-1e-160, 1e-160, 0}, 0.5) == Vec3::Zero());
  const Vec3 slow = solve_contact(W, {-1e-69, 3e-69, -2e-69}, 0.5);
  const Vec3 fast = solve_contact(W, {-1, 3, -2}, 0.5);
  CHECK((1e69 * slow - fast).norm() <= 1e-13);
}

}  // namespace coulomb_tests
