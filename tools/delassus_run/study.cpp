// What accuracy costs for a machine, over the loops that are compiled in.
#include "study.hpp"

#include "program_threads.hpp"

#include <delassus/adapters/posix.hpp>
#include <delassus/study/diagram.hpp>
#include <delassus/study/sweep.hpp>
#include <delassus/study/tables.hpp>

#include <algorithm>
#include <cstdio>
#include <mutex>

namespace delassus_run {

namespace {

std::string solver_code(double tolerance) { return "DirectGaussSeidel{.tolerance = " + inner::number_text(tolerance, 3) + "}"; }

/// The three kinds of loops that a study compares.
struct Euler {
  double tolerance = 1e-6;
  std::string code() const { return "SymplecticEuler{}, " + solver_code(tolerance); }
  Asked asked() const { return {.integration = Integration::euler, .tolerance = tolerance}; }
};
struct Midpoint {
  double tolerance = 1e-6;
  std::string code() const { return "ImplicitMidpoint{}, " + solver_code(tolerance); }
  Asked asked() const { return {.integration = Integration::midpoint, .tolerance = tolerance}; }
};
struct Kept {
  double accuracy = 1e-3, tolerance = 1e-6;
  /// What `ErrorControlled` asks of the solver at least.
  double fine_tolerance() const { return std::min(tolerance, 1e-2 * accuracy); }
  std::string code() const { return "ImplicitMidpoint{}, ErrorControlled{.accuracy = " + inner::number_text(accuracy, 3) + "}, " + solver_code(fine_tolerance()); }
  Asked asked() const { return {.integration = Integration::midpoint, .accuracy = accuracy, .tolerance = fine_tolerance()}; }
};

/// A machine that runs, as a study steps it.
struct Running {
  std::unique_ptr<Motion> motion;
  StepReport step(double h) { return motion->step(h); }
};

/// The largest distance of a body from its place in the other run.
struct FarthestBody {
  double operator()(const double* x, const double* y, std::size_t width) const {
    double most = 0;
    for (std::size_t k = 0; k + 3 <= width; k += 3) most = inner::larger(most, Distance{}(x + k, y + k, 3));
    return most;
  }
};

std::vector<double> places_of(const Running& running) {
  std::vector<double> places;
  const RigidBodies& set = running.motion->set();
  for (const Index b : alive(set))
    if (set.moves(b))
      for (const double x : set.pose(b).position) places.push_back(x);
  return places;
}

/// Those nearest to round steps that go a whole number of times from output to output, the largest first.
std::vector<double> steps_within(double between) {
  std::vector<double> steps;
  for (const double wanted : {0.02, 0.01, 0.005, 0.002, 0.001}) {
    const double h = between / std::max(1., std::round(between / wanted));
    if (steps.empty() || h < 0.9 * steps.back()) steps.push_back(h);
  }
  return steps;
}

std::string number(double x) { return inner::number_text(x, 6); }

/// Says how far a study is, a line each tenth; a terminal has the library's own line besides.
class Heard {
 public:
  /// As many loops after the two references; 0: says nothing.
  explicit Heard(int loops) : loops_(loops) {}

  void one_more() {
    const std::lock_guard lock(mutex_);
    const int n = ++begun_ - 2;
    if (loops_ == 0 || (n > 0 && 10 * n / loops_ == 10 * (n - 1) / loops_)) return;
    if (n <= 0) std::printf("study: reference %d of 2\n", begun_);
    else std::printf("study: %d %% of the runs\n", 100 * n / loops_);
    std::fflush(stdout);
  }

 private:
  std::mutex mutex_;
  const int loops_;
  int begun_ = 0;
};

/// What the command line says for a run.
std::string words_for(const StudyRun& run, const std::string& file, const Options& options) {
  std::string words = "./run machine " + file;
  if (run.is_controlled()) words += " --accuracy " + number(run.accuracy) + " --tolerance " + number(std::min(run.tolerance, 1e-2 * run.accuracy));
  else words += std::string(run.code.starts_with("Implicit") ? " --integrator midpoint" : "") + " --dt " + number(run.h) + " --tolerance " + number(run.tolerance);
  if (options.base != Base::as_file) words += options.base == Base::free ? " --base free" : " --base fixed";
  if (options.has_ground) words += " --ground";
  if (options.height > 0) words += " --height " + number(options.height);
  if (!options.key.empty()) words += " --key " + options.key;
  for (const std::string& place : options.places) words += " --at " + place;
  if (!options.hold.empty()) words += " --hold " + number(options.hold[0]) + (options.hold.size() > 1 ? "," + number(options.hold[1]) : "");
  if (options.pushes_apart) words += " --push-apart";
  if (!options.meshes.empty()) words += " --meshes " + options.meshes;
  for (const std::string& package : options.packages) words += " --package " + package;
  if (options.friction >= 0) words += " --friction " + number(options.friction);
  return words;
}

}  // namespace

void study_of(const Model& model, const Start& start, const Options& options, const std::string& file, const std::string& base) {
  StudyPlan plan{.name = model.name.empty() ? file : model.name, .duration = options.seconds};
  plan.steps = steps_within(plan.duration / plan.outputs);
  plan.accuracies = {1e-2, 1e-3, 1e-4};
  plan.tolerances = {1e-3, 1e-6};
  plan.max_seconds = std::max(2., 2 * options.seconds);  // at half the pace of the clock
  plan.repeats = 1;
  plan.is_quiet = options.is_quiet;

  // Each run is made twice, by its measures and by the clock.
  const std::size_t runs = plan.tolerances.size() * (2 * plan.steps.size() + plan.accuracies.size());
  Heard heard(options.is_quiet ? 0 : int(2 * runs));
  const auto scene = [&](const auto& policy) {
    heard.one_more();
    Asked asked = policy.asked();
    asked.friction = options.friction;
    asked.longest_step = 0.02;  // s: with it that tolerance is fine enough
    return Running{start.put(asked)};
  };
  const Combinations list{Choices{Euler{}, Midpoint{}, Kept{}}};
  const Measures measures{Compared("place of the farthest body", "m", places_of, inner::NoExact{}, FarthestBody{}), joint_drift(), penetration()};
  const References references{refined(4, Midpoint{.tolerance = 1e-9}), refined(16, Euler{.tolerance = 1e-9})};

  std::printf("\n%s.\nCompared are the loops of this program alone: one solver, two integrators, fixed steps and kept errors.\n", announcement(list, plan).c_str());
  std::fflush(stdout);
  const Study study = sweep(scene, list, plan, measures, references, ThreadClock{}, program_threads(options.threads));
  print(front_table(study));
  if (const Table trouble = trouble_table(study); !trouble.rows.empty()) std::puts(""), print(trouble);
  write_csv(base + ".study.csv", runs_table(study));
  write_diagram(base + ".study.svg", study, {.measure = 0, .budget = options.budget});

  const std::string budget = number(options.budget) + " m";
  const StudyRun* const best = study.cheapest(0, options.budget);
  const double horizon = study.horizon(0, options.budget);
  if (!best) {
    std::printf("%s: no run is known to be within %s", plan.name.c_str(), budget.c_str());
    if (!(horizon > 0))
      std::printf("; the references do not agree to it in any part of the run: a larger --budget");
    else if (horizon < plan.duration)
      std::printf("; the references agree to it up to %s s only: study fewer --seconds, or a larger --budget", number(horizon).c_str());
    std::puts("");
  } else {
    std::printf("%s: cheapest within %s\n", plan.name.c_str(), budget.c_str());
    for (const Stepping kind : {Stepping::fixed, Stepping::controlled})
      if (const StudyRun* const run = study.cheapest(0, options.budget, kind))
        std::printf("  %s: %s ms a second, error %s m\n    %s\n", kind == Stepping::fixed ? "fixed steps" : "kept error", inner::number_text(1e3 * run->cost / plan.duration, 3).c_str(),
                    inner::number_text(study.error_bound(*run, 0), 2).c_str(), words_for(*run, file, options).c_str());
  }
  std::printf("%s.study.svg\n%s.study.csv\n", base.c_str(), base.c_str());
}

}  // namespace delassus_run
