#include "catch.hpp"

#include <delassus/study/diagram.hpp>
#include <delassus/study/tables.hpp>

#include <cmath>
#include <limits>
#include <string>

using namespace delassus;

namespace {

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(word, at)) != text.npos; at += word.size()) ++found;
  return found;
}

/// Two integrators, one of which fails at its largest step; one run with a cap; an uncertain reference.
Study example() {
  Study study{.plan = {.name = "A <scene>", .duration = 2, .steps = {0.1, 0.01}},
              .combinations = 2,
              .axes = {{"Euler{}", "Midpoint{}"}, {"Solver{}"}},
              .measures = {{"place", "m", 1e-5}, {"drift", "m", 0}}};
  const auto add = [&](int combination, double h, Outcome outcome, double cost, double error,
                       long capped = 0) {
    study.runs.push_back({.number = int(study.runs.size()),
                          .combination = combination,
                          .code = study.axes[0][std::size_t(combination)] + ", Solver{}",
                          .h = h,
                          .outcome = outcome,
                          .cost = cost,
                          .least_cost = cost,
                          .sweeps = 40,
                          .steps = 20,
                          .capped_steps = capped,
                          .errors = {error, error / 2}});
  };
  add(0, 0.1, Outcome::failed, 1e-3, std::numeric_limits<double>::infinity());
  add(0, 0.01, Outcome::sound, 1e-2, 1e-3);
  add(1, 0.1, Outcome::capped, 2e-3, 5e-4, 3);
  add(1, 0.01, Outcome::sound, 2e-2, 1e-6);
  return study;
}

}  // namespace

TEST_CASE("a logarithmic axis puts decades at equal distances, and keeps on the edge what lies beyond") {
  const inner::LogAxis axis(1e-3, 1e1, 500, 100);
  const double decade = axis.at(1e-2) - axis.at(1e-1);
  CHECK(decade > 0);  // to the top, y falls
  CHECK(axis.at(1e-1) - axis.at(1) == Approx(decade));
  CHECK(axis.at(0) == 500);
  CHECK(axis.at(1e9) == Approx(100));
  CHECK(axis.decades().size() == 5);
  const inner::LogAxis point(1e-2, 1e-2, 0, 100);
  CHECK(point.at(1e-2) == Approx(50));
  CHECK(inner::LogAxis(1e-200, 1, 0, 1).decades().size() < 12);
}

TEST_CASE("numbers have the prefixes of the SI where their unit takes them, and powers of ten elsewhere") {
  CHECK(inner::with_prefix(1e-3, "m") == "1 mm");
  CHECK(inner::with_prefix(1.5e-5, "s") == "15 µs");
  CHECK(inner::with_prefix(9.999e-4, "m") == "1 mm");
  CHECK(inner::with_prefix(2.5, "m") == "2.5 m");
  CHECK(inner::with_prefix(1e-7, "kg m/s") == "10⁻⁷ kg m/s");
  CHECK(inner::with_prefix(2.5e-8, "1") == "2.5·10⁻⁸");
  CHECK(inner::with_prefix(0, "m") == "0 m");
}

TEST_CASE(
    "a diagram has a mark for every run: failures crossed, caps hollow, errors below the reference's "
    "dimmed") {
  const Study study = example();
  const std::string svg = diagram_svg(study, {.budget = 1e-3});
  CHECK(count(svg, "class=\"cross ") == 1);
  CHECK(count(svg, "class=\"run c0\"") == 1 + 1);  // the run, and the legend
  CHECK(count(svg, "class=\"run c1 hollow\"") == 1);
  CHECK(count(svg, "class=\"run c1 dim\"") == 1);
  CHECK(count(svg, "class=\"band\"") == 1);
  CHECK(svg.find("× 1 run failed or too slow") != svg.npos);
  CHECK(svg.find("some steps not converged") != svg.npos);
  CHECK(svg.find("3 of 20 steps not converged") != svg.npos);
  CHECK(svg.find("budget 1 mm") != svg.npos);
  CHECK(svg.find("auto loop = scene(Midpoint{}, Solver{});") != svg.npos);
  CHECK(svg.find("loop.step(0.1);") != svg.npos);
  CHECK(svg.find("error 500 µm ± 10 µm for 1 ms of processor time") != svg.npos);
  CHECK(svg.find("A &lt;scene&gt;") != svg.npos);
  CHECK(svg.find("A <scene>") == svg.npos);
  CHECK(svg.find("nan") == svg.npos);
  CHECK(svg.find("inf") == svg.npos);
  CHECK(svg.find("prefers-color-scheme:dark") != svg.npos);
  CHECK(count(svg, "<text") == count(svg, "</text>"));
}

TEST_CASE("a diagram without a budget, an uncertainty, or any sound run is drawn all the same") {
  Study study = example();
  CHECK(count(diagram_svg(study, {.measure = 1}), "class=\"band\"") == 0);
  CHECK(diagram_svg(study, {.budget = 1e-6}).find("the reference itself is only sure to 10 µm") !=
        std::string::npos);
  study.measures[0].uncertainty = 0;
  CHECK(diagram_svg(study, {.budget = 1e-9}).find("smaller steps or tolerances may") != std::string::npos);
  for (StudyRun& run : study.runs) run.outcome = Outcome::failed;
  const std::string svg = diagram_svg(study, {.budget = 1e-3});
  CHECK(count(svg, "class=\"cross ") == 4);
  CHECK(svg.find("nan") == svg.npos);
  CHECK_THROWS_WITH(diagram_svg(study, {.measure = 2}),
                    "delassus: diagram of 'A <scene>': there is no measure 2");
}

// Of the first integrator one run failed, and one point is no curve.
TEST_CASE("a diagram joins the steps of each choice where it is asked to, in place of the best") {
  const Study study = example();
  const std::string svg = diagram_svg(study, {.joins_steps = true});
  CHECK(count(svg, "class=\"curve c1\"") == 1);
  CHECK(count(svg, "class=\"curve ") == 1);
  CHECK(count(svg, "class=\"front\"") == 0);
  CHECK(count(diagram_svg(study), "class=\"curve ") == 0);
  CHECK(count(diagram_svg(study), "class=\"front\"") == 1);
}

TEST_CASE("a diagram of fixed steps and of accuracies has a line for each, and says what the dearer kind costs") {
  Study study = example();
  CHECK(count(diagram_svg(study, {.budget = 1e-3}), "front kept") == 0);
  for (int k = 0; k < 2; ++k) {
    StudyRun run = study.runs[1];
    run.number += 10 + k, run.accuracy = k == 0 ? 1e-2 : 1e-3, run.inner_steps = 40, run.repeated = 3;
    run.cost = k == 0 ? 2e-4 : 4e-4, run.errors[0] = k == 0 ? 2e-3 : 2e-4;
    study.runs.push_back(run);
  }
  const std::string svg = diagram_svg(study, {.budget = 1e-3});
  CHECK(count(svg, "class=\"front\"") == 1);
  CHECK(count(svg, "class=\"front kept\"") == 1);
  CHECK(svg.find("40 steps, 3 repeated") != svg.npos);
  CHECK(svg.find("The cheapest fixed step takes 5 times as long: loop.step(0.1).") != svg.npos);
  // 1e-6 m is run 3's alone, and below what the reference is sure to.
  study.measures[0].uncertainty = 0;
  CHECK(diagram_svg(study, {.budget = 1e-5}).find("No accuracy that is kept is known to hold 10 µm.") != std::string::npos);
}

TEST_CASE("a diagram says until when the references agree to the budget") {
  Study study = example();
  study.measures[0].uncertainty = 0.5;
  study.measures[0].uncertainty_until.assign(std::size_t(study.plan.outputs), 0.5);
  study.measures[0].uncertainty_until[0] = 1e-4;
  const std::string svg = diagram_svg(study, {.budget = 1e-3});
  CHECK(svg.find("The references agree to 1 mm for " + inner::with_prefix(study.plan.duration / study.plan.outputs, "s")) != svg.npos);
}

TEST_CASE("the tables hold the front, what did not work, and every run with every digit") {
  const Study study = example();
  const Table front = front_table(study);
  REQUIRE(front.rows.size() == 2);  // run 2, and 3, which is dearer and better
  CHECK(front.rows[0][0].text == "Midpoint{}, Solver{}");
  CHECK(front.rows[0].back().text == "3 of 20 steps");
  CHECK(front.caption == "4 runs: 2 sound, 1 capped, 1 failed. The reference of place is sure to 1e-05 m.");
  const Table trouble = trouble_table(study);
  REQUIRE(trouble.rows.size() == 2);
  CHECK(trouble.rows[0][1].text == "1");
  CHECK(trouble.rows[1][3].text == "1");
  const Table all = runs_table(study);
  CHECK(all.rows.size() == 4);
  CHECK(csv_text(all).find("\"Euler{}, Solver{}\",,0.1,failed,") != std::string::npos);
}

TEST_CASE(
    "the code of a policy names what differs from its defaults, as C++ that reads back the same number") {
  CHECK(code_of(GaussSeidel{}) == "GaussSeidel{}");
  CHECK(code_of(AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 20, .all_verified = true}) ==
        "AcceleratedGaussSeidel{.tolerance = 1e-08, .max_iterations = 20, .all_verified = true}");
  CHECK(code_of(GaussSeidel{.relaxation = 1.0 / 3, .criterion = Criterion::last_change}) ==
        "GaussSeidel{.relaxation = 0.3333333333333333, .criterion = Criterion::last_change}");
  CHECK(code_of(AssembledCompliance{}) == "AssembledCompliance{}");
  CHECK(inner::step_text(1. / 30) == "1. / 30");
  CHECK(inner::step_text(1. / 64) == "0.015625");
  CHECK(inner::step_text(0.1 / 3 * 2.7) == inner::number_text(0.1 / 3 * 2.7, 17));
  struct Own {
    std::string code() const { return "Own(7)"; }
  };
  CHECK(code_of(Own{}) == "Own(7)");
}
