// What accuracy costs for a scene of your own: a pendulum, two integrators, two stabilisations, four steps.
// prints: cheapest within 1 mm:[^a-z]*auto loop = scene\(
#include <delassus/delassus.hpp>
#include <delassus/study/diagram.hpp>
#include <delassus/study/sweep.hpp>
#include <delassus/study/tables.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  const auto scene = [](auto... policies) {
    AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}, policies...};
    auto& points = bodies<Particles>(loop.world());
    const auto bob = points.add({.position = {1, 0, 0}, .mass = 1.0});
    loop.add(DistanceJoint::Item{.a = anchor(points, bob), .b = world_anchor({0, 0, 0}), .length = 1});
    return loop;
  };
  const auto place = [](const auto& loop) { return bodies<Particles>(loop.world()).pose(0).position; };

  const Combinations list{Choices{SymplecticEuler{}, ImplicitMidpoint{}},
                          Choices{Baumgarte{}, PositionProjection{.rate = 1}}};
  const StudyPlan plan{.name = "pendulum", .duration = 2, .steps = {0.02, 0.005, 0.001, 0.0002}, .is_quiet = true};
  const Measures measures{Compared{"place", "m", place}, joint_drift()};
  const References references{refined(5, ImplicitMidpoint{}, PositionProjection{.rate = 1}),
                              refined(20, SymplecticEuler{}, PositionProjection{.rate = 1})};

  std::printf("%s\n", announcement(list, plan).c_str());
  const Study study = sweep(scene, list, plan, measures, references);
  print(front_table(study));

  const double budget = 1e-3;  // m
  write_diagram("pendulum.svg", study, {.measure = study.measure("place"), .budget = budget});
  write_csv("pendulum.csv", runs_table(study));
  if (const StudyRun* best = study.cheapest(study.measure("place"), budget))
    std::printf("cheapest within 1 mm:\n  %s\n", study.line(*best).c_str());
  else
    std::puts("no run is known to be within 1 mm");
}
