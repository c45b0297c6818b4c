// A door that slams, at an error that you ask for: the loop finds the steps.
// prints: 1e-03: [0-9]+ steps.*1e-05: [0-9]+ steps.*impact
#include <delassus/delassus.hpp>
#include <delassus/schemes/error_controlled.hpp>
#include <delassus/study/audit.hpp>

#include <cmath>
#include <cstdio>

using namespace delassus;

int main() {
  for (const double accuracy : {1e-3, 1e-4, 1e-5}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}},
                       ImplicitMidpoint{}, PositionProjection{.rate = 1}, AcceleratedGaussSeidel{.tolerance = 1e-9},
                       ErrorControlled{.accuracy = accuracy}, Audit{}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    const auto door = rigid.add({.position = {0.45, 0, 1}, .velocity = {0, 0.9, 0}, .angular_velocity = {0, 0, 2},
                                 .mass = 20, .shape = Box{0.9, 0.04, 2}});
    const Anchor post = world_anchor({0, 0, 1}), leaf = anchor_at(rigid, door, {0, 0, 1});
    loop.add(Hinge::Item{post, leaf});
    loop.add(Limit<Turn>::Item{.a = post, .b = leaf, .lower = 0, .upper = 1.2, .restitution = 0.4});

    long steps = 0, rejections = 0;
    for (int picture = 0; picture < 20; ++picture) {
      loop.step(0.05);
      const ErrorReport& report = error_report(loop);
      steps += report.steps;
      rejections += report.rejections;
    }
    const Quat turned = rigid.orientation(door);
    std::printf("%.0e: %ld steps, %ld tried again, the door is at %.6f rad\n", accuracy, steps, rejections,
                2 * std::atan2(turned.z(), turned.w()));
    if (accuracy == 1e-5) print(step_table(audit(loop)));
  }
}
