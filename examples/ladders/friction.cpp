// HC-08, HC-39: friction from none to no end, and a grip that shall not creep.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/solvers/proximal_newton.hpp>
#include <delassus/stabilisation/position_projection.hpp>

#include <numbers>
#include <vector>

namespace ladders {

namespace {

/// 3 s; push() before every step but the first. `usual` is the work at friction 0.5, the first rung of a
/// scene.
template <class Loop>
Marks watch_friction(Ladder& ladder, Loop& loop, double mu, double scale, double& usual, const auto& push) {
  long sweeps = 0;
  int steps = 0;
  const Seen seen = run(ladder, loop, 3, frame, [&](int) {
    sweeps += loop.report().sweeps, ++steps;
    for (const SolveReport& island : loop.island_reports()) sweeps += island.factorizations;
    push();
  });
  const double mean = double(sweeps) / steps;
  if (mu == 0.5) usual = mean;
  return {{"residual", seen.residual, 1e-4, 1e-8},
          {"work / work at friction 0.5", mean / usual, unbounded, 5},
          {"energy gained / energy of the scene", seen.gain / scale, 0.01, 0.01, 2}};
}

std::vector<double> up_to(double largest) {
  std::vector<double> out;
  for (const double mu : {0.5, 0., 1e-6, 0.1, 1., 10., 1e3, 1e6})
    if (mu <= largest) out.push_back(mu);
  return out;
}

/// Three boxes on a slope of 30 degrees, the lowest pushed from the side, for 3 s.
template <class Solver>
void climb_friction(Ladder& ladder, const Solver& solver, double largest = 1e6) {
  double usual = 0;
  for (const double mu : up_to(largest))
    ladder.rung(format("friction %g", mu), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}, solver};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity = g * Vec3(0.5, 0, -std::sqrt(0.75));
      set.add_fixed(HalfSpace{});
      RigidBodies::Handle lowest;
      for (int k = 2; k >= 0; --k)
        lowest = set.add({.position = {0.05 * k, 0, 0.25 + 0.5 * k}, .mass = 1.0, .shape = Box{1, 1, 0.5}});
      // The push and the fall of 3 s may do work: what is in the scene is m g times the way of free fall.
      return watch_friction(ladder, loop, mu, 3 * 0.5 * g * g * 9, usual, [&] {
        set.apply_force(lowest, {0, 2, 0});
      });
    });
}

/// A wedge of 20 degrees in a groove of as many, pressed in by a hundred times its weight for a second, then
/// drawn at along the groove; and an arch of nine stones of 2 m on the ground, each 10 kg and more.
template <class Solver, class... More>
void climb_jams(Ladder& ladder, const Solver& solver, double largest = 1e6, const More&... more) {
  using std::numbers::pi;
  double usual = 0;
  for (const double mu : up_to(largest))
    ladder.rung(format("wedge, friction %g", mu), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}, solver, more...};
      auto& set = bodies<RigidBodies>(loop.world());
      const double half = 10 * pi / 180, depth = 0.5, wide = depth * std::tan(half);
      for (const double side : {-1., 1.})
        set.add_fixed(HalfSpace{Vec3(-side * std::cos(half), 0, std::sin(half))});
      std::vector<Vec3> corners;
      for (const double y : {-0.2, 0.2}) {
        corners.push_back({0.2 * wide, y, 0.2 * depth}), corners.push_back({-0.2 * wide, y, 0.2 * depth});
        corners.push_back({wide, y, depth}), corners.push_back({-wide, y, depth});
      }
      const ConvexHull hull(corners);
      const auto wedge = set.add({.position = hull.centroid(), .mass = 1.0, .shape = hull});
      int step = 0;
      return watch_friction(ladder, loop, mu, 0.5 * 100 * 9 * 100, usual, [&] {
        ++step < 60 ? set.apply_force(wedge, {0, 0, -100 * g}) : set.apply_force(wedge, {0, 10, 0});
      });
    });
  for (const double mu : up_to(largest))
    ladder.rung(format("arch, friction %g", mu), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}, solver, more...};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      double mass = 0;
      for (int k = 0; k < 9; ++k) {
        std::vector<Vec3> corners;
        for (const double angle : {k * pi / 9, (k + 1) * pi / 9})
          for (const double r : {1.7, 2.3})
            for (const double y : {-0.2, 0.2})
              corners.push_back({r * std::cos(angle), y, r * std::sin(angle)});
        const ConvexHull hull(corners);
        mass += set.mass(set.add({.position = hull.centroid(), .density = 100., .shape = hull}));
      }
      return watch_friction(ladder, loop, mu, mass * g * 2.3, usual, [] {});
    });
}

}  // namespace

void friction_range(Ladder& ladder) {
  climb_friction(ladder, AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 5000});
}
void friction_range_newton(Ladder& ladder) { climb_friction(ladder, ProximalNewton{.tolerance = 1e-8}); }

// What 200 sweeps a step come to where friction is no larger than 1.
void friction_range_in_200(Ladder& ladder) {
  const AcceleratedGaussSeidel solver{.tolerance = 1e-6, .max_iterations = 200};
  climb_friction(ladder, solver, 1);
  climb_jams(ladder, solver, 1);
}

void jams(Ladder& ladder) {
  climb_jams(ladder, AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 5000});
}
// A jam lies on more corners than bodies have freedoms. Their gaps do not fit to 1e-9 m, and a rate for each of them has no answer to 1e-8.
void jams_newton(Ladder& ladder) { climb_jams(ladder, ProximalNewton{.tolerance = 1e-8}, 1e6, PositionProjection{}); }

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
