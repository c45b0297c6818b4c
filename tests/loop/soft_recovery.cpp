// Deformable bodies without constraints: what implicit Euler does to their energy, and from where they come
// back.
#include <delassus/bodies/world.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

using namespace delassus;
using namespace soft_scenes;

namespace {

enum class Start { plane, line, point, random, inside_out, twisted, swollen, one_node_through };

Vec3 started(Start start, const Vec3& p, std::mt19937& random) {
  std::uniform_real_distribution<double> draw(0, 1);
  switch (start) {
    case Start::plane:
      return {p[0], p[1], 0};
    case Start::line:
      return {p[0], 0, 0};
    case Start::point:
      return {0, 0, 0};
    case Start::random:
      return {draw(random), draw(random), draw(random)};
    case Start::inside_out:
      return {p[0], p[1], -p[2]};
    case Start::twisted:
      return exponential(Vec3(0, 0, M_PI * p[2])) * (p - Vec3(0.5, 0.5, 0));
    case Start::swollen:
      return 1.5 * p;
    case Start::one_node_through:
      return (p - Vec3(0.5, 0.5, 0.5)).norm() < 0.2 ? Vec3(0.5, 0.5, 1.6) : p;
  }
  return p;
}

/// The largest rise of the energy in a step, and the elastic energy at the end, both as shares of the energy
/// at the start.
struct Outcome {
  double rise, left;
};

template <class M>
Outcome run(Start start) {
  AnimationLoop loop{World{TetrahedralFem<M>{}}, ImplicitEuler{.rayleigh_mass = 4}};
  auto& set = bodies<TetrahedralFem<M>>(loop.world());
  set.gravity.setZero();
  const auto body = set.add({.mesh = cube(2, 0.2), .elasticity = {.young = 1e4, .poisson = 0.3}});
  std::mt19937 random(4);
  for (Index k = 0; k < set.node_count(body); ++k)
    set.place(set.node(body, k), started(start, set.position(set.node(body, k)), random));
  const double first = kinetic_energy(set) + potential_energy(set);
  double last = first, rise = -first;
  for (int n = 0; n < 500; ++n) {
    loop.step(0.01);
    const double now = kinetic_energy(set) + potential_energy(set);
    rise = std::max(rise, now - last);
    last = now;
  }
  REQUIRE(loop.report().status == Status::converged);
  return {rise / first, set.elastic_energy() / first};
}

constexpr Start all[] = {Start::plane,      Start::line,    Start::point,   Start::random,
                         Start::inside_out, Start::twisted, Start::swollen, Start::one_node_through};

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
