// Four threads, and a scheduler of the host's own: the same bits.
// prints: the same bits: yes
#include <delassus/adapters/tbb.hpp>
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/solvers/coloured.hpp>

#include <atomic>
#include <cstdio>
#include <future>
#include <vector>

using namespace delassus;

struct HostThreads : InParallel {
  int count = 2;
  Index workers() const { return count; }  // never changes
  void run(Index tasks, auto&& f) const {  // f(task, worker), once a task
    std::atomic<Index> next = 0;
    const auto work = [&](Index worker) {
      for (Index task; (task = next++) < tasks;) f(task, worker);
    };
    std::vector<std::future<void>> threads;
    for (Index worker = 1; worker < count; ++worker)
      threads.push_back(std::async(std::launch::async, work, worker));
    work(0);
    for (std::future<void>& thread : threads) thread.get();  // throws what a task threw
  }
};

auto run(auto& loop) {
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 60; ++i)
    set.add({.position = {1.5 * (i % 20), 0, 0.51 + 1.01 * (i / 20)}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int k = 0; k < 50; ++k) loop.step(0.01);
  return state_hash(loop);
}

int main() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     Coloured{AcceleratedGaussSeidel{.tolerance = 1e-3}}, Threads{4}};
  AnimationLoop hosted{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                       Coloured{AcceleratedGaussSeidel{.tolerance = 1e-3}}, HostThreads{}};
  std::printf("the same bits: %s\n", run(loop) == run(hosted) ? "yes" : "no");
}
