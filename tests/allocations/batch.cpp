// Steps and resets of many worlds.
#include "allocations/count_allocations.hpp"

#include "allocations/allocation_scenes.hpp"

#include <delassus/study/batch.hpp>

#include "study/slides.hpp"
#include "study/worker_threads.hpp"

namespace {

/// Of steps, observations and resets after others of their kind.
template <class Execution>
long allocations_in_turn(Execution execution) {
  Batch batch{slides::make_slide, slides::frictions, std::move(execution)};
  std::vector<double> lows(slides::frictions.size());
  const auto turn = [&] {
    for (int n = 0; n < 100; ++n) {
      batch.step(0.01);
      batch.each([&](auto& loop, double, Index i) { lows[std::size_t(i)] = slides::places(loop)[0]; });
      if (n % 30 == 29) batch.reset(n % batch.size());
    }
    batch.reset();
  };
  for (int k = 0; k < 3; ++k) turn();
  const long before = allocations;
  Eigen::internal::set_is_malloc_allowed(false);
  turn();
  Eigen::internal::set_is_malloc_allowed(true);
  return allocations - before;
}

}  // namespace

TEST_CASE("warm steps and resets of a batch allocate nothing with one thread") { CHECK(allocations_in_turn(Serial{}) == 0); }

TEST_CASE("warm steps and resets of a batch allocate nothing with two threads") {
  CHECK(allocations_in_turn(WorkerThreads(2)) == 0);
}
