// At which friction does a stack of three boxes slide down a slope of tan 0.3? Sixteen worlds say it.
// prints: slides up to a friction of 0\.29, stays from 0\.31 on
#include <delassus/delassus.hpp>
#include <delassus/study/ensemble.hpp>
#include <delassus/study/ensemble_table.hpp>

#include <cstdio>

using namespace delassus;

auto make_stack(double friction) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.gravity = 9.81 * Vec3(0.3, 0, -1).normalized();
  rigid.add_fixed(HalfSpace{});
  for (int i = 0; i < 3; ++i) rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  return loop;
}

int main() {
  std::vector<double> frictions;
  for (int i = 0; i < 16; ++i) frictions.push_back(0.15 + 0.02 * i);

  const auto shifts = [](const auto& loop) {  // of the lowest box and of the highest
    const auto& rigid = bodies<RigidBodies>(loop.world());
    return std::array{rigid.position(rigid.handle(1)).x(), rigid.position(rigid.handle(3)).x()};
  };
  // .log = "slope.tsv" would keep each finished run; run() takes as a third argument who runs the worlds.
  const EnsemblePlan plan{
      .name = "slope", .steps = 200, .h = 1e-2, .observations = {"bottom (m)", "top (m)"}};
  const EnsembleResults results = Ensemble{make_stack, frictions}.run(plan, shifts);
  print(runs_table(results, 4));

  std::size_t slides = 0;
  while (slides + 1 < results.runs.size() && results.runs[slides].last()[0] > 1e-2) ++slides;
  std::printf("slides up to a friction of %.2f, stays from %.2f on\n", frictions[slides - 1],
              frictions[slides]);
}
