// The tables of docs/how_to/make_it_faster.md: what makes a step dear, as counts of its report, and what the
// advice does to them.
#include "scenes.hpp"

#include "catch.hpp"

namespace what_costs_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

/// Four stacks of three boxes, 0.3 m apart, after a second at rest.
template <class... Policies>
StepReport four_stacks(Policies... policies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, policies...};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (int x = 0; x < 4; ++x)
    for (int z = 0; z < 3; ++z)
      set.add({.position = {1.3 * x, 0, 0.5 + z}, .mass = 1.0, .shape = Box{1, 1, 1}});
  StepReport report;
  for (int n = 0; n < 60; ++n) report = loop.step(h);
  return report;
}

/// Sweeps of each step of ten boxes that fall 0.1 m and stand, and how far from the weight the ground's
/// forces are at the end.
struct Fall {
  std::vector<int> sweeps;
  double off = 0;  ///< of the weight, as a share of it
};
Fall drop_ten(double tolerance) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.tolerance = tolerance, .max_iterations = 10000}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 10; ++i) set.add({.position = {0, 0, 0.6 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  Fall out;
  for (int n = 0; n < 240; ++n) out.sweeps.push_back(loop.step(h).sweeps);
  double up = 0;
  for (const ContactResult& contact : loop.contacts())
    if (contact.record.point()[2] < 0.5) up += contact.impulse[2];
  out.off = std::abs(up / (10 * g * h) - 1);
  return out;
}

}  // namespace

TEST_CASE("a wide margin makes contacts of bodies apart and one island of all") {
  const StepReport plain = four_stacks(), wide = four_stacks(NativeCollision{.margin = 0.5});
  CHECK(plain.contacts == 48);  // four a face, three faces a stack
  CHECK(plain.islands == 4);
  CHECK(wide.contacts > 2 * plain.contacts);
  CHECK(wide.rows == 3 * wide.contacts);
  CHECK(wide.islands == 1);
}

TEST_CASE("bodies at rest have rows until they sleep") {
  const StepReport awake = four_stacks(), asleep = four_stacks(Sleeping{});
  CHECK(awake.rows == 144);
  CHECK(asleep.rows == 0);
}

// The impulses of one solve are known to `tolerance` of the largest change of velocity, g h.
TEST_CASE("a tighter tolerance gives more digits of a force") {
  CHECK(drop_ten(1e-6).off < 1e-3);
  CHECK(drop_ten(1e-9).off < 1e-6);
}

// It lands after √(2 · 0.1 m / g) = 0.14 s, in step 9.
TEST_CASE("an impact takes most sweeps and the steps after it start from its answer") {
  const std::vector<int> sweeps = drop_ten(1e-6).sweeps;
  const auto most = std::max_element(sweeps.begin(), sweeps.end());
  CHECK(most - sweeps.begin() >= 8);
  CHECK(most - sweeps.begin() < 12);
  long later = 0;
  for (std::size_t n = 120; n < 240; ++n) later += sweeps[n];
  CHECK(4 * later < 120 * *most);
}

}  // namespace what_costs_tests
