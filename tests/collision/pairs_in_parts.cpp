// Detection by several workers: who runs it, and that its answer is that of one.
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>

#include "../worker_threads.hpp"
#include "catch.hpp"

namespace pairs_in_parts_tests {

using namespace delassus;

namespace {

/// Threads, and how many lists of several tasks they were given.
struct CountedThreads : WorkerThreads {
  int* lists = nullptr;
  void run(Index tasks, auto&& f) const {
    if (tasks > 1) ++*lists;
    WorkerThreads::run(tasks, f);
  }
};

template <class Backend, class... More>
auto contacts_by(Backend backend, More... more) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}, std::move(backend),
                     more...};
  bodies<RigidBodies>(loop.world()).gravity = zero<Vec3>();
  return loop;
}
Vec3 place(int k, double spacing) { return spacing * Vec3(k % 8, k / 8 % 8, k / 64); }

/// Rods side by side, all turned by 45 degrees: so near that their boxes are in each other, they do not touch. Pairs have
/// no work then but that of their distance.
void add_rods(auto& loop, double spacing) {
  const Quat turned(std::cos(M_PI / 8), 0, 0, std::sin(M_PI / 8));
  for (int k = 0; k < 512; ++k)
    bodies<RigidBodies>(loop.world())
        .add({.position = place(k, spacing), .orientation = turned, .mass = 1.0, .shape = Box{0.96, 0.1, 0.1}});
}
/// Balls and boxes that fly through each other.
void add_swarm(auto& loop) {
  for (int k = 0; k < 512; ++k) {
    const Vec3 way(std::sin(1.0 + 3 * k), std::sin(2.0 + 5 * k), std::sin(3.0 + 7 * k));
    bodies<RigidBodies>(loop.world())
        .add({.position = place(k, 1.0),
              .orientation = Quat(1, 0.3 * way[0], 0.3 * way[1], 0.3 * way[2]).normalized(),
              .velocity = 5 * way,
              .mass = 1.0,
              .shape = k % 3 > 0 ? Shape(Sphere{0.49}) : Shape(Box{0.5, 0.6, 0.5})});
  }
}
template <class Backend>
void check(const Backend& backend) {
  const auto lists_of = [&](double spacing, bool are_pairs) {
    int lists = 0;
    auto apart = contacts_by(backend, CountedThreads{{{}, 3}, &lists});
    add_rods(apart, spacing);
    apart.step(1e-3);
    REQUIRE(apart.report().rows == 0);
    REQUIRE((apart.report().pairs > 0) == are_pairs);
    return lists;
  };
  CHECK(lists_of(0.7, true) > lists_of(2, false));

  auto alone = contacts_by(backend);
  add_swarm(alone);
  for (int k = 0; k < 20; ++k) alone.step(0.01);
  REQUIRE(alone.report().contacts > 50);
  for (const int count : {1, 2, 3, 8}) {
    int lists = 0;
    auto shared = contacts_by(backend, CountedThreads{{{}, count}, &lists});
    add_swarm(shared);
    for (int k = 0; k < 20; ++k) shared.step(0.01);
    CHECK(state_hash(shared) == state_hash(alone));
    CHECK(shared.report().pairs == alone.report().pairs);
    CHECK(shared.report().queries == alone.report().queries);
  }
}

}  // namespace

TEST_CASE("detection by several workers is that of one, behind any layer") {
  SECTION("NativeCollision") { check(NativeCollision{}); }
  SECTION("WithFilter and WithCompounds") { check(WithFilter{WithCompounds{NativeCollision{}}}); }
  SECTION("WithSurfaces") { check(WithSurfaces{NativeCollision{}}); }
}

}  // namespace pairs_in_parts_tests
