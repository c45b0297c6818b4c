// Deformable bodies without constraints: what implicit Euler does to their energy, and from where they come
// back.
#include "soft_recovery.hpp"

namespace soft_recovery_tests {

using namespace delassus;
using namespace soft_scenes;

namespace {

template <class M>
Outcome run(Start start) {
  return recover<TetrahedralFem<M>>(start, cube(2, 0.2), 500);
}

}  // namespace

TEMPLATE_TEST_CASE("under implicit Euler the energy of a free body never rises, whatever it starts from", "",
                   Linear, Corotational, StableNeoHookean) {
  for (const Start start : all) {
    CAPTURE(int(start));
    CHECK(run<TestType>(start).rise <= 1e-14);  // roundings of the sum
  }
}

TEST_CASE(
    "a corotational body comes back from flat, from a line, from a point, from inside out and from "
    "anywhere") {
  for (const Start start : all) {
    CAPTURE(int(start));
    CHECK(run<Corotational>(start).left < 1e-6);
  }
}

TEST_CASE(
    "a stable neo-Hookean body comes back from flat and from inside out, and stays bounded in a line or a "
    "point") {
  for (const Start start : all) {
    CAPTURE(int(start));
    const Outcome outcome = run<StableNeoHookean>(start);
    // At F of rank one or none its force is along F itself: nothing opens a line.
    if (start == Start::line || start == Start::point)
      CHECK(outcome.left <= 1);
    else
      CHECK(outcome.left < 1e-6);
  }
}

TEST_CASE("a body that falls freely keeps its shape, its momentum and its turn") {
  using Soft = TetrahedralFem<Corotational>;
  AnimationLoop loop{World{Soft{}}, ImplicitEuler{}};
  auto& set = bodies<Soft>(loop.world());
  const auto body = set.add({.mesh = cube(1), .elasticity = {.young = 1e5}, .velocity = {1, 2, 3}});
  for (int n = 0; n < 50; ++n) loop.step(0.01);
  for (Index b = 0; b < 8; ++b)
    CHECK((set.velocity()[b] - Vec3(1, 2, 3 - 9.81 * 0.5)).norm() < 1e-11);  // κ(A) ≈ 10, 50 steps of ε v
  CHECK(set.elastic_energy() < 1e-18);
  (void)body;
}

}  // namespace soft_recovery_tests
