#include <delassus/delassus.hpp>
#include <delassus/io/checkpoint.hpp>

#include "catch.hpp"

#include <type_traits>

using namespace delassus;

namespace {

/// A box that slides on the ground, hung to a hook by a ball joint, with `Listeners`.
template <class... Listeners>
auto scene(Listeners... listeners) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}, BallJoint{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-8}, listeners...};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto box = rigid.add({.position = {0, 0, 0.5}, .velocity = {1, 0, 0}, .mass = 1.0, .shape = Box{1, 1, 1}});
  loop.add(BallJoint::Item{anchor(rigid, box, {0.5, 0, 0.5}), world_anchor({0.5, 0, 1})});
  return loop;
}

template <class A, class B>
bool same_problem(const A& a, const B& b) {
  return a.rows.template pool<0>().d == b.rows.template pool<0>().d &&
         a.rows.template pool<0>().lambda == b.rows.template pool<0>().lambda &&
         a.rows.template pool<1>().lambda == b.rows.template pool<1>().lambda &&
         a.W.template blocks<0, 1>().block == b.W.template blocks<0, 1>().block &&
         a.laws.template pool<0>().items.size() == b.laws.template pool<0>().items.size() && a.h == b.h;
}

}  // namespace

TEST_CASE("a double buffer shows the problem of the last step, and a reader who comes late sees the newest") {
  auto loop = scene(DoubleBuffer{});
  auto& channel = loop.template channel<DoubleBuffer>();
  REQUIRE_FALSE(channel.fetch());
  for (int n = 1; n <= 7; ++n) {
    const double start = loop.time();
    loop.step(1e-2);
    if (n == 2 || n == 3) continue;
    REQUIRE(channel.fetch());
    REQUIRE(channel.front().sequence == std::uint64_t(n));
    REQUIRE(channel.front().time == start);
    REQUIRE(channel.front().problem.rows.row_count() == loop.report().rows);
    REQUIRE(same_problem(channel.front().problem, loop.problem()));
    REQUIRE_FALSE(channel.fetch());
  }
}

TEST_CASE("a reader that solves its snapshot anew finds, bit for bit, what the loop's own problem gives") {
  auto loop = scene(DoubleBuffer{});
  auto& channel = loop.template channel<DoubleBuffer>();
  for (int n = 0; n < 5; ++n) loop.step(1e-2);
  channel.fetch();
  auto& problem = channel.front().problem;
  auto own = loop.problem();
  for (auto* p : {&problem, &own}) p->rows.template pool<1>().lambda[0] = Vec3(0.1, 0.2, 0.3);
  REQUIRE(solve(problem, GaussSeidel{.max_iterations = 20}).measure.residual ==
          solve(own, GaussSeidel{.max_iterations = 20}).measure.residual);
  REQUIRE(same_problem(problem, own));
  REQUIRE(problem.rows.template pool<1>().lambda[0] != Vec3(0.1, 0.2, 0.3));
}

TEST_CASE("what the reader writes in its snapshot reaches neither the loop nor the next snapshot") {
  auto with = scene(DoubleBuffer{});
  auto without = scene();
  auto& channel = with.template channel<DoubleBuffer>();
  for (int n = 0; n < 20; ++n) {
    with.step(1e-2);
    without.step(1e-2);
    channel.fetch();
    REQUIRE(same_problem(channel.front().problem, without.problem()));
    for (auto& lambda : channel.front().problem.rows.template pool<0>().lambda) lambda.setConstant(1e9);
  }
}

// A box on the ground is four contacts, each of which meets the other three: 12 blocks of W. Two boxes on each other are
// eight contacts, and more than 20 blocks.
TEST_CASE("a problem without room is passed over and counted; the reader keeps the one before, and gets the next that fits") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.3}}}, DoubleBuffer{.reserve = 20}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& channel = loop.channel<DoubleBuffer>();
  rigid.add_fixed(HalfSpace{});
  rigid.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  loop.step(1e-2);
  REQUIRE(channel.fetch());
  REQUIRE(channel.needed() == 12);
  const auto upper = rigid.add({.position = {0, 0, 1.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int n = 1; n <= 3; ++n) {
    loop.step(1e-2);
    REQUIRE_FALSE(channel.fetch());
    REQUIRE(channel.skipped() == std::uint64_t(n));
    REQUIRE(channel.front().problem.rows.pool<0>().items() == 4);
  }
  REQUIRE(channel.needed() > 20);
  loop.remove(upper);
  loop.step(1e-2);
  REQUIRE(channel.fetch());
  REQUIRE(channel.front().sequence == 5);
  REQUIRE(channel.skipped() == 3);
}

TEST_CASE("the channel stays where it is when its loop moves") {
  auto loop = scene(DoubleBuffer{});
  auto& channel = loop.template channel<DoubleBuffer>();
  auto moved = std::move(loop);
  moved.step(1e-2);
  REQUIRE(channel.fetch());
  REQUIRE(&moved.template channel<DoubleBuffer>() == &channel);
}

// The reader has a reference to the loop's channel: a restore may not put another in its place, nor a clone write into it.
TEST_CASE("a restored loop keeps its channel and a clone has one of its own") {
  auto loop = scene(DoubleBuffer{});
  auto& channel = loop.template channel<DoubleBuffer>();
  loop.step(1e-2);
  const auto bytes = checkpoint(loop);
  loop.step(1e-2);
  REQUIRE(channel.fetch());
  restore(loop, bytes);
  CHECK(&loop.template channel<DoubleBuffer>() == &channel);
  CHECK_FALSE(channel.fetch());
  CHECK(channel.front().sequence == 2);
  auto other = loop.clone();
  auto& its = other.template channel<DoubleBuffer>();
  CHECK(&its != &channel);
  other.step(1e-2);
  CHECK_FALSE(channel.fetch());
  CHECK(its.fetch());
  loop.step(1e-2);
  REQUIRE(channel.fetch());
  CHECK(channel.front().sequence == 3);
  CHECK(same_problem(channel.front().problem, its.front().problem));
  CHECK(state_hash(other) == state_hash(loop));
}

TEST_CASE("a loop without a double buffer has no room for one") {
  using Without = decltype(scene());
  struct Deaf {
    using plays = role::Listener;
    using listens = Listens<>;
  };
  // A listener of one number and a pointer to the channel.
  static_assert(sizeof(decltype(scene(DoubleBuffer{}))) <= sizeof(Without) + 2 * sizeof(void*));
  static_assert(sizeof(decltype(scene(Deaf{}))) <= sizeof(decltype(scene(DoubleBuffer{}))) - sizeof(void*));
  SUCCEED();
}
