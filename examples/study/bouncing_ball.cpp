// A ball that falls from a metre and bounces to rest with restitution 0.8: the height of every flight is known.
#include "scene_study.hpp"

#include <delassus/delassus.hpp>
#include <delassus/schemes/error_controlled.hpp>

#include <cmath>

namespace study_program {

namespace {

constexpr double gravity = 9.81, radius = 0.1, restitution = 0.8;

/// Of the lowest point of the ball, m, t s after it is let go at a metre.
double height(double t) {
  double speed = std::sqrt(2 * gravity);  // of the next landing
  t -= speed / gravity;
  if (t < 0) return 1 - 0.5 * gravity * std::pow(t + speed / gravity, 2);
  for (int bounce = 0; bounce < 200; ++bounce) {
    speed *= restitution;
    if (t < 2 * speed / gravity) return t * (speed - 0.5 * gravity * t);
    t -= 2 * speed / gravity;
  }
  return 0;
}

}  // namespace

bool bouncing_ball_accuracy(const Options& options) {
  const auto scene = [](auto... policies) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, restitution}}}, policies...};
    auto& set = bodies<RigidBodies>(loop.world());
    set.add_fixed(HalfSpace{});
    set.add({.position = {0, 0, 1 + radius}, .mass = 1.0, .shape = Sphere{radius}});
    return loop;
  };
  const auto place = [](const auto& loop) { return loop.world().template set<0>().pose(1).position.z() - radius; };
  return run_study(options, "bouncing_ball_accuracy", 1e-3, scene,
                   Combinations{Choices{PlainOrder{}, ErrorControlled{}}, Choices{ImplicitMidpoint{}}, Choices{PositionProjection{}},
                                Choices{AcceleratedGaussSeidel{}}},
                   {.name = "Bouncing ball",
                    .duration = 5,
                    .steps = {0.025, 0.0125, 0.005, 0.0025, 0.00125, 0.0005, 0.00025, 0.000125, 0.00005},
                    .accuracies = {1e-1, 1e-2, 1e-3, 1e-4, 1e-5},
                    .tolerances = {1e-9},
                    .outputs = 20,
                    .repeats = 3},
                   Measures{Compared{"height", "m", place, height}, penetration()});
}

}  // namespace study_program
