// Worlds of an ensemble and of a batch on four threads, built with -fsanitize=thread, which tells of a data race. A program of
// its own: it returns 1 when a world has other bits than alone.
#include <delassus/delassus.hpp>
#include <delassus/study/batch.hpp>
#include <delassus/study/ensemble.hpp>

#include <cstdio>
#include <filesystem>

#include "../scratch_path.hpp"
#include "../study/worker_threads.hpp"

using namespace delassus;

namespace {

/// Shares the points of its hull with the other worlds, and has materials and sleepers.
struct MakeHeap {
  ConvexHull hull;
  auto operator()(double friction) const {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}, BallJoint{}}, Sleeping{}};
    auto& rigid = bodies<RigidBodies>(loop.world());
    const Index ice = loop.materials().add({.friction = 0.1});
    rigid.add_fixed(HalfSpace{});
    const Shape shapes[] = {Box{0.4, 0.3, 0.2}, hull, Sphere{0.2}};
    for (int i = 0; i < 6; ++i)
      rigid.add({.position = {0.05 * i, 0, 0.3 + 0.45 * i}, .mass = 1.0, .shape = shapes[i % 3], .material = i % 2 ? ice : 0});
    loop.add(BallJoint::Item{anchor(rigid, rigid.handle(1)), world_anchor({0, 0, 0.5})});
    return loop;
  }
};

}  // namespace

int main() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 0.2 : -0.2, i & 2 ? 0.15 : -0.15, i & 4 ? 0.25 : -0.25});
  const MakeHeap make_heap{ConvexHull(corners)};
  const std::vector<double> frictions{0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
  std::vector<std::uint64_t> alone;
  for (const double friction : frictions) {
    auto loop = make_heap(friction);
    for (int n = 0; n < 100; ++n) loop.step(0.01);
    alone.push_back(state_hash(loop));
  }

  int wrong = 0;
  const WorkerThreads threads(4);
  const Ensemble ensemble{make_heap, frictions};
  const EnsemblePlan plan{.name = "heaps", .steps = 100, .h = 0.01, .observations = {"x (m)"}, .every = 10, .log = scratch_path("heaps.tsv").string()};
  const auto observe = [](const auto& loop) {
    const auto& rigid = bodies<RigidBodies>(loop.world());
    return rigid.position(rigid.handle(6)).x();
  };
  for (const EnsembleRun& run : ensemble.run(plan, observe, threads).runs) wrong += run.hash != alone[std::size_t(run.number)];
  wrong += ensemble.run(plan, observe, threads).resumed != long(frictions.size());
  std::filesystem::remove(plan.log);

  Batch batch{make_heap, frictions, threads};
  for (int n = 0; n < 50; ++n) batch.step(0.01);
  batch.reset();
  for (int n = 0; n < 100; ++n) batch.step(0.01);
  for (Index i = 0; i < batch.size(); ++i) wrong += state_hash(batch.loop(i)) != alone[std::size_t(i)];
  std::printf("%zu worlds, %d wrong\n", frictions.size(), wrong);
  return wrong == 0 ? 0 : 1;
}
