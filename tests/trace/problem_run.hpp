/// A problem that is solved again and again while its free velocities change, from the impulses of the last
/// solve.
#pragma once

#include <delassus/solvers/problem.hpp>

#include <cmath>
#include <functional>
#include <utility>

#include "trace.hpp"

namespace trace {

/// d of solve n is d (1 + 0.4 sin 0.2 n) + 0.02 sin(k + 0.3 n) m/s, k the number of the row. `solve(problem)`
/// returns a SolveReport. What is kept before a solve is λ.
template <class Problem, class Solve>
class ProblemRun : public Run {
 public:
  ProblemRun(Problem problem, Solve solve) : problem_(std::move(problem)), solve_(solve), given_(problem_) {}

  void act(int) override {}
  void step(int n) override {
    std::vector<double> given;
    each_item(given_, [&](const auto& d, const auto&) {
      for (Index k = 0; k < Index(d.size()); ++k) given.push_back(d[k]);
    });
    std::size_t row = 0;
    each_item(problem_, [&](auto& d, const auto&) {
      for (Index k = 0; k < Index(d.size()); ++k, ++row)
        d[k] = given[row] * (1 + 0.4 * std::sin(0.2 * n)) + 0.02 * std::sin(double(row) + 0.3 * n);
    });
    report_ = solve_(problem_);
  }
  void walk(Text& state, Text&) override {
    state.line("impulses");
    each_item(problem_, [&](const auto&, auto& lambda) {
      for (Index k = 0; k < Index(lambda.size()); ++k) state(lambda[k]);
    });
  }
  void hash(Hash& hash) const override {
    each_item(problem_, [&](const auto&, const auto& lambda) { hash.matrix(lambda); });
  }
  Outcome outcome() const override {
    Outcome out{.sweeps = report_.sweeps, .status = int(report_.status)};
    each_row_velocity(problem_,
                      [&](const auto& u) { out.v.insert(out.v.end(), u.data(), u.data() + u.size()); });
    each_item(problem_, [&](const auto&, const auto& l) {
      out.lambda.insert(out.lambda.end(), l.data(), l.data() + l.size());
    });
    return out;
  }

 private:
  Problem problem_;
  Solve solve_;
  Problem given_;
  SolveReport report_;
};

/// `make()` returns the problem; the solver keeps nothing from solve to solve.
template <class Make, class Solve>
void add_problem(Trace& all, std::string name, Options options, Make make, Solve solve) {
  using Problem = std::invoke_result_t<Make>;
  all.add_run(std::move(name), options, [=] {
    return std::unique_ptr<Run>(std::make_unique<ProblemRun<Problem, Solve>>(make(), solve));
  });
}

}  // namespace trace
