#include "catch.hpp"
#include "scratch_path.hpp"
#include "study/scripted.hpp"
#include "study/worker_threads.hpp"

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace sweep_on_threads_tests {

using namespace scripted;

namespace {

thread_local double seconds = 0;
std::atomic<int> built = 0;

/// A clock of the thread that asks, as ThreadClock is.
struct OwnClock {
  double now() const { return seconds; }
};

/// Scripted loops, each paid for on the thread that steps it.
Loop scene(auto method, auto sweeps) {
  ++built;
  int here = 0;
  return Scene{&seconds, &here}(method, sweeps);
}
const auto make = [](auto... policies) { return scene(policies...); };
const Combinations list{Choices{Method<1>{}, Method<2>{}, Method<3>{}, Method<4>{}}, Choices{Sweeps{}}};
const Measures measures{Compared{"value", "m", value, exact}};

StudyPlan plan_of_runs() {
  return {.name = "on threads", .duration = 1, .steps = {0.5, 0.25, 0.125, 0.0625}, .tolerances = {1e-2, 1e-4, 1e-6}, .outputs = 2, .repeats = 3, .max_seconds = 1e6, .is_quiet = true};
}

}  // namespace

TEST_CASE("a study on several threads has the runs of one in the same order") {
  const StudyPlan plan = plan_of_runs();
  const Study alone = sweep(make, list, plan, measures, References{}, OwnClock{});
  built = 0;
  const Study shared = sweep(make, list, plan, measures, References{}, OwnClock{}, WorkerThreads{4});
  CHECK(built == 48 * (1 + plan.repeats));
  REQUIRE(shared.runs.size() == 48);
  for (std::size_t k = 0; k < 48; ++k) {
    CHECK(shared.runs[k].number == int(k));
    CHECK(shared.runs[k].code == alone.runs[k].code);
    CHECK(shared.runs[k].errors == alone.runs[k].errors);
    // Sums of ones: each thread counts its own.
    CHECK(shared.runs[k].cost == double(shared.runs[k].steps));
  }
}

TEST_CASE("a log that several threads wrote is one that a study goes on from") {
  StudyPlan plan = plan_of_runs();
  const auto path = scratch_path("delassus_study_threads.log");
  std::filesystem::remove(path);
  plan.log = path.string();
  CHECK(sweep(make, list, plan, measures, References{}, OwnClock{}, WorkerThreads{3}).resumed == 0);
  const Study again = sweep(make, list, plan, measures, References{}, OwnClock{});
  CHECK(again.resumed == 48);
  std::filesystem::remove(path);
}

TEST_CASE("a study on threads does not take the clock of the whole process") {
  try {
    sweep(make, list, plan_of_runs(), measures, References{}, ProcessorClock{}, WorkerThreads{2});
    FAIL("accepted");
  } catch (const InvalidArgument& error) {
    CHECK(std::string(error.what()).find("ThreadClock") != std::string::npos);
  }
}

TEST_CASE("an exception of a scene on a thread ends the study and comes out") {
  const auto throws = [](auto method, auto sweeps) {
    if (method.code() == "Method<3, 0>{}") throw std::runtime_error("no such file");
    return scene(method, sweeps);
  };
  CHECK_THROWS_WITH(sweep(throws, list, plan_of_runs(), measures, References{}, OwnClock{}, WorkerThreads{4}), "no such file");
}

}  // namespace sweep_on_threads_tests
