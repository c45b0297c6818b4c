// A set in single precision hands its rotations over in double: orthogonal to 1e-7 only.
#include <delassus/delassus.hpp>
#include <delassus/collision/native_engine.hpp>

#include <random>

#include "catch.hpp"

namespace single_precision_tests {

using namespace delassus;

// |Rᵀ R − 1| ≤ a few 2^-24 here, so a normal that is only turned is 1e-7 too long or short; one that is
// normalised after has |n|² = 1 to four roundings, 4 · 2^-52.
TEST_CASE(
    "a sphere's contact has a unit normal, whichever comes first and however the other is turned in float") {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-1, 1);
  double worst = 0;
  for (int k = 0; k < 200; ++k) {
    const Quat turn = Quat{draw(random), draw(random), draw(random), draw(random)}.normalized();
    const Pose pose{Vec3{draw(random), draw(random), draw(random)},
                    turn.cast<float>().toRotationMatrix().cast<double>()};
    worst = std::max(worst, (pose.rotation.transpose() * pose.rotation - Mat3::Identity()).norm());
    for (const Shape& shape :
         {Shape(Box{0.7, 0.5, 0.3}), Shape(Capsule{0.2, 0.5}), Shape(Cylinder{0.3, 0.4})}) {
      SignedPair r;
      REQUIRE(closed_form(Sphere{0.4}, shape, pose, Vec3::Zero(), r));
      REQUIRE(std::abs(r.normal.squaredNorm() - 1) <= 4 * 0x1p-52);
      REQUIRE(closed_form(shape, Sphere{0.4}, pose, Vec3::Zero(), r));
      REQUIRE(std::abs(r.normal.squaredNorm() - 1) <= 4 * 0x1p-52);
    }
  }
  REQUIRE(worst > 1e-8);  // the rotations are not exact
}

// A ball of 1 kg on the face of a turned box: the contact carries its weight, along the face's normal.
TEST_CASE("a ball in single precision rests on a turned box") {
  AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& set = bodies<RigidBodiesF>(loop.world());
  const Quat turn(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
  const auto ball = set.add({.position = {0.1, 0.05, 0.7}, .mass = 1.0, .shape = Sphere{0.2}});
  set.add({.orientation = turn, .shape = Box{1, 1, 1}, .motion = Motion::fixed});
  const double h = 0.01;
  StepReport report;
  for (int n = 0; n < 100; ++n) report = loop.step(h);
  REQUIRE(report.contacts == 1);
  REQUIRE(report.rejects == 0);
  // Weight and residual in float: 1e-6 of tolerance and as many roundings.
  REQUIRE(std::abs(loop.contacts()[0].impulse.z()) / h == Approx(9.81).epsilon(1e-5));
  REQUIRE(set.position(ball).z() == Approx(0.7).margin(1e-4));
}

}  // namespace single_precision_tests
