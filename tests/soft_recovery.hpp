/// Deformable bodies without constraints that start from flat, from inside out, from anywhere.
#pragma once

#include <delassus/bodies/world.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>

#include "catch.hpp"
#include "energy_watch.hpp"
#include "soft_scenes.hpp"

namespace soft_scenes {

enum class Start { plane, line, point, random, inside_out, twisted, swollen, one_node_through };

inline Vec3 started(Start start, const Vec3& p, std::mt19937& random) {
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

constexpr Start all[] = {Start::plane,      Start::line,    Start::point,   Start::random,
                         Start::inside_out, Start::twisted, Start::swollen, Start::one_node_through};

/// A body of this mesh under implicit Euler, `steps` of 10 ms.
template <class Soft>
Outcome recover(Start start, const typename Soft::Mesh& mesh, int steps) {
  AnimationLoop loop{World{Soft{}}, ImplicitEuler{.rayleigh_mass = 4}};
  auto& set = bodies<Soft>(loop.world());
  set.gravity.setZero();
  const auto body = set.add({.mesh = mesh, .elasticity = {.young = 1e4, .poisson = 0.3}});
  std::mt19937 random(4);
  for (Index k = 0; k < set.node_count(body); ++k)
    set.place(set.node(body, k), started(start, set.position(set.node(body, k)), random));
  const double first = total_energy(set);
  const EnergyWatch seen = watch_energy(loop, set, steps, 0.01);
  REQUIRE(loop.report().status == Status::converged);
  return {seen.rise / first, set.elastic_energy() / first};
}

}  // namespace soft_scenes
