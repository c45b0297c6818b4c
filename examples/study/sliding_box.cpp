// A box slides at 5 m/s on a floor with friction 0.3 and stops after 4.247 m: Coulomb's law has the answer at
// every moment.
#include "scene_study.hpp"

#include <delassus/delassus.hpp>

namespace study_program {

bool sliding_box(const Options& options) {
  const double v0 = 5, deceleration = 0.3 * 9.81;
  const auto scene = [&](auto... policies) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}, policies...};
    auto& rigid = bodies<RigidBodies>(loop.world());
    rigid.add_fixed(HalfSpace{});
    rigid.add({.position = {0, 0, 0.1}, .velocity = {v0, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 0.2}});
    return loop;
  };
  const auto place = [](const auto& loop) { return loop.world().template set<0>().pose(1).position.x(); };
  const auto exact = [&](double t) {
    const double s = std::min(t, v0 / deceleration);
    return v0 * s - 0.5 * deceleration * s * s;
  };
  return run_study(
      options, "sliding_box", 1e-3, scene,
      Combinations{Choices{SymplecticEuler{}, ImplicitMidpoint{}}, Choices{Baumgarte{}, PositionProjection{}},
                   Choices{AcceleratedGaussSeidel{}, GaussSeidel{}}},
      {.name = "Sliding box",
       .duration = 2,
       .steps = {0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001, 0.0005},
       .tolerances = {1e-2, 1e-4, 1e-8},
       .outputs = 10,
       .repeats = 5},
      Measures{Compared{"place", "m", place, exact}, penetration(), solver_residual()});
}

}  // namespace study_program
