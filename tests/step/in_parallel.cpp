// Schedulers that a host may bring: what a task throws ends the step, and no order of tasks matters.
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/integrators/symplectic_euler.hpp>
#include <delassus/io/checkpoint.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/coloured.hpp>
#include <delassus/step/in_parallel.hpp>

#include <atomic>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include "catch.hpp"
#include "worker_threads.hpp"

namespace in_parallel_tests {

using namespace delassus;

namespace {

/// The last task first, on one thread.
struct Backwards : InParallel {
  Index workers() const { return 3; }
  template <class F>
  void run(Index tasks, F&& f) const {
    for (Index task = tasks; task-- > 0;) f(task, task % 3);
  }
};

/// Calls until one throws.
std::atomic<int> calls_left;
void call() {
  if (calls_left.fetch_sub(1) == 0) throw std::runtime_error("it breaks");
}
constexpr int never = std::numeric_limits<int>::max();

/// φ = z_a − z_b ≤ 0: a row that pulls.
struct Tie {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::upper};
  struct Item {
    Anchor a, b;
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 a = world.point(item.a), b = world.point(item.b);
    row.end(item.a, a).along(0, Vec3(0, 0, 1));
    row.end(item.b, b).along(0, Vec3(0, 0, -1));
    row.phi(0, a[2] - b[2]);
  }
  Vec<1> solve_local(const Item&, const Mat<1, 1>& W, const Vec<1>& b) const {
    call();
    return Vec<1>(std::min(0.0, -b[0] / W(0, 0)));
  }
};

/// `chains` of balls, each tied to the next, of which every other one flies up.
template <class... More>
auto tied(int chains, int length, More... more) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Tie{}}, more...};
  auto& set = bodies<RigidBodies>(loop.world());
  for (int c = 0; c < chains; ++c)
    for (int k = 0; k < length; ++k) {
      const Vec3 at(k, c, 0);
      const auto ball = set.add(
          {.position = at, .velocity = {0, 0, k % 2 ? 0. : 1.}, .mass = 1. + k % 3, .shape = Sphere{0.1}});
      if (k > 0) loop.add(Tie::Item{anchor(set, set.handle(ball.index - 1)), anchor(set, ball)});
    }
  return loop;
}

struct Brittle : Corotational {
  IsotropicPoint at(const Mat3& F) const {
    call();
    return Corotational::at(F);
  }
  CorotationalLanes at(const LaneMatrix& F) const {
    call();
    return Corotational::at(F);
  }
};

/// A large block that all workers share and small ones, on a floor; the one with this number has a node that
/// flies off so far that no stiffness is a number any more.
template <class Material, class Integrator = ImplicitEuler, class... More>
auto blocks(int nowhere, More... more) {
  using Soft = TetrahedralFem<Material>;
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                     Integrator{}, more...};
  bodies<RigidBodies>(loop.world()).add_fixed(HalfSpace{});
  auto& soft = bodies<Soft>(loop.world());
  Material material;
  material.young = 1e5;
  for (int i = 0; const Index n : {7, 2, 3, 2}) {
    const auto block = soft.add({.mesh = box_mesh({0.4, 0.4, 0.4}, {n, n, n}),
                                 .elasticity = material,
                                 .position = {0, 1. * n, 0.02 + i},
                                 .velocity = {0, 0.1, -0.5},
                                 .contact_radius = 0.01});
    if (i++ == nowhere) soft.set_velocity(soft.node(block, 3), Vec3(0, 0, 1e308));
  }
  return loop;
}

/// The step throws, whichever call does; after that the loop goes on as one that never met it.
template <class Make>
void check_throws(const Make& make) {
  calls_left = never;
  auto whole = make();
  const int before = calls_left;
  whole.step(0.01);
  const int calls = before - calls_left;
  REQUIRE(calls > 100);
  for (const int share : {0, 1, 2, 3}) {
    CAPTURE(share);
    calls_left = never;
    auto loop = make();
    calls_left = share * (calls / 4);
    CHECK_THROWS_WITH(loop.step(0.01), "it breaks");
    calls_left = never;
    loop.step(0.01);
    CHECK(state_hash(loop) == state_hash(whole));
  }
}

}  // namespace

TEST_CASE("what a law throws in a task ends the step") {
  check_throws([] { return tied(60, 5, WorkerThreads{}); });
  const auto shared = [] { return tied(1, 900, Coloured{AcceleratedGaussSeidel{}}, WorkerThreads{}); };
  CHECK(shared().step(0.01).rows > inner::large_island);
  check_throws(shared);
}

TEST_CASE("what a material throws in a task ends the step") {
  check_throws([] { return blocks<Brittle>(-1, WorkerThreads{}); });
}

TEST_CASE("a body whose matrix is no number stops and no other one whoever makes it") {
  for (const int nowhere : {0, 1, 2}) {
    CAPTURE(nowhere);
    auto alone = blocks<Corotational>(nowhere);
    auto many = blocks<Corotational>(nowhere, WorkerThreads{});
    auto& soft = bodies<TetrahedralFem<Corotational>>(alone.world());
    for (int k = 0; k < 3; ++k) {
      const Array<Vec3> before = soft.velocity();
      CHECK(many.step(0.01).status == alone.step(0.01).status);
      for (Index b = 0; k > 0 && b < soft.blocks(); ++b)
        REQUIRE((soft.velocity()[b] == before[b]) == (soft.body_of(b) == nowhere));
    }
    CHECK(state_hash(many) == state_hash(alone));
  }
}

TEST_CASE("nodes whose A is their mass alone move the same whoever asks") {
  auto alone = blocks<Corotational, SymplecticEuler>(-1);
  auto many = blocks<Corotational, SymplecticEuler>(-1, WorkerThreads{});
  for (int k = 0; k < 60; ++k) alone.step(5e-4), many.step(5e-4);
  CHECK(alone.report().contacts > 0);
  CHECK(state_hash(many) == state_hash(alone));
}

TEST_CASE("the last task may come first also where all sweep one island") {
  const auto hash_of = [](auto... more) {
    calls_left = never;
    auto loop = tied(1, 900, Coloured{AcceleratedGaussSeidel{}}, more...);
    for (int k = 0; k < 3; ++k) loop.step(0.01);
    return state_hash(loop);
  };
  CHECK(hash_of(Backwards{}) == hash_of());
}

}  // namespace in_parallel_tests
