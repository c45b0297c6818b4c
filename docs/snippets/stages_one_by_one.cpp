// A host that calls the stages of a step one by one, and reads W between them.
// prints: 12 rows, W_nn 2\.000 1/kg
#include <delassus/delassus.hpp>

#include <cstdio>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0, 0, 0.5}, .mass = 2.0, .shape = Box{1, 1, 1}});

  auto& step = loop.data();
  for (int i = 0; i < 100; ++i) {
    stage::begin(step, 5e-3);
    stage::detect(step);
    do {
      stage::linearize(step);
      stage::free_motion(step);
      stage::find_islands(step);
      stage::make_bias(step);
      stage::build(step);
      // Work of your own: rows, W and d of this step are there.
      if (i == 99) std::printf("%d rows, W_nn %.3f 1/kg\n", int(step.report().rows), step.W.diagonal<0>(0)(0, 0));
      stage::solve(step);
      stage::correct(step);
    } while (stage::find_missed(step));
    stage::advance(step);
  }
  std::printf("box at z = %.3f m\n", rigid.position(box).z());
}
