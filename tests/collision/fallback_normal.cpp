#include "catch.hpp"
#include "collision/scene.hpp"

#include <delassus/delassus.hpp>
#include <delassus/collision/native_engine.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace parting_tests {

using namespace delassus;
using namespace scenes;

namespace {

double nearest_places(std::uint32_t first, std::uint32_t count) {
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t a = first; a < first + count; ++a)
    for (std::uint32_t b = first; b < a; ++b) least = std::min(least, inner::fallback_normal(a, b).norm());
  return least;
}

}  // namespace

TEST_CASE("the places of n keys in a row stay half of n^(-1/3) apart, in any set") {
  for (const std::uint32_t first : {0u, 12345u, collider_key(1, 0), collider_key(7, 99)})
    for (const std::uint32_t n : {2u, 10u, 100u, 1000u, 3000u})
      CHECK(nearest_places(first, n) > 0.5 / std::cbrt(double(n)));
}

// v_i = s p_i with s = max 1/(n_ij·(p_j − p_i)) meets every n_ij·(v_j − v_i) ≥ 1 as long as all these
// products are positive.
TEST_CASE("bodies in one place part by normals that do not contradict each other") {
  for (const Shape& shape :
       {Shape(Sphere{0.5}), Shape(Box{1, 1, 1}), Shape(Box{1, 0.8, 0.6}), Shape(Capsule{0.3, 1}),
        Shape(Cylinder{0.5, 2}), Shape(Ellipsoid{0.5, 0.4, 0.3})}) {
    Scene scene;
    for (int k = 0; k < 40; ++k) scene.add(shape, {0.3, -2, 1});
    scene.detect();
    CAPTURE(name(shape.kind));
    REQUIRE(scene.report.pairs == 780);
    int against = 0;
    for (const ContactPoint& c : scene.contacts) {
      CHECK((c.point_b - c.point_a - c.gap * c.normal).norm() < 1e-13);
      against += !(c.normal.dot(inner::fallback_normal(scene.colliders[c.a].key, scene.colliders[c.b].key)) > 0);
    }
    CHECK(against == 0);
  }
}

// Contacts without friction leave the velocities of the least ½ Σ v² among those that part all pairs at the
// push-out's 1 m/s, and v = p/min |p_j − p_i| is one of them. In one row of n they would have n (n² − 1)/24
// J.
TEST_CASE("a hundred spheres in one place are pushed apart no faster than their places ask") {
  constexpr int n = 100;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, MatrixFreeCompliance{},
                     AcceleratedSweeps{.tolerance = 1e-8, .max_iterations = 4000}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  Vec3 mean = Vec3::Zero();
  for (std::uint32_t k = 0; k < n; ++k) {
    set.add({.position = {0, 0, 2}, .mass = 1.0, .shape = Sphere{0.5}});
    mean += inner::place_of_key(k) / n;
  }
  double spread = 0;
  for (std::uint32_t k = 0; k < n; ++k) spread += 0.5 * (inner::place_of_key(k) - mean).squaredNorm();
  const double least = nearest_places(0, n);
  REQUIRE(loop.step(1. / 60).contacts == n * (n - 1) / 2);
  CHECK(kinetic_energy(set) < spread / (least * least));
  CHECK(spread / (least * least) < n * (n * n - 1) / 24. / 20);
  CHECK(momentum(set).norm() < 1e-9);
}

TEST_CASE("what is not in one place keeps the normal it had") {
  Scene scene;
  scene.add(Sphere{0.5}, {0, 0, 0});
  scene.add(Sphere{0.5}, {0, 1e-12, 0});
  scene.detect();
  REQUIRE(scene.contacts.size() == 1);
  CHECK((scene.contacts[0].normal - Vec3::UnitY()).norm() < 1e-14);
  scene.colliders[1].pose.position.setZero();
  scene.detect();
  REQUIRE(scene.contacts.size() == 1);
  CHECK((scene.contacts[0].normal - Vec3::UnitY()).norm() < 1e-14);
}

}  // namespace parting_tests
