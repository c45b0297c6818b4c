// The error is asked for, not the step: a ball bounces to rest, with the accuracies 1e-2 to 1e-5 of its radius.
// prints: 1e-05: [0-9]+ steps, [0-9]+ tried again, smallest [0-9.]+ ms, largest error by impact; height at 1 s 0\.46800[0-9] m
#include <delassus/delassus.hpp>
#include <delassus/schemes/error_controlled.hpp>

#include <algorithm>
#include <cstdio>

using namespace delassus;

int main() {
  for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, 0.8}}},
                       ImplicitMidpoint{}, PositionProjection{}, AcceleratedGaussSeidel{.tolerance = 1e-9},
                       ErrorControlled{.accuracy = accuracy}};
    auto& set = bodies<RigidBodies>(loop.world());
    set.add_fixed(HalfSpace{});
    const auto ball = set.add({.position = {0, 0, 1.1}, .mass = 1, .shape = Sphere{0.1}});

    ErrorReport all;
    double height = 0;
    for (int n = 1; n <= 45; ++n) {  // a picture each tenth of a second; how many steps that takes is the loop's affair
      loop.step(0.1);
      const ErrorReport& report = error_report(loop);
      all.steps += report.steps, all.rejections += report.rejections;
      all.least_step = n == 1 ? report.least_step : std::min(all.least_step, report.least_step);
      if (report.error > all.error) all.error = report.error, all.effect = report.effect;
      if (n == 10) height = set.position(ball).z() - 0.1;
    }
    std::printf("%.0e: %ld steps, %ld tried again, smallest %.4f ms, largest error by %s; height at 1 s %.6f m\n", accuracy,
                all.steps, all.rejections, 1e3 * all.least_step, name(all.effect), height);
  }
}
