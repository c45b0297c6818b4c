#include "catch.hpp"
#include "collision/boxes.hpp"

#include <delassus/collision/sweep_and_prune.hpp>

#include <algorithm>
#include <random>
#include <vector>

namespace sweep_and_prune_tests {

using namespace delassus;
using samples::brute_force;

namespace {

std::vector<CandidatePair> sorted(std::vector<CandidatePair> pairs) {
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

TEST_CASE("sweep and prune finds every pair once, while boxes move, come, go and vanish") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Aabb> boxes;
  SweepAndPrune broad;
  std::vector<CandidatePair> pairs;
  for (int step = 0; step < 60; ++step) {
    if (step % 10 == 0) {
      boxes.resize(std::size_t(50 + 30 * (step % 40)));
      for (Aabb& box : boxes) {
        const Vec3 centre = 10 * Vec3{uniform(random), uniform(random), 0.2 * uniform(random)};
        const Vec3 half = Vec3{1.1 + uniform(random), 1.1 + uniform(random), 1.1 + uniform(random)} * 0.5;
        box = Aabb(centre - half, centre + half);
      }
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Vec3 move = 0.05 * Vec3{uniform(random), uniform(random), uniform(random)};
      boxes[i] =
          i % 17 == std::size_t(step % 17) ? Aabb() : Aabb(boxes[i].min() + move, boxes[i].max() + move);
      if (boxes[i].min()[0] > 1e100) boxes[i] = Aabb(Vec3::Zero(), Vec3::Ones());
    }
    pairs.clear();
    broad.find(boxes, pairs);
    CHECK(sorted(pairs) == brute_force(boxes));
  }
}

TEST_CASE("boxes that only touch are a pair") {
  const std::vector<Aabb> boxes{Aabb(Vec3::Zero(), Vec3::Ones()), Aabb(Vec3::UnitX(), Vec3(2, 1, 1)),
                                Aabb(Vec3(2.1, 0, 0), Vec3(3, 1, 1))};
  std::vector<CandidatePair> pairs;
  SweepAndPrune{}.find(boxes, pairs);
  CHECK(pairs == std::vector<CandidatePair>{{0, 1}});
}

}  // namespace sweep_and_prune_tests
