// A stack falls asleep, has no rows then, and wakes when a ball hits it.
// prints: awake at [0-9.]+ s: 0 asleep, [1-9][0-9]* rows
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     Sleeping{.speed = 5e-3, .angular_speed = 5e-3, .after = 0.5}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int i = 0; i < 3; ++i) rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});

  while (loop.dormant().bodies().empty() && loop.time() < 5) loop.step(5e-3);
  StepReport report = loop.step(5e-3);
  std::printf("asleep after %.2f s: %zu bodies, %d rows\n", loop.time(), loop.dormant().bodies().size(), report.rows);

  const auto ball = rigid.add({.position = {-2, 0, 1.5}, .velocity = {5, 0, 0}, .mass = 2.0, .shape = Sphere{0.3}});
  while (!loop.dormant().bodies().empty() && loop.time() < 5) report = loop.step(5e-3);
  std::printf("awake at %.2f s: %zu asleep, %d rows\n", loop.time(), loop.dormant().bodies().size(), report.rows);

  loop.materials().set_pair(0, 0, {.friction = 0.1});  // such an edit wakes nobody
  loop.wake(ball);                                     // the ball, and all that fell asleep with it
  loop.wake_all();
}
