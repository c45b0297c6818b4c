// Several workers: what they throw, in what order they are called, and how many there may be.
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/solvers/coloured.hpp>

#include "../worker_threads.hpp"
#include "catch.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <stdexcept>

namespace workers_tests {

using namespace delassus;

namespace {

/// A rope that throws at the given call.
struct Rope {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::upper};
  static constexpr auto refines = refine::clamp;
  struct Item {
    Anchor a, b;
    double length = 1;
  };
  inline static std::atomic<int> linearized_until{-1}, solved_until{-1};

  static void count(std::atomic<int>& left, const char* what) {
    if (left.load() >= 0 && left-- == 0) throw std::runtime_error(what);
  }
  void linearize(const Item& item, const auto& world, auto row) const {
    count(linearized_until, "linearize");
    const Vec3 a = world.point(item.a), b = world.point(item.b), span = a - b;
    const Vec3 along = span.normalized();
    row.end(item.a, a).along(0, along);
    row.end(item.b, b).along(0, -along);
    row.phi(0, span.norm() - item.length);
  }
  template <class T>
  Vec<1, T> solve_local(const Item&, const Mat<1, 1, T>& W, const Vec<1, T>& b) const {
    count(solved_until, "solve_local");
    return Vec<1, T>(std::min(T(0), -b[0] / W(0, 0)));
  }
  template <class T>
  void clamp(const Item&, Vec<1, T>& lambda) const {
    lambda[0] = std::min(T(0), lambda[0]);
  }
};

/// One thread that takes the tasks from the last to the first, by workers in turns.
struct Backwards : InParallel {
  Index workers() const { return 3; }
  void run(Index tasks, auto&& f) const {
    for (Index task = tasks; task-- > 0;) f(task, task % 3);
  }
};

/// A chain of more rows than an island needs to be swept by all.
template <class... More>
auto chain(More... more) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Rope{}},
                     Coloured{GaussSeidel{.tolerance = 1e-3, .max_iterations = 50}}, more...};
  auto& set = bodies<RigidBodies>(loop.world());
  const int count = 900;
  static_assert(count > inner::large_island);
  std::array<RigidBodies::Handle, 2> last;
  for (int i = 0; i < count; ++i) {
    last = {last[1], set.add({.position = {1.0 * i, 0, 0},
                              .velocity = {i % 2 ? 1.0 : -1.0, 0.1 * (i % 7), 0},
                              .mass = 1.0,
                              .shape = Sphere{0.1}})};
    if (i > 0) loop.add(Rope::Item{.a = anchor(set, last[0]), .b = anchor(set, last[1])});
  }
  return loop;
}

}  // namespace

TEST_CASE("what a law throws in a sweep that all share ends the step and the next one steps on") {
  auto loop = chain(WorkerThreads{{}, 4});
  auto& left = GENERATE(0, 1) == 0 ? Rope::solved_until : Rope::linearized_until;
  loop.step(1e-3);
  for (const int call : {0, 1, 333, 850}) {
    CAPTURE(call);
    left = call;
    CHECK_THROWS_AS(loop.step(1e-3), std::runtime_error);
    left = -1;
    CHECK_NOTHROW(loop.step(1e-3));
  }
}

TEST_CASE("a scheduler may begin with the last task") {
  auto backwards = chain(Backwards{});
  auto alone = chain();
  for (int k = 0; k < 5; ++k) backwards.step(1e-3), alone.step(1e-3);
  CHECK(state_hash(backwards) == state_hash(alone));
}

TEST_CASE("a loop without a worker is refused") {
  auto loop = chain(WorkerThreads{{}, 0});
  CHECK_THROWS_WITH(loop.step(1e-3), Catch::Contains("has 0 workers; let workers() return 1 or more"));
}

}  // namespace workers_tests
