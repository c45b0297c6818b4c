// A weight of 2 kg hangs from a spring of 400 N/m: it rests where the spring carries it.
// prints: it hangs 0\.049 m below its rest length, the spring holds 0\.48 J
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{Particles{}}, ImplicitEuler{}};
  auto& points = bodies<Particles>(loop.world());
  const auto weight = points.add({.position = {0, 0, -1}, .mass = 2.0});
  points.add_spring(weight, Vec3(0, 0, 0), 400, 20);  // N/m, N·s/m; rest length: the distance now, 1 m
  for (int n = 0; n < 1000; ++n) loop.step(0.01);
  std::printf("it hangs %.3f m below its rest length, the spring holds %.2f J\n", -1 - points.position(weight).z(),
              points.spring_energy());
}
