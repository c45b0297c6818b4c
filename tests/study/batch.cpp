#include <delassus/study/batch.hpp>

#include <limits>
#include <memory>
#include <stdexcept>

#include "catch.hpp"
#include "study/slides.hpp"
#include "study/worker_threads.hpp"

namespace batch_tests {

using namespace slides;

namespace {

auto& boxes(auto& loop) { return bodies<RigidBodies>(loop.world()); }

}  // namespace

TEST_CASE("every world of a batch has the bits that it has alone, with 1, 2, 3 and 8 workers") {
  const std::vector<std::uint64_t> alone = hashes_alone(60, 0.01);
  for (const Index workers : {1, 2, 3, 8}) {
    CAPTURE(workers);
    Batch batch{make_slide, frictions, WorkerThreads(workers)};
    REQUIRE(batch.size() == Index(frictions.size()));
    for (int n = 0; n < 60; ++n) batch.step(0.01);
    for (Index i = 0; i < batch.size(); ++i) {
      CHECK(state_hash(batch.loop(i)) == alone[std::size_t(i)]);
      CHECK(batch.parameters(i) == frictions[std::size_t(i)]);
      CHECK(batch.report(i).contacts > 0);
      CHECK(batch.failure(i).empty());
    }
  }
}

TEST_CASE("a world that is reset has the bits of its start, the others go on, and handles stay good") {
  const auto after = [&](int steps) { return hashes_alone(steps, 0.01); };
  const std::vector<std::uint64_t> start = after(0), early = after(30), late = after(60);
  Batch batch{make_slide, frictions, WorkerThreads(2)};
  const auto top = boxes(batch.loop(1)).handle(3);
  const Vec3 place = boxes(batch.loop(1)).position(top);
  for (int n = 0; n < 30; ++n) batch.step(0.01);
  CHECK(boxes(batch.loop(1)).position(top) != place);
  for (Index i = 1; i < batch.size(); i += 2) {
    batch.reset(i);
    CHECK(state_hash(batch.loop(i)) == start[std::size_t(i)]);
    CHECK(batch.loop(i).time() == 0);
  }
  CHECK(boxes(batch.loop(1)).position(top) == place);
  for (int n = 0; n < 30; ++n) batch.step(0.01);
  for (Index i = 0; i < batch.size(); ++i) CHECK(state_hash(batch.loop(i)) == (i % 2 ? early : late)[std::size_t(i)]);

  batch.reset();
  for (int n = 0; n < 60; ++n) batch.step(0.01);
  for (Index i = 0; i < batch.size(); ++i) CHECK(state_hash(batch.loop(i)) == late[std::size_t(i)]);
}

TEST_CASE("a world is reset from a checkpoint of any loop of its type, and one that is damaged leaves it as it was") {
  auto loop = make_slide(0.2);
  for (int n = 0; n < 30; ++n) loop.step(0.01);
  const std::vector<char> bytes = checkpoint(loop);
  for (int n = 0; n < 30; ++n) loop.step(0.01);
  Batch batch{make_slide, std::vector{0.2, 0.9}};
  batch.step(0.01);
  batch.reset(0, bytes);
  const std::uint64_t other = state_hash(batch.loop(1));
  CHECK_THROWS_AS(batch.reset(1, std::span(bytes).first(bytes.size() - 1)), InvalidArgument);
  CHECK(state_hash(batch.loop(1)) == other);
  for (int n = 0; n < 30; ++n) batch.step(0.01);
  CHECK(state_hash(batch.loop(0)) == state_hash(loop));
}

TEST_CASE("a world that is reset after a body was taken out has it again") {
  Batch batch{make_slide, std::vector{0.2}};
  auto& loop = batch.loop(0);
  const auto top = boxes(loop).handle(3);
  for (int n = 0; n < 10; ++n) batch.step(0.01);
  loop.remove(top);
  const auto extra = boxes(loop).add({.position = {5, 0, 0.6}, .mass = 1.0, .shape = Sphere{0.5}});
  for (int n = 0; n < 10; ++n) batch.step(0.01);
  batch.reset(0);
  CHECK(boxes(loop).contains(top));
  CHECK_FALSE(boxes(loop).contains(extra));
  for (int n = 0; n < 60; ++n) batch.step(0.01);
  CHECK(state_hash(loop) == hashes_alone(60, 0.01)[1]);
}

TEST_CASE("a world that throws or is quarantined stays, with its sentence, until it is reset") {
  Batch batch{make_slide, frictions, WorkerThreads(3)};
  for (int n = 0; n < 10; ++n) batch.step(0.01);
  boxes(batch.loop(2)).gravity.x() = std::numeric_limits<double>::quiet_NaN();
  batch.loop(4).policy<role::Solver>().tolerance = -1;
  for (int n = 0; n < 20; ++n) batch.step(0.01);
  const std::vector<std::uint64_t> sound = hashes_alone(30, 0.01);
  for (Index i = 0; i < batch.size(); ++i) {
    CHECK(batch.failure(i).empty() == (i != 2 && i != 4));
    if (i != 2 && i != 4) CHECK(state_hash(batch.loop(i)) == sound[std::size_t(i)]);
  }
  CHECK(batch.failure(2).find("the gravity of its set is not finite") != std::string::npos);
  CHECK(batch.failure(4).find("tolerance") != std::string::npos);
  CHECK(batch.loop(2).time() == Approx(0.11));  // eleven additions of 0.01: the step of the failure, and none after it
  CHECK(batch.report(2).status == Status::quarantined);
  batch.loop(4).policy<role::Solver>().tolerance = 1e-6;
  batch.reset(2), batch.reset(4);
  CHECK(batch.failure(2).empty());
  CHECK(batch.report(2).status == Status::converged);
  for (int n = 0; n < 30; ++n) batch.step(0.01);
  CHECK(state_hash(batch.loop(2)) == sound[2]);
}

TEST_CASE("what a program does with each world is done to all of them, several at once") {
  Batch batch{make_slide, frictions, WorkerThreads(3)};
  std::vector<double> lows(frictions.size());
  batch.each([](auto& loop, double, Index i) { boxes(loop).set_velocity(boxes(loop).handle(1), {0.1 * i, 0, 0}); });
  for (int n = 0; n < 20; ++n) {
    batch.step(0.01);
    batch.each([&](const auto& loop, double friction, Index i) { lows[std::size_t(i)] = places(loop)[0] + friction; });
  }
  for (Index i = 0; i < batch.size(); ++i) {
    auto alone = make_slide(frictions[std::size_t(i)]);
    boxes(alone).set_velocity(boxes(alone).handle(1), {0.1 * i, 0, 0});
    for (int n = 0; n < 20; ++n) alone.step(0.01);
    CHECK(lows[std::size_t(i)] == places(alone)[0] + frictions[std::size_t(i)]);
  }
  CHECK_THROWS_AS(batch.each([](auto&, double friction, Index) {
    if (friction == 0.5) throw std::runtime_error("stop");
  }), std::runtime_error);
  CHECK(std::as_const(batch).loop(0).time() > 0);
}

TEST_CASE("a batch that cannot be made or stepped is refused in one sentence") {
  CHECK_THROWS_WITH((Batch{make_slide, std::vector<double>{}}),
                    "delassus: batch: the list of parameters is empty; give it those of one world at least");
  const auto fussy = [](double friction) {
    if (friction > 0.5) throw InvalidArgument("too rough");
    return make_slide(friction);
  };
  CHECK_THROWS_WITH((Batch{fussy, frictions}), "too rough");
  CHECK_THROWS_WITH((Batch{fussy, frictions, WorkerThreads(2)}), "too rough");
  Batch batch{fussy, std::vector{0.2}};
  CHECK_THROWS_WITH(batch.step(0), "delassus: batch: h 0 s must be finite and > 0");
  CHECK_THROWS_WITH(batch.step(std::numeric_limits<double>::quiet_NaN()), "delassus: batch: h nan s must be finite and > 0");
  CHECK_THROWS_WITH(batch.loop(1), "delassus: batch: there is no world 1 among 1");
  CHECK_THROWS_WITH(batch.reset(-1), "delassus: batch: there is no world -1 among 1");
}

}  // namespace batch_tests
