// Deformable bodies of hexahedra in the loop: energy, recovery, checkpoints.
#include <delassus/bodies/world.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "hexahedral_scenes.hpp"

using namespace delassus;
using namespace soft_scenes;

namespace {

using Soft = HexahedralFem<Corotational>;

enum class Start { plane, line, point, random, inside_out, twisted, swollen, one_node_through };
constexpr Start all[] = {Start::plane,      Start::line,    Start::point,   Start::random,
                         Start::inside_out, Start::twisted, Start::swollen, Start::one_node_through};

Vec3 started(Start start, Vec3 p, std::mt19937& random) {
  std::uniform_real_distribution<double> draw(0, 1);
  switch (start) {
    case Start::plane:
      return {p[0], p[1], 0};
    case Start::line:
      return {p[0], 0, 0};
    case Start::point:
      return Vec3::Zero();
    case Start::random:
      for (int k = 0; k < 3; ++k) p[k] = draw(random);
      return p;
    case Start::inside_out:
      return {p[0], p[1], -p[2]};
    case Start::twisted:
      return exponential(Vec3(0, 0, 3 * p[2])) * p;
    case Start::swollen:
      return 2 * p;
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

Outcome run(Start start) {
  AnimationLoop loop{World{Soft{}}, ImplicitEuler{.rayleigh_mass = 4}};
  auto& set = bodies<Soft>(loop.world());
  set.gravity.setZero();
  const auto body = set.add({.mesh = bricks(2, 0.2), .elasticity = {.young = 1e4, .poisson = 0.3}});
  std::mt19937 random(4);
  for (Index k = 0; k < set.node_count(body); ++k)
    set.place(set.node(body, k), started(start, set.position(set.node(body, k)), random));
  const double first = kinetic_energy(set) + potential_energy(set);
  double last = first, rise = -first;
  for (int n = 0; n < 800; ++n) {
    loop.step(0.01);
    const double now = kinetic_energy(set) + potential_energy(set);
    rise = std::max(rise, now - last);
    last = now;
  }
  REQUIRE(loop.report().status == Status::converged);
  return {rise / first, set.elastic_energy() / first};
}

}  // namespace

TEST_CASE("under implicit Euler the energy of free hexahedra never rises, and they come back from anywhere") {
  for (const Start start : all) {
    const Outcome outcome = run(start);
    CAPTURE(int(start), outcome.rise, outcome.left);
    CHECK(outcome.rise <= 1e-14);  // roundings of the sum
    CHECK(outcome.left < 1e-6);
  }
}

TEST_CASE("hexahedra go on bit for bit from a checkpoint") {
  const auto make = [] { return AnimationLoop{World{Soft{}}, ImplicitEuler{.rayleigh_stiffness = 0.01}}; };
  auto loop = make(), restored = make();
  auto& soft = bodies<Soft>(loop.world());
  const auto bar = soft.add({.mesh = hexahedral_box({1, 0.2, 0.2}, {4, 1, 1}), .elasticity = {.young = 1e5}});
  soft.fix(bar, [](const Vec3& x) { return x[0] < 1e-9; });
  for (int n = 0; n < 10; ++n) loop.step(0.01);
  restore(restored, checkpoint(loop));
  for (int n = 0; n < 10; ++n) loop.step(0.01), restored.step(0.01);
  const auto& again = bodies<Soft>(restored.world());
  REQUIRE(again.blocks() == 20);
  for (Index b = 0; b < soft.blocks(); ++b) {
    CHECK(soft.pose(b).position == again.pose(b).position);
    CHECK(soft.velocity()[b] == again.velocity()[b]);
  }
  CHECK(soft.pose(19).position[2] < 0.19);
}
