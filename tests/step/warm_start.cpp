#include "scenes.hpp"

#include "catch.hpp"

namespace warm_start_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

auto stack_loop(int count) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     GaussSeidel{.tolerance = 1e-6, .max_iterations = 100000}};
  add_stack(rigid_bodies(loop), count, Box{1, 1, 1});
  return loop;
}

}  // namespace

TEST_CASE("impulses remembered by contact id save nine sweeps of ten on a stack at rest") {
  auto loop = stack_loop(5);
  const int first = loop.step(h).sweeps;
  int sum = 0;
  for (int n = 0; n < 300; ++n) {
    const int sweeps = loop.step(h).sweeps;
    if (n >= 200) sum += sweeps;
  }
  const int mean = sum / 100;
  auto cold = loop.problem();
  for (auto& x : cold.rows.pool<0>().lambda) x.setZero();
  const int without = solve(cold, GaussSeidel{.tolerance = 1e-6, .max_iterations = 100000}).sweeps;
  CAPTURE(first, mean, without);
  REQUIRE(10 * mean <= without);
}

TEST_CASE("a warm start scales with the step: a quarter of the step starts from a quarter of the impulse") {
  auto loop = stack_loop(3);
  for (int n = 0; n < 100; ++n) loop.step(h);
  std::vector<Vec3> before;
  for (const ContactResult& c : loop.contacts()) before.push_back(c.impulse);
  loop.get<GaussSeidel>().max_iterations = 0;  // what is left is the start itself
  loop.step(h / 4);
  REQUIRE(loop.contacts().size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    REQUIRE((loop.contacts()[i].impulse - 0.25 * before[i]).norm() <= 1e-12 * before[i].norm());
}

// The force on the ground is the weight at every step size; 1e-6 is the tolerance, and the drop to h/4 makes it four times
// as much of the impulse.
TEST_CASE("the contact force goes on unbroken when the step changes") {
  auto loop = stack_loop(3);
  for (int n = 0; n < 200; ++n) loop.step(h);
  for (const double step : {h, h / 4, h / 4, 2 * h, h}) {
    loop.step(step);
    double force = 0;
    for (const ContactResult& c : loop.contacts())
      if (c.record.point().z() < 0.1) force += c.impulse.z() / step;
    REQUIRE(force == Approx(3 * g).epsilon(1e-4));
  }
}

TEST_CASE("a warm start is kept when a body is removed: what is left starts from the impulses it had") {
  auto loop = stack_loop(4);
  auto& set = rigid_bodies(loop);
  const auto extra = set.add({.position = {9, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int n = 0; n < 100; ++n) loop.step(h);
  std::vector<Vec3> before;
  for (const ContactResult& c : loop.contacts())
    if (c.record.point().x() < 5) before.push_back(c.impulse);
  REQUIRE(before.size() == 16);
  loop.remove(extra);
  loop.get<GaussSeidel>().max_iterations = 0;  // what is left is the start itself
  loop.step(h);
  REQUIRE(loop.contacts().size() == before.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    REQUIRE((loop.contacts()[i].impulse - before[i]).norm() <= 1e-12 * before[i].norm());
}

}  // namespace warm_start_tests
