// What accuracy costs, for a scene of one's own: a stone thrown up, by two integrators at four steps.
// prints: cheapest within 1 mm: auto loop = scene\(ImplicitMidpoint\{\}\);  // then loop.step\(0\.[0-9]+\)
#include <delassus/delassus.hpp>
#include <delassus/study/sweep.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  const auto scene = [](auto... policies) {  // the study gives the policies, the scene the rest
    AnimationLoop loop{World{Particles{}}, policies...};
    bodies<Particles>(loop.world()).add({.velocity = {3, 0, 5}, .mass = 0.2});
    return loop;
  };
  const auto place = [](const auto& loop) { return bodies<Particles>(loop.world()).pose(0).position; };
  const auto exact = [](double t) { return Vec3(3 * t, 0, 5 * t - 4.905 * t * t); };

  const Combinations list{Choices{SymplecticEuler{}, ImplicitMidpoint{}}};
  const StudyPlan plan{.name = "stone", .duration = 1, .steps = {0.1, 0.01, 0.001, 0.0001}};
  std::printf("%s\n", announcement(list, plan).c_str());
  const Study study = sweep(scene, list, plan, Measures{Compared{"place", "m", place, exact}});
  std::printf("cheapest within 1 mm: %s\n", study.line(*study.cheapest(0, 1e-3)).c_str());
}
