/// The broad phases side by side: boxes of 1 m, about two pairs each, moving 1 cm a step: all of them, or one
/// in twenty.
#include <delassus/adapters/fcl_tree.hpp>
#include <delassus/collision/box_tree.hpp>
#include <delassus/collision/sweep_and_prune.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace delassus;

/// Boxes in a cube, each with a direction of its own, turned back at the walls.
class Crowd {
 public:
  Crowd(Index count, Index moving) : moving_(moving), reach_(0.5 * std::cbrt(2.0 * count)) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (Index i = 0; i < count; ++i) {
      const Vec3 centre = reach_ * any(uniform, random), half = Vec3::Constant(0.5);
      boxes.push_back(Aabb(centre - half, centre + half));
      motion_.push_back(0.01 * any(uniform, random).normalized());
    }
  }

  void step() {
    for (Index i = 0; i < moving_; ++i) {
      const Vec3 centre = boxes[i].center();
      for (int k = 0; k < 3; ++k)
        if (std::abs(centre[k] + motion_[i][k]) > reach_) motion_[i][k] = -motion_[i][k];
      boxes[i] = Aabb(boxes[i].min() + motion_[i], boxes[i].max() + motion_[i]);
    }
  }

  std::vector<Aabb> boxes;

 private:
  static Vec3 any(std::uniform_real_distribution<double>& uniform, std::mt19937& random) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return {x, y, z};
  }

  Index moving_;
  double reach_;
  std::vector<Vec3> motion_;
};

/// ns_per_box is the time of the search alone, thread CPU time, per box and step.
template <class Broad>
void search(benchmark::State& state) {
  const Index count = Index(state.range(0));
  Crowd crowd(count, state.range(1) ? count : count / 20);
  Broad broad;
  std::vector<CandidatePair> pairs;
  for (auto _ : state) {
    state.PauseTiming();
    crowd.step();
    pairs.clear();
    state.ResumeTiming();
    broad.find(crowd.boxes, pairs);
    benchmark::DoNotOptimize(pairs.data());
  }
  state.counters["ns_per_box"] = benchmark::Counter(
      1e-9 * double(count), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["pairs_per_box"] = double(pairs.size()) / count;
}

void sizes(benchmark::internal::Benchmark* b) {
  for (const int moving : {1, 0})
    for (const int count : {10, 100, 1000, 10000}) b->Args({count, moving});
  b->ArgNames({"boxes", "all_move"})->Iterations(60)->Unit(benchmark::kMicrosecond);
}

BENCHMARK_TEMPLATE(search, SweepAndPrune)->Apply(sizes);
BENCHMARK_TEMPLATE(search, FclTree)->Apply(sizes);
BENCHMARK_TEMPLATE(search, BoxTree)->Apply(sizes);

}  // namespace
