#include "metamorphic.hpp"

#include "catch.hpp"

namespace metamorphic_limits_tests {

using namespace metamorphic;
using metamorphic::Scene;  // scenes has one too

namespace {

constexpr double h = 0.01;

template <class Law>
std::vector<Vec3> tumble(const Scene& scene, const Law& law) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{law}},
                     AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 20000}};
  auto& set = rigid_bodies(loop);
  std::vector<RigidBodies::Handle> handles;
  for (const RigidBody& body : scene.bodies) handles.push_back(set.add(body));
  set.add_fixed(HalfSpace{scene.normal});
  for (int n = 0; n < 40; ++n) loop.step(h);
  std::vector<Vec3> out;
  for (const auto body : handles) out.push_back(set.position(body));
  return out;
}

double difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double out = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double now = (a[k] - b[k]).norm();
    out = std::isfinite(now) ? std::max(out, now) : std::numeric_limits<double>::infinity();
  }
  return out;
}

}  // namespace

// Solved to 1e-13 of some 10 m/s by two laws of different arithmetic, spread by the masses and forty steps.
TEST_CASE(
    "Coulomb's law without friction moves a scene as the frictionless law, and a tiny friction nearly so") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    const auto frictionless = tumble(scene, Frictionless{});
    CAPTURE(seed);
    REQUIRE(difference(frictionless, tumble(scene, Coulomb{.friction = 0})) <= 1e-9);
    // Friction μ takes at most μ Σλ/m from a velocity: 1e-9 of some 10 m/s for each contact, for 0.4 s, and
    // what neighbours make of it.
    REQUIRE(difference(frictionless, tumble(scene, Coulomb{.friction = 1e-9})) <= 1e-6);
  }
}

TEST_CASE("restitution 0 changes no bit of a scene") {
  for (unsigned seed = 1; seed <= seeds(); ++seed) {
    const Scene scene = draw(seed);
    CAPTURE(seed);
    REQUIRE(difference(tumble(scene, Coulomb{.friction = 0.5}),
                       tumble(scene, Restitution{Coulomb{.friction = 0.5}, 0})) == 0);
  }
}

}  // namespace metamorphic_limits_tests
