// Another thread looks at the constraint problem of a running loop; neither thread waits.
// prints: the reader saw [1-9][0-9]* problems, the last of [0-9.]+ s, 0 skipped
#include <delassus/delassus.hpp>

#include <atomic>
#include <cstdio>
#include <thread>

using namespace delassus;

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     DoubleBuffer{.reserve = 4096}};  // room for arrays of so many elements, from the start
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  for (int i = 0; i < 5; ++i) rigid.add({.position = {0, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});

  auto& channel = loop.channel<DoubleBuffer>();  // before the threads start
  std::atomic<bool> is_done{false};
  int seen = 0;
  double last = 0;
  std::thread reader([&] {
    bool is_last = false;
    while (!is_last) {
      is_last = is_done;
      if (!channel.fetch()) continue;
      ++seen;
      last = channel.front().time;  // and channel.front().problem, the reader's own until it fetches again
    }
  });
  for (int i = 0; i < 200; ++i) loop.step(5e-3);
  is_done = true;
  reader.join();
  std::printf("the reader saw %d problems, the last of %.3f s, %d skipped\n", seen, last, int(channel.skipped()));
}
