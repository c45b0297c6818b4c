// A ball bounces in real time: a step of 5 ms ends 5 ms after the one before. Half a second of it.
// prints: simulated 0\.500 s
#include <delassus/delassus.hpp>
#include <delassus/listeners/real_time_pace.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.3}, 0.8}}},
                     RealTimePace{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto ball = rigid.add({.position = {0, 0, 1}, .mass = 0.1, .shape = Sphere{0.05}});

  for (int i = 0; i < 100; ++i) {
    loop.step(5e-3);
    if (i % 10 == 9) std::printf("%*s\n", 1 + int(60 * rigid.position(ball).z()), "o");
  }
  const auto pace = loop.get<RealTimePace>().statistics();
  std::printf("simulated %.3f s, %.2f ms from step to step, %.3f ms of them work, %ld steps late\n", loop.time(),
              1e3 * pace.mean_period, 1e3 * pace.p50, pace.late);
}
