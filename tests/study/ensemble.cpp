#include <delassus/io/csv.hpp>
#include <delassus/study/ensemble.hpp>
#include <delassus/study/ensemble_table.hpp>

#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "catch.hpp"
#include "study/slides.hpp"
#include "study/worker_threads.hpp"

namespace ensemble_tests {

using namespace slides;

namespace {

EnsemblePlan slide_plan() {
  return {.name = "slides", .steps = 60, .h = 0.01, .observations = {"low (m)", "high (m)"}, .is_quiet = true};
}

struct Backwards {
  using plays = role::Execution;
  static Index workers() { return 1; }
  static void run(Index tasks, auto&& f) {
    for (Index task = tasks; task-- > 0;) f(task, Index(0));
  }
};

template <class F>
std::string refusal(F&& f) {
  try {
    f();
  } catch (const InvalidArgument& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("every world of an ensemble has the bits that it has alone, with 1, 2, 3 and 8 workers") {
  const std::vector<std::uint64_t> alone = hashes_alone(60, 0.01);
  for (std::size_t i = 1; i < alone.size(); ++i) REQUIRE(alone[i] != alone[i - 1]);  // frictions matter
  const Ensemble ensemble{make_slide, frictions};
  const auto check = [&](const EnsembleResults& results) {
    REQUIRE(results.runs.size() == frictions.size());
    CHECK(results.failed() == 0);
    for (std::size_t i = 0; i < frictions.size(); ++i) {
      const EnsembleRun& run = results.runs[i];
      CHECK(run.number == long(i));
      CHECK(run.steps == 60);
      CHECK(run.hash == alone[i]);
    }
  };
  const EnsembleResults serial = ensemble.run(slide_plan(), places);
  check(serial);
  for (const Index workers : {1, 2, 3, 8}) {
    CAPTURE(workers);
    const EnsembleResults results = ensemble.run(slide_plan(), places, WorkerThreads(workers));
    check(results);
    for (std::size_t i = 0; i < frictions.size(); ++i) CHECK(results.runs[i].values == serial.runs[i].values);
  }
}

TEST_CASE("tasks in the wrong order change nothing") {
  const Ensemble ensemble{make_slide, frictions};
  const EnsembleResults forwards = ensemble.run(slide_plan(), places), backwards = ensemble.run(slide_plan(), places, Backwards{});
  for (std::size_t i = 0; i < frictions.size(); ++i) CHECK(backwards.runs[i].hash == forwards.runs[i].hash);
}

TEST_CASE("rows are observed at the start and every so many steps, the end being the last") {
  EnsemblePlan plan = slide_plan();
  plan.every = 20;
  const Ensemble ensemble{make_slide, std::vector{0.1, 0.9}};
  const EnsembleResults results = ensemble.run(plan, [](const auto& loop, double friction) { return std::vector{loop.time(), friction}; });
  for (const EnsembleRun& run : results.runs) {
    REQUIRE(run.rows() == 4);
    for (std::size_t r = 0; r < 4; ++r) {
      // 20 r additions of 0.01, each of which rounds a number below 1 by at most half its last place.
      CHECK(run.row(r)[0] == Approx(0.2 * double(r)).margin(60 * 0.5 * std::numeric_limits<double>::epsilon()));
      CHECK(plan.time(r) == 20. * double(r) * 0.01);
      CHECK(run.row(r)[1] == ensemble.parameters()[std::size_t(run.number)]);
    }
    CHECK(run.last()[0] == run.row(3)[0]);
  }
}

TEST_CASE("a run that throws or is quarantined is kept as failed with its sentence, and the others go on") {
  enum What { sound, refused, thrown, strange, quarantined };
  EnsemblePlan plan = slide_plan();
  plan.observations = {"low (m)"};
  plan.every = 20;
  const Ensemble ensemble{[](int what) {
                            if (what == refused) throw InvalidArgument("this world\tis not wanted\n");
                            auto loop = make_slide(0.2);
                            auto& rigid = bodies<RigidBodies>(loop.world());
                            if (what == quarantined) rigid.gravity.x() = std::numeric_limits<double>::quiet_NaN();
                            return loop;
                          },
                          std::vector<int>{sound, refused, thrown, sound, strange, quarantined}};
  const auto observe = [](const Loop& loop, int what) {
    if (what == thrown && loop.time() > 0.3) throw std::runtime_error("the box is away");
    if (what == strange) throw 42;
    return places(loop)[0];
  };
  for (const Index workers : {1, 3}) {
    const EnsembleResults results = ensemble.run(plan, observe, WorkerThreads(workers));
    CHECK(results.failed() == 4);
    const auto& runs = results.runs;
    CHECK(runs[0].is_sound());
    CHECK(runs[3].hash == runs[0].hash);
    CHECK(runs[1].failure == "this world is not wanted ");
    CHECK(runs[1].steps == 0);
    CHECK(runs[2].failure == "the box is away");
    CHECK(runs[2].steps == 40);
    CHECK(runs[2].rows() == 2);
    CHECK(runs[2].row(1)[0] == runs[0].row(1)[0]);
    CHECK(runs[2].hash == 0);
    CHECK(runs[4].failure == "something that is no std::exception was thrown");
    CHECK(runs[5].failure.find("gravity of its set is not finite") != std::string::npos);
    CHECK(runs[5].steps == 1);
    CHECK(refusal([&] { runs[2].last(); }) == "delassus: ensemble: run 2 has no last row; it failed: the box is away");
    CHECK(refusal([&] { runs[2].row(2); }) ==
          "delassus: ensemble: run 2 has 2 rows, none is number 2; it failed: the box is away");
    CHECK(refusal([&] { runs[0].row(4); }) == "delassus: ensemble: run 0 has 4 rows, none is number 4");
  }
}

TEST_CASE("a table of an ensemble has a line for each row, and a failed run keeps its place") {
  EnsembleResults results{.plan = slide_plan(), .runs = {}};
  results.plan.every = 30;
  results.runs = {{.number = 0, .parameters = "0.5", .steps = 60, .capped_steps = 2, .width = 2, .values = {0, 1, 2, 3, 4, 5}},
                  {.number = 1, .parameters = "0.5 7", .failure = "no, never", .steps = 7, .width = 2, .values = {}}};
  CHECK(csv_text(runs_table(results, 3)) ==
        "run,parameters,time (s),low (m),high (m),steps not converged,failure\n"
        "0,0.5,0,0,1,2,\n"
        "0,0.5,0.3,2,3,2,\n"
        "0,0.5,0.6,4,5,2,\n"
        "1,0.5 7,0.07,,,0,\"no, never\"\n");
}

TEST_CASE("parameters are known by their text where they are numbers or words") {
  using inner::parameters_text;
  struct Named {
    double a = 1;
    std::string code() const { return "a" + std::to_string(a); }
  };
  struct Unnamed {
    double a = 1;
  };
  CHECK(parameters_text(0.1) == "0.1");
  CHECK(parameters_text(1. / 3) == "0.3333333333333333");
  CHECK(parameters_text(7) == "7");
  CHECK(parameters_text(std::string("on ice")) == "on ice");
  CHECK(parameters_text(std::array{0.5, 2.}) == "0.5 2");
  CHECK(parameters_text(std::pair{3, "x"}) == "3 x");
  CHECK(parameters_text(std::vector{std::tuple{1, 0.25}, std::tuple{2, 0.5}}) == "(1 0.25) (2 0.5)");
  CHECK(parameters_text(Named{}) == "a1.000000");
  CHECK_FALSE(parameters_text(Unnamed{}));
  CHECK_FALSE(parameters_text(std::vector{Unnamed{}}));
}

// A log takes a run for done by this text: each of a pair is another run.
TEST_CASE("parameters that differ have texts that differ, in one line and one field") {
  using inner::parameters_text;
  using Lists = std::vector<std::vector<double>>;
  using Words = std::vector<std::string>;
  const auto differ = [](const auto& a, const auto& b) {
    const auto one = parameters_text(a), other = parameters_text(b);
    REQUIRE((one && other));
    CHECK(*one != *other);
    for (const auto& text : {*one, *other}) CHECK(text.find_first_of("\t\n\r") == text.npos);
  };
  differ(Lists{{1, 2}, {3}}, Lists{{1}, {2, 3}});
  differ(Lists{{}, {1}}, Lists{{1}, {}});
  differ(Words{"a b", "c"}, Words{"a", "b c"});
  differ(Words{"", "1"}, Words{"1"});
  differ(Words{""}, Words{});
  differ(Words{"(a", "b)"}, Words{"(a b)"});
  differ(std::string("a\tb"), std::string("a b"));
  differ(std::string("a\tb"), std::string("\"a\\tb\""));
  differ(std::string("1"), std::string("1\n"));
  differ(std::pair{Words{"1"}, Words{"2", "3"}}, std::pair{Words{"1", "2"}, Words{"3"}});
}

TEST_CASE("an ensemble that cannot be run is refused in one sentence") {
  const Ensemble ensemble{make_slide, frictions};
  const auto with = [&](auto edit) {
    EnsemblePlan plan = slide_plan();
    edit(plan);
    return refusal([&] { ensemble.run(plan, places); });
  };
  CHECK(refusal([] { Ensemble(make_slide, std::vector<double>{}); }) ==
        "delassus: ensemble: the list of parameters is empty; give it those of one run at least");
  CHECK(with([](auto& p) { p.h = 0; }) == "delassus: ensemble 'slides': h 0 s must be finite and > 0");
  CHECK(with([](auto& p) { p.h = -1; }) == "delassus: ensemble 'slides': h -1 s must be finite and > 0");
  CHECK(with([](auto& p) { p.steps = -5; }) == "delassus: ensemble 'slides': steps -5 must be > 0");
  CHECK(with([](auto& p) { p.steps = 0; }) == "delassus: ensemble 'slides': steps 0 must be > 0");
  CHECK(with([](auto& p) { p.every = 7; }) == "delassus: ensemble 'slides': every 7 must be 0, or divide steps 60");
  CHECK(with([](auto& p) { p.every = -1; }) == "delassus: ensemble 'slides': every -1 must be 0, or divide steps 60");
  CHECK(with([](auto& p) { p.shard = 4, p.shards = 4; }) == "delassus: ensemble 'slides': shard 4 must be one of 0 … 3");
  CHECK(with([](auto& p) { p.observations.clear(); }) ==
        "delassus: ensemble 'slides': observations is empty; name at least one number that observe returns");
  CHECK(with([](auto& p) { p.observations = {"low (m)"}; }) ==
        "delassus: ensemble 'slides': observe returned 2 numbers, but observations names 1");
  CHECK(with([](auto&) {}) == "accepted");
}

}  // namespace ensemble_tests
