// HC-08, HC-39: friction from none to no end, and a grip that shall not creep.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/solvers/proximal_newton.hpp>

namespace ladders {

namespace {

/// Three boxes on a slope of 30 degrees, the lowest pushed from the side, for 3 s.
template <class Solver>
void climb_friction(Ladder& ladder, const Solver& solver) {
  double usual = 0;
  for (const double mu : {0.5, 0., 1e-6, 0.1, 1., 10., 1e3, 1e6})
    ladder.rung(format("friction %g", mu), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}, solver};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity = g * Vec3(0.5, 0, -std::sqrt(0.75));
      set.add_fixed(HalfSpace{});
      RigidBodies::Handle lowest;
      for (int k = 2; k >= 0; --k)
        lowest = set.add({.position = {0.05 * k, 0, 0.25 + 0.5 * k}, .mass = 1.0, .shape = Box{1, 1, 0.5}});
      long sweeps = 0;
      int steps = 0;
      const Seen seen = run(ladder, loop, 3, frame, [&](int) {
        sweeps += loop.report().sweeps, ++steps;
        for (const SolveReport& island : loop.island_reports()) sweeps += island.factorizations;
        set.apply_force(lowest, {0, 2, 0});
      });
      const double mean = double(sweeps) / steps;
      if (mu == 0.5) usual = mean;
      return {
          {"residual", seen.residual, 1e-4, 1e-8},
          {"work / work at friction 0.5", mean / usual, unbounded, 5},
          // The push and the fall of 3 s may do work: what is in the scene is m g times the way of free fall.
          {"energy gained / energy of the scene", seen.gain / (3 * 0.5 * g * g * 9), 0.01, 0.01, 2}};
    });
}

}  // namespace

void friction_range(Ladder& ladder) {
  climb_friction(ladder, AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 5000});
}
void friction_range_newton(Ladder& ladder) { climb_friction(ladder, ProximalNewton{.tolerance = 1e-8}); }

// A capsule of 45 g between two fingers that are pressed on it, for 60 s: how far it creeps down.
void grip(Ladder& ladder) {
  for (const double force : {60., 12., 1., 0.4})
    ladder.rung(format("%g N", force), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.7}}, Slider{}},
                         ProximalNewton{}};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto thing = set.add({.mass = 0.045, .shape = Capsule{0.01, 0.05}});
      const Quat along = frame_along({1, 0, 0});
      RigidBodies::Handle finger[2];
      for (const int k : {0, 1}) {
        const Vec3 at((k ? 1 : -1) * 0.02, 0, 0);
        finger[k] = set.add({.position = at, .mass = 0.1, .shape = Box{0.02, 0.02, 0.02}});
        loop.add(Slider::Item{world_anchor(at, along), anchor_at(set, finger[k], at, along)});
      }
      double first = 0;
      const double until = ladder.is_quick() ? 2 : 60;
      run(ladder, loop, until, frame, [&](int n) {
        set.apply_force(finger[0], {force, 0, 0});
        set.apply_force(finger[1], {-force, 0, 0});
        if (n == 59) first = set.position(thing).z();
      });
      const double rate = std::abs(set.position(thing).z() - first) / (until - 1);
      return {{"creep (m/s)", rate, 1e-6, 0}};
    });
}

}  // namespace ladders
