#include "scenes.hpp"

#include "catch.hpp"

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

auto contact_loop() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  rigid_bodies(loop).add_fixed(HalfSpace{});
  return loop;
}

template <class Set>
std::vector<RigidBodies::Handle> add_tower(Set& set, double x, int count) {
  std::vector<RigidBodies::Handle> boxes;
  for (int i = 0; i < count; ++i)
    boxes.push_back(set.add({.position = {x + 0.01 * i, 0, 0.55 + 1.02 * i}, .mass = 1.0 + i, .shape = Box{1, 1, 1}}));
  return boxes;
}

const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a force that is not finite holds its island where it was, counts its bodies, and leaves the rest to the bit") {
  for (const double bad : {not_a_number, infinity, -infinity}) {
    auto loop = contact_loop(), alone = contact_loop();
    auto &set = rigid_bodies(loop), &reference = rigid_bodies(alone);
    const auto good = add_tower(set, 0, 4), expected = add_tower(reference, 0, 4), sick = add_tower(set, 10, 3);
    for (int n = 0; n < 200; ++n) {
      const bool is_bad = n >= 100 && n < 110;
      if (is_bad) set.apply_force(sick[1], {0, bad, 0});
      const Vec3 before = set.position(sick[2]);
      const StepReport report = loop.step(h);
      alone.step(h);
      CAPTURE(n, bad);
      REQUIRE((report.status == Status::quarantined) == is_bad);
      REQUIRE(report.quarantined == (is_bad ? 3 : 0));
      if (is_bad) REQUIRE(set.position(sick[2]) == before);
      for (std::size_t i = 0; i < good.size(); ++i) {
        REQUIRE(set.position(good[i]) == reference.position(expected[i]));
        REQUIRE(set.orientation(good[i]).coeffs() == reference.orientation(expected[i]).coeffs());
        REQUIRE(set.velocity(good[i]) == reference.velocity(expected[i]));
      }
    }
  }
}

TEST_CASE("an island that was quarantined stands again when the force is gone") {
  auto loop = contact_loop();
  auto& set = rigid_bodies(loop);
  const auto sick = add_tower(set, 0, 3);
  for (int n = 0; n < 100; ++n) loop.step(h);
  for (int n = 0; n < 10; ++n) {
    set.apply_force(sick[0], {not_a_number, 0, 0});
    loop.step(h);
  }
  StepReport report;
  for (int n = 0; n < 200; ++n) report = loop.step(h);
  REQUIRE(report.status == Status::converged);
  REQUIRE(report.contacts == 12);
  for (int i = 0; i < 3; ++i) REQUIRE(set.position(sick[i]).z() == Approx(0.5 + i).margin(1e-3));
  double carried = 0;
  for (const ContactResult& c : loop.contacts())
    if (c.record.point().z() < 0.1) carried += c.impulse.z() / h;
  REQUIRE(std::abs(carried) == Approx(6 * g).epsilon(1e-5));
}

TEST_CASE("a free body with a force that is not finite stays where it was, alone") {
  auto loop = contact_loop();
  auto& set = rigid_bodies(loop);
  const auto sick = set.add({.position = {0, 0, 5}, .mass = 1.0, .shape = Sphere{0.1}});
  const auto other = set.add({.position = {3, 0, 5}, .mass = 1.0, .shape = Sphere{0.1}});
  set.apply_torque(sick, {0, infinity, 0});
  const StepReport report = loop.step(h);
  REQUIRE(report.status == Status::quarantined);
  REQUIRE(report.quarantined == 1);
  REQUIRE(set.position(sick) == Vec3(0, 0, 5));
  REQUIRE(set.position(other).z() == Approx(5 - g * h * h).epsilon(1e-15));
  REQUIRE(loop.step(h).status == Status::converged);
}

TEST_CASE("each island has its own sweeps and its own status") {
  auto loop = AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                            AcceleratedGaussSeidel{.max_iterations = 30}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {-9, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.5}});
  for (int i = 0; i < 10; ++i) set.add({.position = {0.001 * i, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  set.add({.position = {9, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.5}});
  const StepReport report = loop.step(h);
  const auto islands = loop.island_reports();
  REQUIRE(islands.size() == 3);
  REQUIRE(islands[0].status == Status::converged);
  REQUIRE(islands[0].sweeps == 1);
  REQUIRE(islands[1].status == Status::max_iterations);
  REQUIRE(islands[1].sweeps == 30);
  REQUIRE(islands[2].status == Status::converged);
  REQUIRE(report.status == Status::max_iterations);
  REQUIRE(report.residual == islands[1].measure.residual);
}
