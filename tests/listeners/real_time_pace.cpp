#include "scenes.hpp"

#include <delassus/listeners/real_time_pace.hpp>

#include "catch.hpp"

using namespace scenes;

namespace {

using Pace = BasicRealTimePace<ScriptedClock>;

/// Stands for the work of a step: it takes `seconds` of the scripted clock.
struct Work {
  using plays = role::Listener;
  using listens = Listens<stage::Begin>;
  double* time;
  const double* seconds;
  void after(stage::Begin, const auto&) { *time += *seconds; }
};

/// Times are multiples of 1/16 s, so sums are exact. The pace comes first: it starts its stopwatch before the work.
struct Run {
  double time = 100, seconds = 0;
  AnimationLoop<World<RigidBodies>, Pace, Work> loop;

  explicit Run(double catch_up, int keep = 4096)
      : loop{World{RigidBodies{}}, Pace{catch_up, ScriptedClock{&time}, keep}, Work{&time, &seconds}} {}
  Run(const Run&) = delete;

  void step(double h, double work) {
    seconds = work;
    loop.step(h);
  }
  auto statistics() { return loop.get<Pace>().statistics(); }
};

}  // namespace

TEST_CASE("a step that is done early ends when its time has come") {
  Run run(0);
  for (int n = 1; n <= 10; ++n) {
    run.step(0.5, 0.1875);
    REQUIRE(run.time == 100 + 0.5 * n);
  }
  const auto s = run.statistics();
  REQUIRE(s.steps == 10);
  REQUIRE(s.overruns == 0);
  REQUIRE(s.late == 0);
  REQUIRE(s.mean_period == 0.5);
  REQUIRE(s.max == 0.1875);
}

TEST_CASE("what the host does between two steps is part of the period") {
  Run run(0);
  for (int n = 1; n <= 10; ++n) {
    run.step(0.5, 0.125);
    REQUIRE(run.time == 100 + 0.5 * n);
    run.time += 0.25;
  }
}

TEST_CASE("lateness is dropped, or caught up by steps that do not sleep") {
  for (const double catch_up : {0.0, 0.5, 1e9}) {
    Run run(catch_up);
    run.step(0.5, 0.25);   // ends at 0.5
    run.step(0.5, 1.75);   // due at 1, ends at 2.25: 1.25 late
    REQUIRE(run.time == 102.25);
    run.step(0.5, 0.25);
    const double dropped = std::max(0.0, 1.25 - catch_up);
    // The next one is due half a second after the schedule as it was moved, and ends at 2.5 or then.
    REQUIRE(run.time == std::max(102.5, 101.5 + dropped));
    for (int n = 0; n < 20; ++n) run.step(0.5, 0.25);
    REQUIRE(run.time == 100 + 23 * 0.5 + dropped);
    const auto s = run.statistics();
    REQUIRE(s.overruns == 1);
    REQUIRE(s.dropped == dropped);
    REQUIRE(s.worst_lateness == 1.25);
    REQUIRE(s.late == (catch_up == 0 ? 1 : catch_up == 0.5 ? 2 : 5));
  }
}

TEST_CASE("an overrun is a step whose own work took longer than it simulates, late or not") {
  Run run(1e9);
  run.step(1.0, 0.25);
  run.step(0.5, 0.5);     // as long as h: no overrun
  run.step(0.5, 0.5625);  // overrun, and late
  REQUIRE(run.statistics().overruns == 1);
  REQUIRE(run.statistics().late == 1);
  run.step(0.5, 0.25);
  run.step(0.5, 0.25);
  run.time += 0.25;
  run.step(0.5, 0.5);     // late by the host, no overrun
  REQUIRE(run.statistics().overruns == 1);
  REQUIRE(run.statistics().late == 2);
}

TEST_CASE("median and 99 % are those of the latest steps, the largest is of all") {
  Run run(1e9, 100);
  run.step(1, 64);
  for (int n = 1; n <= 100; ++n) run.step(1, n / 128.0);
  const auto s = run.statistics();
  REQUIRE(s.p50 == 50 / 128.0);
  REQUIRE(s.p99 == 99 / 128.0);
  REQUIRE(s.max == 64);
}

TEST_CASE("the motion does not know of the pace") {
  Run run(0);
  AnimationLoop plain{World{RigidBodies{}}};
  const auto a = rigid_bodies(run.loop).add({.position = {0, 0, 5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto b = rigid_bodies(plain).add({.position = {0, 0, 5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  for (int n = 0; n < 100; ++n) run.step(0.01, 0.25 * (n % 3)), plain.step(0.01);
  REQUIRE(rigid_bodies(run.loop).position(a) == rigid_bodies(plain).position(b));
}

TEST_CASE("a catch-up below zero is refused") {
  REQUIRE_THROWS_WITH(RealTimePace(-1), "delassus: RealTimePace: catch_up -1 s must be >= 0");
  REQUIRE_THROWS_WITH(RealTimePace(std::nan("")), Catch::Contains("RealTimePace: catch_up"));
  REQUIRE_THROWS_WITH(RealTimePace(0, {}, 0), Catch::Contains("RealTimePace: keep 0"));
}
