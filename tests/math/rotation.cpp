#include <delassus/math/rotation.hpp>

#include <limits>
#include <numbers>

#include "catch.hpp"

using namespace delassus;

namespace {

/// The inertia of a body that tumbles: three distinct moments (kg m²).
Mat3 tumbler() { return Vec3(1, 2, 3).asDiagonal(); }

/// The mean rate of a free step of h seconds: the momentum after the impulse is the one before.
Vec3 free_rate(const Mat3& inertia, const Vec3& rate, double h) {
  const Vec3 momentum = inertia * rate;
  return midpoint_rate<double>(inertia, rate, momentum, momentum, h).rate;
}

TEST_CASE("a turn by so many radians that their squares overflow is half a turn") {
  for (const double angle : {1e100, 1e155, 1e300, 1.7e308}) {
    const Quat q = cayley(Vec3(Vec3(0, 0.6, -0.8) * angle));
    CHECK(std::abs(q.coeffs().norm() - 1) <= 8 * std::numeric_limits<double>::epsilon());
    CHECK((q.vec() - Vec3(0, 0.6, -0.8)).norm() <= 8 * std::numeric_limits<double>::epsilon());
  }
}

}  // namespace

TEST_CASE("the exponential of a vector along z is a turn by its length") {
  const double angle = 0.7;
  const Quat q = exponential(Vec3(0, 0, angle));
  REQUIRE((q * Vec3(1, 0, 0) - Vec3(std::cos(angle), std::sin(angle), 0)).norm() < 1e-15);
}

TEST_CASE("the series of the exponential meets the closed form where they change over") {
  // Below 1e-3 the series drops x⁴/3840 < 3e-16: both sides of the seam agree to rounding.
  for (const double angle : {0.999999e-3, 1.000001e-3}) {
    const Quat q = exponential(Vec3(angle, 0, 0));
    REQUIRE(q.x() == Approx(std::sin(angle / 2)).epsilon(1e-15));
    REQUIRE(q.norm() == Approx(1).epsilon(1e-15));
  }
}

TEST_CASE("the logarithm undoes the exponential up to half a turn") {
  for (const double angle : {0.0, 1e-14, 1e-8, 1e-3, 1.0, 3.0, std::numbers::pi - 1e-6}) {
    const Vec3 theta = angle * Vec3(2, -1, 2) / 3;
    // atan2 and the norm are good to a few eps of the angle, at most π.
    REQUIRE((logarithm(exponential(theta)) - theta).norm() < 1e-15 + 4e-15 * angle);
  }
}

TEST_CASE("a quaternion and its opposite have one logarithm") {
  const Quat q = exponential(Vec3(0.3, 0.2, -0.1));
  const Quat opposite(-q.w(), -q.x(), -q.y(), -q.z());
  REQUIRE(logarithm(q) == logarithm(opposite));
}

TEST_CASE("the Cayley map is (I - a/2)^-1 (I + a/2)") {
  const Vec3 theta(0.4, -0.3, 0.9);
  const Mat3 half = skew(theta) / 2;
  const Mat3 expected = (Mat3::Identity() - half).inverse() * (Mat3::Identity() + half);
  REQUIRE((cayley(theta).toRotationMatrix() - expected).norm() < 1e-15 * 10);
}

TEST_CASE("the Cayley map differs from the exponential by a third-order term") {
  const Vec3 axis = Vec3(1, 2, 2) / 3;
  // cayley(θ) turns by 2 atan(θ/2) = θ − θ³/12 + …: halving θ divides the difference by 8.
  const auto difference = [&](double angle) {
    return logarithm(exponential<double>(angle * axis) * cayley<double>(angle * axis).conjugate()).norm();
  };
  REQUIRE(difference(0.1) / difference(0.05) == Approx(8).epsilon(0.01));
  REQUIRE(difference(0.1) == Approx(0.1 * 0.1 * 0.1 / 12).epsilon(0.01));
}

TEST_CASE("the midpoint rule keeps the energy and the angular momentum of a tumbling body") {
  const Mat3 inertia = tumbler();
  Vec3 rate(0.1, 2, 0.1);  // about the middle axis: the unstable one
  Quat turn = Quat::Identity();
  const double h = 0.01;
  const double energy = rate.dot(inertia * rate) / 2;
  const Vec3 momentum = inertia * rate;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 mid = free_rate(inertia, rate, h);
    rate = 2 * mid - rate;
    turn = (turn * cayley<double>(h * mid)).normalized();
  }
  // Both hold exactly but for rounding: 2000 steps of a few eps each, relative to 4 J and 4 kg m²/s.
  REQUIRE(rate.dot(inertia * rate) / 2 == Approx(energy).epsilon(1e-12));
  REQUIRE((turn * (inertia * rate) - momentum).norm() < 1e-11);
}

TEST_CASE("the midpoint rule is of second order") {
  const Mat3 inertia = tumbler();
  const auto rate_after_one_second = [&](int steps) {
    Vec3 rate(1, 0.5, 0.7);
    for (int i = 0; i < steps; ++i) rate = 2 * free_rate(inertia, rate, 1.0 / steps) - rate;
    return rate;
  };
  const Vec3 fine = rate_after_one_second(3200);
  const double coarse = (rate_after_one_second(50) - fine).norm();
  const double halved = (rate_after_one_second(100) - fine).norm();
  REQUIRE(coarse / halved == Approx(4).epsilon(0.02));
}

TEST_CASE("a body that turns about a principal axis keeps its rate to the bit") {
  const Vec3 rate(0, 0, 5);
  REQUIRE(free_rate(tumbler(), rate, 0.1) == rate);
}

TEST_CASE("an impulse enters the spatial angular momentum of the midpoint rule exactly") {
  const Mat3 inertia = tumbler();
  const Vec3 rate(0.4, -2, 0.3), impulse(0.7, 0.2, -1.1), before = inertia * rate, after = before + impulse;
  for (const double h : {1e-3, 0.1, 1.0}) {
    const Vec3 mid = midpoint_rate<double>(inertia, rate, before, after, h).rate;
    // cay(h mid) I (2 mid - rate) = after: Newton stops within an ulp of |after| or when no step improves on
    // it.
    CAPTURE(h);
    REQUIRE((cayley<double>(h * mid) * Vec3(inertia * (2 * mid - rate)) - after).norm() <=
            1e-14 * after.norm());
  }
}

// Ω₊ = I⁻¹ Qᵀ I Ω: the spatial momentum stays by construction, the energy only at a root of the rule's
// equation, of which a step may lack 128 eps of the momentum. 6000 steps of one sign make 6000 · 128 eps
// = 1.7e-10 of the energy. No root: 0.1 and more. Squares of the last speed overflow.
TEST_CASE("a body that turns by many radians in a step keeps its energy") {
  const double h = 1.0 / 60;
  for (const Vec3& moments : {Vec3(1, 2, 3), Vec3(1, 1, 1e-6), Vec3(1, 1, 2), Vec3(1, 1.001, 1.9)})
    for (const double speed : {10., 100., 1e3, 1e5, 1e8, 1e30, 1e150}) {
      const Mat3 inertia = moments.asDiagonal();
      Vec3 rate = speed * Vec3(0.48, 0.6, 0.64);
      const double energy = rate.dot(inertia * rate);
      double worst = 0;
      for (int n = 0; n < 6000; ++n) {
        const Vec3 momentum = inertia * rate;
        const Quat turn = midpoint_turn<double>(inertia, rate, momentum, momentum, h);
        rate = inertia.inverse() * (turn.conjugate() * momentum);
        worst = std::max(worst, std::abs(rate.dot(inertia * rate) / energy - 1));
      }
      CAPTURE(moments.transpose(), speed, worst);
      CHECK(worst < 1.7e-10);
    }
}

TEST_CASE("in single precision the midpoint rule turns a grain of 0.1 mm as it turns a metre") {
  using V = Vec<3, float>;
  const float h = 1e-3f;
  for (const float size : {1.0f, 1e-4f}) {
    const float mass = 1000 * size * size * size;
    const Mat<3, 3, float> inertia = (mass * size * size * V(0.1f, 0.2f, 0.25f)).asDiagonal();
    const V rate(3, 20, 1), a = inertia * rate;
    const V mid = midpoint_rate<float>(inertia, rate, a, a, h).rate;
    const V next = 2 * mid - rate;
    CAPTURE(size);
    REQUIRE(next.dot(inertia * next) == Approx(rate.dot(a)).epsilon(1e-5));
  }
}

TEST_CASE("a quaternion that is nearly a unit one gives a rotation, and becomes one") {
  const Quat unit_size = exponential(Vec3(0.3, -1.2, 0.8));
  for (const double size : {1 - 1e-9, 1.0, 1 + 1e-9}) {
    const Quat q(size * unit_size.w(), size * unit_size.x(), size * unit_size.y(), size * unit_size.z());
    const Mat3 R = rotation_matrix(q);
    CAPTURE(size);
    // Sums of three products, each factor within 4 roundings; the squares of 2e-9 are no more than a
    // twentieth of one.
    REQUIRE(std::abs(unit_again(q).norm() - 1) < 4 * 0x1p-53);
    REQUIRE((R * R.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff() < 3e-15);
    REQUIRE((R - unit_size.toRotationMatrix()).cwiseAbs().maxCoeff() < 3e-15);
  }
}

// Ω̄ = Ω/2 whatever the axes: a rounding of the momentum before is the least that the equation can lack, that
// after being none.
TEST_CASE("a body that is braked to rest within a step turns by half of what it would have") {
  const Mat3 inertia = exponential(Vec3(0.4, 0.2, 1)).toRotationMatrix() * tumbler() *
                       exponential(Vec3(0.4, 0.2, 1)).toRotationMatrix().transpose();
  for (const double left : {0.0, 1e-9, 1e-3}) {
    const Vec3 axis = Vec3(1, -2, 0.5).normalized(), rate = 2 * axis, before = inertia * rate,
               after = left * before;
    const Quat turn = midpoint_turn<double>(inertia, rate, before, after, 0.01);
    CAPTURE(left);
    // The momentum after has turned with the body by 0.01 rad: c is met to the second order of the turn.
    REQUIRE((logarithm(turn) - 0.01 * (1 + left) * axis).norm() < 2e-4 * 0.01 + 0.01 * left);
  }
}

TEST_CASE("products and inverses of turns are Eigen's") {
  for (int k = 0; k < 20; ++k) {
    const Quat a = unit(Quat(Eigen::Vector4d(Eigen::Vector4d::Random()))), b = unit(Quat(Eigen::Vector4d(Eigen::Vector4d::Random())));
    // Entries are sums of four products below 1.
    REQUIRE((product(a, b).coeffs() - (a * b).coeffs()).cwiseAbs().maxCoeff() <= 4 * std::numeric_limits<double>::epsilon());
    REQUIRE(conjugate(a).coeffs() == a.conjugate().coeffs());
  }
}

TEST_CASE("a quaternion that is no number stays none, and one whose squares overflow has unit length") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k) {
    Eigen::Vector4d x(0.1, 0.2, 0.3, 0.4);
    // To rounding: scaling by 1e200, the squares, their sum, the root and the quotient round once each.
    CHECK((unit(Quat(Eigen::Vector4d(1e200 * x))).coeffs() - x.normalized()).norm() <= 8 * std::numeric_limits<double>::epsilon());
    x[k] = nan;
    CHECK_FALSE(unit(Quat(x)).coeffs().allFinite());
    x[k] = infinity;
    CHECK_FALSE(unit(Quat(x)).coeffs().allFinite());
  }
}
