// Solves friction problems from files, one line each:
//
//   fcp_solve FILE... [--tolerance 1e-8] [--stop err|err_s|both] [--solver accelerated|path|plain] [--warm FILE] [--out FILE]
//             [--save FILE] [--time-limit S]
//   fcp_solve --help | --version
//
// err is Siconos' error, err_s the scale-free one; by default both must be within the tolerance. `build` is the own blocks'
// factors and the workspace, `solve` the median of repeated solves, both in ms of this thread's processor time; the limit, 10 s a solve, is of the wall clock. --warm starts
// from a file of impulses, --out writes them, --save the problem; all three go with one problem. Files named .hdf5 or .h5 are in the
// form of FCLIB, where the tool is built with HDF5: `fcp_solve a.fcp --save a.hdf5` turns one form into the other.
//
// A file that is wrong is told on standard error, with its line, and the others are solved. Exit status 1 when a problem did not
// reach the tolerance, 2 when the arguments or a file are wrong.
#include "read_any.hpp"

#include <delassus/core/cmath.hpp>
#include <delassus/core/expect.hpp>
#include <delassus/io/problem_file.hpp>
#include <delassus/problems/friction_problem.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/solvers/law_set.hpp>
#include <delassus/solvers/path_newton.hpp>
#include <delassus/solvers/with_deadline.hpp>
#include <delassus/version.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

using namespace delassus;

namespace {

/// Seconds that this thread has computed: what other programs take does not count.
struct ThreadClock {
  double now() const {
    std::timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  }
};

struct Options {
  std::vector<std::string> files;
  double tolerance = 1e-8, time_limit = 10;
  std::string solver = "accelerated", stop = "both", warm, out, save;
  const char* asks = nullptr;  ///< what is printed, and no more
};

const std::string version_text =
    "fcp_solve " + std::to_string(version.major) + '.' + std::to_string(version.minor) + '.' + std::to_string(version.patch);
constexpr const char* usage =
    "usage: fcp_solve FILE... [--tolerance 1e-8] [--stop err|err_s|both] [--solver accelerated|path|plain] "
    "[--warm FILE] [--out FILE] [--save FILE] [--time-limit S], or fcp_solve --help, or fcp_solve --version";

struct Result {
  SolveReport report;
  double build = 0, solve = 0;  ///< s
};

/// Solves again until the time is known: 15 runs below 2 ms, 5 to 0.1 s, 3 to 1 s.
template <class Solver>
Result run(FrictionProblem& problem, const Solver& solver, double time_limit) {
  const auto start = problem.rows.pool<0>().lambda;
  const ThreadClock clock;
  const WithDeadline<Solver> timed{solver, time_limit};
  timed.check();
  Result result;
  std::vector<double> times, builds;
  for (int runs = 1; int(times.size()) < runs;) {
    problem.rows.pool<0>().lambda = start;
    const double before = clock.now();
    LawSet<std::remove_cvref_t<decltype(problem.laws)>, double> book(problem.laws);
    typename WithDeadline<Solver>::template Workspace<FrictionProblem::Rows> workspace;
    workspace.reset(problem.rows.row_count());
    book.prepare(problem.W, problem.rows, problem.h);
    const double built = clock.now();
    NoObserver nobody;
    IslandProblem island(book, problem.rows, problem.W, problem.islands, 0, problem.h, nobody);
    result.report = timed.solve(island, workspace);
    times.push_back(clock.now() - built);
    builds.push_back(built - before);
    if (times.size() == 1 && result.report.status == Status::converged)
      runs = times[0] < 2e-3 ? 15 : times[0] < 0.1 ? 5 : times[0] < 1 ? 3 : 1;
  }
  const auto median = [](std::vector<double>& of) {
    std::nth_element(of.begin(), of.begin() + std::ptrdiff_t(of.size() / 2), of.end());
    return of[of.size() / 2];
  };
  result.build = median(builds);
  result.solve = median(times);
  return result;
}

std::string name_of(const std::string& path) {
  const std::size_t slash = path.find_last_of('/'), first = slash == std::string::npos ? 0 : slash + 1;
  const std::size_t dot = path.find_last_of('.');
  return path.substr(first, dot == std::string::npos || dot < first ? std::string::npos : dot - first);
}

constexpr int no_limit = 2000000000;

Result run_named(FrictionProblem& problem, const Options& o, Criterion criterion) {
  if (o.solver == "plain")
    return run(problem, GaussSeidel{.tolerance = o.tolerance, .max_iterations = no_limit, .min_iterations = 0, .criterion = criterion},
               o.time_limit);
  if (o.solver == "path")
    return run(problem, PathNewton{.tolerance = o.tolerance, .max_iterations = no_limit, .max_sweeps = no_limit, .criterion = criterion},
               o.time_limit);
  return run(problem,
             AcceleratedSweeps{.tolerance = o.tolerance, .max_iterations = no_limit, .min_iterations = 0, .criterion = criterion},
             o.time_limit);
}

Options parse(int count, char** words) {
  Options o;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    if (word.rfind("-", 0) != 0) {
      o.files.push_back(word);
      continue;
    }
    if (word == "--help" || word == "-h") o.asks = usage;
    if (word == "--version") o.asks = version_text.c_str();
    if (o.asks) return o;
    DELASSUS_EXPECT(k + 1 < count, word + " needs a value");
    const std::string value = words[++k];
    const auto positive = [&] {
      char* end = nullptr;
      const double number = std::strtod(value.c_str(), &end);
      DELASSUS_EXPECT(*end == 0 && !value.empty() && number > 0 && std::isfinite(number), word + " '" + value + "' must be a finite number > 0");
      return number;
    };
    if (word == "--tolerance") o.tolerance = positive();
    else if (word == "--time-limit") o.time_limit = positive();
    else if (word == "--solver") o.solver = value;
    else if (word == "--stop") o.stop = value;
    else if (word == "--warm") o.warm = value;
    else if (word == "--out") o.out = value;
    else if (word == "--save") o.save = value;
    else inner::refuse("there is no option " + word);
  }
  DELASSUS_EXPECT(!o.files.empty(), usage);
  DELASSUS_EXPECT(o.solver == "accelerated" || o.solver == "path" || o.solver == "plain",
                  "--solver '" + o.solver + "' is none of 'accelerated', 'path' and 'plain'");
  DELASSUS_EXPECT(o.stop == "err" || o.stop == "err_s" || o.stop == "both", "--stop '" + o.stop + "' is none of err, err_s, both");
  DELASSUS_EXPECT(o.files.size() == 1 || (o.warm.empty() && o.out.empty() && o.save.empty()),
                  "--warm, --out and --save go with one problem");
  return o;
}

bool solve_file(const std::string& file, const Options& o) {
  FrictionProblem problem = read_any(file);
  if (!o.save.empty()) write_any(o.save, problem);
  auto& lambda = problem.rows.pool<0>().lambda;
  if (!o.warm.empty()) lambda = read_impulses(o.warm, Index(lambda.size()));
  const Result r = run_named(problem, o, o.stop == "err" ? Criterion::siconos_error : o.stop == "err_s" ? Criterion::residual : Criterion::both_errors);
  std::printf("%-40s %4d %-14s %9.2e %9.2e %8d %3d %9.4f %10.4f %s\n", name_of(file).c_str(), int(lambda.size()),
              name(r.report.status), r.report.measure.siconos, r.report.measure.residual, r.report.sweeps, r.report.factorizations, 1e3 * r.build,
              1e3 * r.solve, r.report.ended_by);
  std::fflush(stdout);
  if (!o.out.empty()) write_impulses(o.out, lambda);
  return r.report.status == Status::converged;
}

}  // namespace

int main(int count, char** words) try {
  const Options o = parse(count, words);
  if (o.asks) {
    std::puts(o.asks);
    return 0;
  }
  std::printf("%-40s %4s %-14s %9s %9s %8s %3s %9s %10s %s\n", "problem", "nc", "status", "err", "err_s", "sweeps", "fac",
              "build ms", "solve ms", "ended by");
  int status = 0;
  for (const std::string& file : o.files) {
    try {
      if (!solve_file(file, o)) status = std::max(status, 1);
    } catch (const InvalidArgument& error) {
      std::fprintf(stderr, "%s\n", error.what());
      status = 2;
    }
  }
  return status;
} catch (const InvalidArgument& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
