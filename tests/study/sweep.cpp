#include "catch.hpp"
#include "study/scripted.hpp"
#include "scratch_path.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using namespace scripted;

namespace {

StudyPlan plan_of(std::vector<double> steps, std::vector<double> tolerances = {}) {
  return {.name = "scripted",
          .duration = 1,
          .steps = std::move(steps),
          .tolerances = std::move(tolerances),
          .outputs = 2,
          .repeats = 3,
          .max_seconds = 1e6,
          .is_quiet = true};
}
const auto compared = [] { return Measures{Compared{"value", "m", value, exact}}; };

std::string fresh_file(const char* name) {
  const auto path = scratch_path(name);
  std::filesystem::remove(path);
  return path.string();
}

}  // namespace

TEST_CASE("a study runs every combination at every tolerance and step, and numbers them in that order") {
  Stage stage;
  const Combinations list{Choices{Method<1>{}, Method<2>{}}, Choices{Sweeps{}}};
  const StudyPlan plan = plan_of({0.25, 0.125}, {1e-2, 1e-4, 1e-6});
  const Study study = sweep(stage.scene, list, plan, compared(), References{}, stage.clock());
  CHECK(announcement(list, plan) ==
        "scripted: 2 combinations × 3 tolerances × 2 steps = 12 runs, each measured once and timed 3 times");
  REQUIRE(study.runs.size() == 12);
  CHECK(study.run_count() == 12);
  for (int k = 0; k < 12; ++k) {
    const StudyRun& run = study.runs[std::size_t(k)];
    CHECK(run.number == k);
    CHECK(run.combination == k / 6);
    CHECK(run.tolerance == plan.tolerances[std::size_t(k / 2 % 3)]);
    CHECK(run.h == plan.steps[std::size_t(k % 2)]);
    // Powers of two and sums below 2: the subtraction of t leaves at most two roundings of a number near 1.
    CHECK(run.errors[0] == Approx(std::pow(run.h, 1 + run.combination) + run.tolerance).margin(4e-16));
    CHECK(run.steps == std::lround(1 / run.h));
    CHECK(run.sweeps == double(run.steps) * (2 + 2 * (k / 2 % 3)));
  }
  CHECK(stage.built == 12 * (1 + plan.repeats));
  CHECK(study.runs[1].code == "Method<1, 0>{}, scripted::Sweeps{.tolerance = 0.01}");
}

TEST_CASE("the cost is the median of the repeats, over whole steps and nothing else") {
  struct Uneven {  // repeats cost 1, 5 and 3 a step; the measured run, and building, are not counted
    double* time;
    int* built;
    Loop operator()(const Sound&) const {
      constexpr double prices[] = {100, 1, 5, 3};
      *time += 1000;
      return {.clock = time, .price = prices[(*built)++ % 4]};
    }
  };
  double time = 0;
  int built = 0;
  const Study study = sweep(Uneven{&time, &built}, Combinations{Choices{Sound{}}}, plan_of({0.125}),
                            compared(), References{}, ScriptedClock{&time});
  CHECK(study.runs[0].cost == 3 * 8);
  CHECK(study.runs[0].least_cost == 1 * 8);
}

TEST_CASE("the cheapest run within a budget is found, and its line is C++ that makes it") {
  Stage stage;
  // Second order costs 3 a step: at h = 1/8 its error 1/64 costs 24. First order needs h = 1/64 for that, and
  // costs 64.
  const Combinations list{Choices{Method<1>{.price = 1}, Method<2>{.price = 3}}};
  const Study study = sweep(stage.scene, list, plan_of({1. / 2, 1. / 4, 1. / 8, 1. / 64}), compared(),
                            References{}, stage.clock());
  const StudyRun* best = study.cheapest(0, 1. / 64);
  REQUIRE(best);
  CHECK(best->combination == 1);
  CHECK(best->h == 1. / 8);
  CHECK(study.line(*best) == "auto loop = scene(Method<2, 0>{});  // then loop.step(0.125)");
  for (const StudyRun& run : study.runs)
    if (run.cost < best->cost) CHECK(run.errors[0] > 1. / 64);
  CHECK(study.cheapest(0, 1. / 4)->combination == 0);  // 4 steps at 1; second order would pay 6 for its 2
  CHECK(study.cheapest(0, 1e-9) == nullptr);
  StudyPlan again = study.plan;
  again.only = best->number;
  const Study alone = sweep(stage.scene, list, again, compared(), References{}, stage.clock());
  REQUIRE(alone.runs.size() == 1);
  CHECK(alone.runs[0].errors == best->errors);
  CHECK(alone.runs[0].code == best->code);
}

TEST_CASE("the front holds the runs that no other beats in both cost and error") {
  Study study{.measures = {{"e", "m", 0}}};
  const auto add = [&](double cost, double error, Outcome outcome) {
    study.runs.push_back(
        {.number = int(study.runs.size()), .outcome = outcome, .cost = cost, .errors = {error}});
  };
  add(4, 1e-3, Outcome::sound);
  add(1, 1e-1, Outcome::capped);
  add(2, 2e-1, Outcome::sound);  // dearer and worse than the one before
  add(1, 5e-1, Outcome::sound);  // as dear, and worse
  add(9, 1e-3, Outcome::sound);  // as good, and dearer
  add(0.1, 1e-9, Outcome::failed);
  const auto front = study.front(0);
  REQUIRE(front.size() == 2);
  CHECK(front[0]->number == 1);
  CHECK(front[1]->number == 0);
  add(6, 1e-4, Outcome::sound);
  CHECK(study.front(0).size() == 3);
  study.measures[0].uncertainty = 1e-2;  // 1e-3 and 1e-4 cannot be told apart: the cheaper one stays
  CHECK(study.front(0).size() == 2);
  CHECK(study.front(0)[1]->number == 0);
  CHECK(study.cheapest(0, 1)->number == 1);  // not the failed one, whatever error it left
}

TEST_CASE("what fails, is refused or hits its cap stays in the table, and only a cap may be chosen") {
  Stage stage;
  const Combinations list{Choices{Method<1>{.factor = 0}},
                          Choices{Caps{}, Blows{}, Vanishes{}, Refuses{}, Sound{}}};
  const Study study = sweep(stage.scene, list, plan_of({0.125}), compared(), References{}, stage.clock());
  REQUIRE(study.runs.size() == 5);
  CHECK(study.runs[0].outcome == Outcome::capped);
  CHECK(study.runs[0].capped_steps == 2);
  CHECK(study.runs[0].steps == 8);
  for (int k : {1, 2, 3}) {
    CHECK(study.runs[std::size_t(k)].outcome == Outcome::failed);
    CHECK(study.runs[std::size_t(k)].errors[0] == std::numeric_limits<double>::infinity());
  }
  CHECK(study.runs[1].steps == 5);  // lost there
  CHECK(study.runs[1].cost == 5);   // and timed as far
  CHECK(study.runs[4].outcome == Outcome::sound);
  CHECK(study.cheapest(0, 1e300)->number == 0);
}

TEST_CASE("a run that takes longer than its limit is stopped and shown at the limit") {
  Stage stage;
  const Combinations list{Choices{Method<1, 0>{.price = 1}, Method<1, 1>{.price = 10}}};
  StudyPlan plan = plan_of({0.125});
  plan.max_seconds = 30;
  const Study study = sweep(stage.scene, list, plan, compared(), References{}, stage.clock());
  CHECK(study.runs[0].outcome == Outcome::sound);
  CHECK(study.runs[1].outcome == Outcome::too_slow);
  CHECK(study.runs[1].steps == 4);  // 4 × 10 is the first beyond 30
  CHECK(study.runs[1].cost == 30);
  CHECK(study.cheapest(0, 1e300)->number == 0);
}

TEST_CASE(
    "a reference of the scene's own has the difference of two methods as its uncertainty, and no error below "
    "it is believed") {
  Stage stage;
  const auto measures = Measures{Compared{"value", "m", value}, penetration()};
  // At h/4 = 1/64: 2 h² = 2/4096 for the reference, ½ h for the other: they differ by 1/128 − 1/2048 =
  // 15/2048.
  const References references{refined(4, Method<2>{.factor = 2}), refined(4, Method<1>{.factor = 0.5})};
  const Combinations list{Choices{Method<2>{}, Method<1, 1>{.price = 0.5}}};
  const Study study =
      sweep(stage.scene, list, plan_of({1. / 8, 1. / 16}), measures, references, stage.clock());
  const double u = 15. / 2048;
  CHECK(study.measures[0].uncertainty == Approx(u).margin(4e-16));
  CHECK(study.measures[1].uncertainty == 0);
  // Second order at 1/8 and 1/16: 1/64 and 1/256, less the reference's 1/2048.
  CHECK(study.runs[0].errors[0] == Approx(31. / 2048).margin(4e-16));
  CHECK(study.runs[1].errors[0] == Approx(7. / 2048).margin(4e-16));
  CHECK(study.is_believed(study.runs[0], 0));
  CHECK_FALSE(study.is_believed(study.runs[1], 0));
  // 7/2048 looks within 10/2048, and may be 22/2048.
  CHECK(study.cheapest(0, 10. / 2048) == nullptr);
  CHECK(study.cheapest(0, 22.5 / 2048)->number == 1);
  CHECK(study.measure("penetration") == 1);
  CHECK(study.runs[0].errors[1] == 0.25 / 8);
  CHECK_THROWS_WITH(study.measure("heat"), "delassus: study 'scripted': no measure is named 'heat'");
}

TEST_CASE(
    "an interrupted study goes on from its log, a damaged line is run again, and another plan starts anew") {
  Stage stage;
  const Combinations list{Choices{Method<1>{}, Method<2>{}}, Choices{Sound{}, Blows{}}};
  StudyPlan plan = plan_of({0.25, 0.125});
  plan.log = fresh_file("delassus_study_resume.log");
  const auto measures = Measures{Compared{"value", "m", value}};
  const References references{refined(10, Method<2>{}), refined(10, Method<1>{})};
  const Study whole = sweep(stage.scene, list, plan, measures, references, stage.clock());
  CHECK(whole.resumed == 0);
  const int built = stage.built;
  const Study known = sweep(stage.scene, list, plan, measures, references, stage.clock());
  CHECK(known.resumed == 8);
  CHECK(stage.built == built);  // not even the references ran
  for (std::size_t k = 0; k < 8; ++k) {
    CHECK(known.runs[k].errors == whole.runs[k].errors);
    CHECK(known.runs[k].cost == whole.runs[k].cost);
    CHECK(known.runs[k].outcome == whole.runs[k].outcome);
    CHECK(known.runs[k].code == whole.runs[k].code);
  }
  CHECK(known.measures[0].uncertainty == whole.measures[0].uncertainty);

  std::filesystem::resize_file(plan.log,
                               std::filesystem::file_size(plan.log) - 3);  // the write that a crash cut short
  const Study mended = sweep(stage.scene, list, plan, measures, references, stage.clock());
  CHECK(mended.resumed == 7);
  REQUIRE(mended.runs.size() == 8);
  CHECK(mended.runs[7].errors == whole.runs[7].errors);
  const Study again = sweep(stage.scene, list, plan, measures, references, stage.clock());
  CHECK(again.resumed == 8);
  CHECK(again.runs[7].errors == whole.runs[7].errors);  // not the shorter number that was left of the cut line

  // Numbers that no run has, in the fields of the number, the outcome and the steps of one line.
  std::ifstream file(plan.log);
  const std::string sound((std::istreambuf_iterator<char>(file)), {});
  for (const int field : {2, 7, 11, 14})
    for (const char* wrong : {"1e300", "-1", "nan", "9e99"}) {
      std::size_t start = sound.rfind('\n', sound.find("\trun\t")) + 1;
      for (int k = 0; k < field; ++k) start = sound.find('\t', start) + 1;
      std::string damaged = sound;
      damaged.replace(start, sound.find('\t', start) - start, wrong);
      std::ofstream(plan.log) << damaged;
      CAPTURE(field, wrong);
      CHECK(sweep(stage.scene, list, plan, measures, references, stage.clock()).resumed == 7);
    }

  StudyPlan longer = plan;
  longer.duration = 2;
  CHECK(sweep(stage.scene, list, longer, measures, references, stage.clock()).resumed == 0);
  std::filesystem::remove(plan.log);
}

TEST_CASE("combinations that keep an accuracy are run at each accuracy in place of each step") {
  Stage stage;
  const Combinations list{Choices{Method<1>{}, Method<2>{}}, Choices{Sound{}, Keeps{}}};
  StudyPlan plan = plan_of({0.25, 0.125, 0.0625}, {1e-6, 1e-8});
  plan.accuracies = {1e-2, 1e-4};
  plan.log = fresh_file("delassus_study_accuracies.log");
  const Study study = sweep(stage.scene, list, plan, compared(), References{}, stage.clock());
  CHECK(announcement(list, plan) ==
        "scripted: 2 combinations × 2 tolerances × 3 steps + 2 combinations × 2 tolerances × 2 accuracies = 20 runs, each "
        "measured once and timed 3 times");
  REQUIRE(study.runs.size() == 20);
  CHECK(study.run_count() == 20);
  for (int k = 0; k < 20; ++k) CHECK(study.runs[std::size_t(k)].number == k);
  const StudyRun& kept = study.runs[9];  // after six of the first combination: 1e-6 at two, 1e-8 at the second
  CHECK(kept.combination == 1);
  CHECK(kept.is_controlled());
  CHECK(kept.accuracy == 1e-4);
  CHECK(kept.tolerance == 1e-8);
  CHECK(kept.h == 0.5);  // from output to output
  CHECK(kept.steps == 2);
  CHECK(kept.inner_steps == 12);
  CHECK(kept.repeated == 4);
  CHECK(kept.errors[0] == Approx(1e-4));
  CHECK(study.line(kept) == "auto loop = scene(Method<1, 0>{}, scripted::Keeps{.accuracy = 0.0001});  // then loop.step(0.5)");
  // Of fixed steps the second order at 1/16, 16 steps, is the best; what keeps 1e-4 takes 2.
  CHECK(study.cheapest(0, 5e-3)->number == 7);
  CHECK(study.cheapest(0, 5e-3, Stepping::fixed)->errors[0] == Approx(1. / 256));
  CHECK(study.front(0, Stepping::fixed).size() == 3);
  CHECK(study.front(0, Stepping::controlled).size() == 1);  // both cost the same here
  const Study known = sweep(stage.scene, list, plan, compared(), References{}, stage.clock());
  CHECK(known.resumed == 20);
  CHECK(known.runs[9].accuracy == 1e-4);
  CHECK(known.runs[9].inner_steps == 12);

  plan.accuracies.clear();  // as the policy says
  plan.log.clear();
  const Study usual = sweep(stage.scene, list, plan, compared(), References{}, stage.clock());
  REQUIRE(usual.runs.size() == 16);
  CHECK(usual.runs[6].accuracy == 1e-3);
}

TEST_CASE("beyond the horizon the references do not agree") {
  Stage stage;
  // The one is t + 0, the other t + tolerance of its scheme: their difference is 2^-4 at every output.
  const References agree{refined(4, Method<2>{.factor = 0}), refined(4, Keeps{1. / 16})};
  const Combinations list{Choices{Method<2>{}}};
  const auto measures = Measures{Compared{"value", "m", value}};
  const Study even = sweep(stage.scene, list, plan_of({1. / 8}), measures, agree, stage.clock());
  CHECK(even.horizon(0, 0.1) == 1);
  CHECK(even.horizon(0, 0.05) == 0);
  // A difference that grows: value · (1 + t) against value.
  const auto growing = [](const Loop& loop) { return loop.time + loop.keeps.accuracy * loop.time * loop.time; };
  const Study parting = sweep(stage.scene, list, plan_of({1. / 8}), Measures{Compared{"value", "m", growing}}, agree, stage.clock());
  CHECK(parting.measures[0].uncertainty_until == std::vector<double>{1. / 64, 1. / 16});
  CHECK(parting.horizon(0, 0.05) == 0.5);
}

TEST_CASE("shards do every run once, and their logs joined are the whole study") {
  Stage stage;
  const Combinations list{Choices{Method<1>{}, Method<2>{}}};
  StudyPlan plan = plan_of({0.5, 0.25, 0.125});
  plan.shards = 2;
  std::string joined;
  std::vector<int> done;
  for (plan.shard = 0; plan.shard < 2; ++plan.shard) {
    plan.log = fresh_file("delassus_study_shard.log");
    for (const StudyRun& run : sweep(stage.scene, list, plan, compared(), References{}, stage.clock()).runs) {
      CHECK(run.number % 2 == plan.shard);
      done.push_back(run.number);
    }
    std::ifstream file(plan.log);
    joined.append(std::istreambuf_iterator<char>(file), {});
  }
  std::sort(done.begin(), done.end());
  CHECK(done == std::vector<int>{0, 1, 2, 3, 4, 5});
  std::ofstream(plan.log) << joined;
  plan.shard = 0;
  plan.shards = 1;
  CHECK(sweep(stage.scene, list, plan, compared(), References{}, stage.clock()).resumed == 6);
  std::filesystem::remove(plan.log);
}

TEST_CASE("a plan that cannot be run is refused in one sentence") {
  Stage stage;
  const Combinations list{Choices{Method<1>{}}};
  const auto refusal = [&](StudyPlan plan) {
    try {
      sweep(stage.scene, list, plan, compared(), References{}, stage.clock());
    } catch (const InvalidArgument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(refusal(plan_of({0.3})) ==
        "delassus: study 'scripted': step 0.3 s must be > 0 and divide duration/outputs = 0.5 s");
  CHECK(refusal(plan_of({})) == "delassus: study 'scripted': steps is empty; name at least one step size");
  CHECK(refusal(plan_of({0.5}, {-1})) == "delassus: study 'scripted': tolerance -1 must be finite and >= 0");
  StudyPlan plan = plan_of({0.5});
  plan.shard = 2, plan.shards = 2;
  CHECK(refusal(plan) == "delassus: study 'scripted': shard 2 must be one of 0 … 1");
  plan = plan_of({0.5});
  plan.only = 1;
  CHECK(refusal(plan) == "delassus: study 'scripted': there is no run 1 among 1");
  CHECK(refusal(plan_of({0.5})) == "accepted");
}
