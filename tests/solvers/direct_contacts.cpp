// The direct path with contacts and a limit beside the joints.
#include "direct_tests.hpp"

namespace direct_contacts_tests {

using namespace direct_tests;

namespace {

/// Six links of 1 kg, the first and the last of 100 kg, fall on the ground as a bridge with a stop in its
/// first hinge.
auto bridge(DirectGaussSeidel solver) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{Coulomb{.friction = 0.5}}, Hinge{}, Limit<Turn>{}}, solver};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const Quat axis = frame_along({0, 1, 0});
  RigidBodies::Handle last;
  for (int k = 0; k < 6; ++k) {
    const auto link = rigid.add({.position = {0.5 * k, 0, 0.105 + 0.02 * k},
                                 .mass = k % 5 == 0 ? 100.0 : 1.0,
                                 .shape = Box{0.4, 0.3, 0.2}});
    if (k > 0) {
      const Vec3 at(0.5 * k - 0.25, 0, 0.105);
      const Anchor a = anchor_at(rigid, last, at, axis), b = anchor_at(rigid, link, at, axis);
      loop.add(Hinge::Item{a, b});
      if (k == 1) loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = -0.01, .upper = 0.01});
    }
    last = link;
  }
  return loop;
}

}  // namespace

// Resting, the ground carries all: 204 kg, with a residual of 1e-6 of a velocity of at most 1 m/s against g h
// = 0.16 m/s. Accelerated sweeps on W give up in 286 of the 300 steps.
TEST_CASE(
    "a jointed bridge comes to rest on the ground, which carries its weight, and every step converges") {
  auto loop = bridge({.tolerance = 1e-6});
  for (int n = 0; n < 300; ++n) REQUIRE(loop.step(1.0 / 60).status == Status::converged);
  double weight = 0;
  for (const ContactResult& c : loop.contacts()) weight += 60 * c.impulse.dot(Vec3(0, 0, 1));
  CHECK(std::abs(std::abs(weight) - 204 * 9.81) <= 1e-5 * 204 * 9.81);
}

}  // namespace direct_contacts_tests
