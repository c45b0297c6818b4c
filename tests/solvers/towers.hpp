/// Boxes on each other as a problem, and the error of what solves it.
#pragma once

#include <delassus/delassus.hpp>

#include "cold_problems.hpp"

#include <initializer_list>

namespace cold_problems {

/// `masses` of boxes on each other, from the ground up, after one step of h from cold: with their bodies.
inline auto tower(std::initializer_list<double> masses, double speed = 0, double h = 1.0 / 60) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     AcceleratedGaussSeidel{.max_iterations = 1}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  double z = 0.5;
  for (const double mass : masses) {
    set.add({.position = {1e-3 * z, 0, z}, .velocity = {speed, 0, 0}, .mass = mass, .shape = Box{1, 1, 1}});
    z += 1;
  }
  return problem_of(loop, h);
}

/// The error of the λ that a problem has, by the plain solver's measure.
template <class Problem>
double error(Problem& p) {
  return solve(p, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure.residual;
}

}  // namespace cold_problems
