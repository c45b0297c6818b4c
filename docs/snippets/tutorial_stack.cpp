// Tutorial: ten boxes come to rest on each other, and the run is written as a replay page.
// prints: top at 9\.[45]
#include <delassus/delassus.hpp>
#include <delassus/io/recorder.hpp>
#include <delassus/io/replay_page.hpp>

#include <cstdio>
#include <vector>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}},
                     AcceleratedGaussSeidel{.tolerance = 1e-6}, Recorder{"Stack", "Ten boxes of 1 kg."}};

  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  RigidBodies::Handle top;
  for (int i = 0; i < 10; ++i)
    top = rigid.add({.position = {0, 0, 0.501 + 1.001 * i}, .mass = 1.0, .shape = Box{1, 1, 1}});

  for (int i = 0; i < 200; ++i) {
    const StepReport report = loop.step(5e-3);
    if (i % 50 == 49)
      std::printf("%s, %d sweeps, %d contacts\n", name(report.status), report.sweeps, report.contacts);
  }
  std::printf("top at %.4f m\n", rigid.position(top).z());

  write_replay_page("stack.html", "Stack", std::vector{loop.get<Recorder>().recording()});
}
