// Tutorial: a motor lifts a pendulum against a stop, lets go, and the pendulum swings.
// prints: at the stop: 1\.200 rad, motor 10\.00 N m, stop 5\.43
#include <delassus/delassus.hpp>
#include <delassus/io/recorder.hpp>
#include <delassus/io/replay_page.hpp>

#include <cstdio>
#include <vector>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Motor<Turn>{}, Limit<Turn>{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-8}, Recorder{"Pendulum", "A motor, a stop, a swing."}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const auto rod = rigid.add({.position = {0, 0, -0.5}, .mass = 1.0, .shape = Box{0.05, 0.05, 1}});

  const Quat axis = frame_along({0, -1, 0});  // a positive turn lifts the rod towards +x
  const Anchor post = world_anchor({0, 0, 0}, axis), end = anchor_at(rigid, rod, {0, 0, 0}, axis);
  loop.add(Hinge::Item{post, end});
  const auto stop = loop.add(Limit<Turn>::Item{.a = post, .b = end, .lower = -1.2, .upper = 1.2});
  const auto motor = loop.add(Motor<Turn>::Item{.a = post, .b = end, .speed = 1, .max_force = 10});

  const double h = 2e-3, weight = 1.0 * 9.81 * 0.5;  // N m at a level rod
  const auto show = [&](const char* when) {
    const Vec3 x = rigid.position(rod);
    const double angle = std::atan2(x.x(), -x.z());
    const Vec<2> stops = loop.impulse(stop) / h;
    std::printf("%s: %.3f rad, motor %.2f N m, stop %.2f N m, weight %.2f N m\n", when, angle,
                loop.impulse(motor)[0] / h, stops.cwiseAbs().sum(), weight * std::sin(angle));
  };
  const auto run = [&](int steps) {
    for (int n = 0; n < steps; ++n) loop.step(h);
  };

  run(300);
  show("half way");
  run(700);
  show("at the stop");

  loop.item(motor).speed = 0;
  loop.item(motor).max_force = 0.3;  // what is left is dry friction
  run(500);
  show("swings");
  run(5000);
  show("at rest");

  write_replay_page("pendulum.html", "Pendulum", std::vector{loop.get<Recorder>().recording()});
}
