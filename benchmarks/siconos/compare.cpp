// The solver beside Siconos', on friction problems from files, in one run:
//
//   compare_siconos FOLDER|FILE... [--out siconos.csv] [--limit S] [--repeat S] [--tolerances 1e-3,1e-6,1e-8]
//                   [--problems TEXT,...] [--solvers TEXT,...] [--no-sweeps]
//
// For each problem, tolerance and solver one row: status, iterations, median of the processor time of the
// solving thread, and both errors of the impulses found, measured by this library whoever found them. All
// solvers stop by Siconos' error and start at λ = 0. The times of Siconos hold all that its driver does with
// a matrix of blocks; ours is parted in `build`, the factors of the contacts' own blocks and the room for the
// solve, and `seconds`, the solve. A row with the tolerance `sweep` is the time of one sweep: half of what 2
// N sweeps cost more than N. What the clock takes between two looks is taken off all times. Each solve is a process of
// its own that ends after --limit seconds (2); what did not end at one tolerance is not tried at a smaller one. Short
// solves are repeated, for --repeat seconds together (1). Rows that the file has already are not made again.
// `load` is the mean number of processes that waited for a processor in the last minute.
#include "given_to_siconos.hpp"

#include <delassus/adapters/posix.hpp>
#include <delassus/core/clock.hpp>
#include <delassus/io/problem_file.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/solvers/law_set.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include <fcntl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace delassus;

namespace {

struct Options {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> problems, solvers, tolerances{"1e-3", "1e-6", "1e-8"};
  std::string out = "siconos.csv";
  double limit = 2, repeat = 1;
  bool sweeps = true;
};

/// What a solve leaves, sent through a pipe.
struct Result {
  bool has_converged = false;
  int iterations = 0, runs = 0;
  double seconds = 0, build = 0, err = 0, err_s = 0;
};

using Book = LawSet<std::remove_cvref_t<decltype(FrictionProblem::laws)>, double>;
constexpr int no_limit = 2000000000;

double median(std::vector<double> of) {
  std::nth_element(of.begin(), of.begin() + std::ptrdiff_t(of.size() / 2), of.end());
  return of[of.size() / 2];
}

/// What the clock itself takes between two looks, a quarter of a microsecond: as much as the smallest solves.
double between_looks() {
  static const double cost = [] {
    const ThreadClock clock;
    std::vector<double> times;
    for (int k = 0; k < 1001; ++k) {
      const double begin = clock.now();
      times.push_back(clock.now() - begin);
    }
    return median(times);
  }();
  return cost;
}

/// Both errors of the λ that p has.
void measure(FrictionProblem& p, Result& result) {
  Book book(p.laws);
  book.prepare(p.W, p.rows, p.h);
  NoObserver nobody;
  IslandProblem island(book, p.rows, p.W, p.islands, 0, p.h, nobody);
  const Measure m = island.measure();
  result.err = m.siconos;
  result.err_s = m.residual;
}

void start_alarm(double seconds) {
  itimerval t{};
  t.it_value.tv_sec = std::time_t(seconds);
  t.it_value.tv_usec = suseconds_t(1e6 * (seconds - std::floor(seconds)));
  setitimer(ITIMER_PROF, &t, nullptr);
}

/// 101 runs below 0.1 ms, 15 below 2 ms, 5 below 0.05 s, 3 below 0.2 s, else one, and no more than fit into `most` seconds;
/// solve(result) returns the time of one.
template <class Solve>
void repeat(Result& result, double limit, double most, Solve&& solve) {
  std::vector<double> times, builds;
  for (int runs = 1; int(times.size()) < runs;) {
    start_alarm(limit);
    times.push_back(solve(result));
    builds.push_back(result.build);
    if (times.size() > 1) continue;
    runs = times[0] < 1e-4 ? 101 : times[0] < 2e-3 ? 15 : times[0] < 0.05 ? 5 : times[0] < 0.2 ? 3 : 1;
    if (runs * times[0] > most) runs = std::max(1, int(most / times[0]));
  }
  start_alarm(limit + 10);
  result.seconds = median(times);
  result.build = median(builds);
  result.runs = int(times.size());
}

/// One cold solve by a solver of this library.
template <class Solver>
double solve_own(FrictionProblem& p, const Solver& solver, Result& result) {
  for (auto& x : p.rows.pool<0>().lambda) x.setZero();
  const ThreadClock clock;
  const double begin = clock.now();
  Book book(p.laws);
  typename Solver::template Workspace<FrictionProblem::Rows> workspace;
  if constexpr (requires { workspace.reset(Index()); }) workspace.reset(p.rows.row_count());
  book.prepare(p.W, p.rows, p.h);
  const double built = clock.now();
  NoObserver nobody;
  IslandProblem island(book, p.rows, p.W, p.islands, 0, p.h, nobody);
  const SolveReport report = solver.solve(island, workspace);
  const double end = clock.now();
  result.iterations = report.sweeps;
  result.has_converged = report.status == Status::converged;
  result.build = built - begin - between_looks();
  return end - built - between_looks();
}

/// One cold solve by Siconos; λ goes to p.
double solve_siconos(FrictionProblem& p, const Configuration& c, double tolerance, int max_iterations,
                     Result& result) {
  GivenToSiconos given(p);
  const std::size_t n = p.rows.pool<0>().lambda.size();
  Eigen::VectorXd reaction = Eigen::VectorXd::Zero(Eigen::Index(3 * n)), velocity = reaction;
  SolverOptions* options = c.options(tolerance, max_iterations);
  const ThreadClock clock;
  const double begin = clock.now();
  const int failed = fc3d_driver(given.get(), reaction.data(), velocity.data(), options);
  const double end = clock.now();
  result.iterations = options->iparam[SICONOS_IPARAM_ITER_DONE];
  result.has_converged = failed == 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      p.rows.pool<0>().lambda[i][Eigen::Index(k)] = reaction[Eigen::Index(3 * i + k)];
  return end - begin - between_looks();
}

/// A solver's name and how it is run to a tolerance, or for a number of sweeps (tolerance 0).
struct Entry {
  std::string name;
  const Configuration* siconos = nullptr;  ///< null: ours
  bool sweeps = false;
};

double run_once(FrictionProblem& p, const Entry& e, double tolerance, int most, Result& result) {
  if (e.siconos != nullptr)
    return solve_siconos(p, *e.siconos, tolerance > 0 ? tolerance : 1e-300, most, result);
  if (e.sweeps)
    return solve_own(p, GaussSeidel{.tolerance = tolerance, .max_iterations = most, .criterion = Criterion::siconos_error},
                     result);
  return solve_own(
      p, AcceleratedSweeps{.tolerance = tolerance, .max_iterations = most, .criterion = Criterion::siconos_error}, result);
}

/// In a process of its own: false when it did not come back in time.
template <class Work>
bool apart(Work&& work, Result& result) {
  int ends[2];
  if (pipe(ends) != 0) return false;
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 1);
    dup2(nowhere, 2);
    numerics_set_verbose(0);
    work(result);
    const bool is_sent = write(ends[1], &result, sizeof result) == ssize_t(sizeof result);
    _exit(is_sent ? 0 : 1);
  }
  close(ends[1]);
  const bool came = child > 0 && read(ends[0], &result, sizeof result) == ssize_t(sizeof result);
  close(ends[0]);
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  return came && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= list.size();) {
    const std::size_t comma = std::min(list.find(',', at), list.size());
    parts.push_back(list.substr(at, comma - at));
    at = comma + 1;
  }
  return parts;
}

/// Every text matches an empty list; otherwise one of the list must be part of it.
bool is_wanted(const std::string& name, const std::vector<std::string>& parts) {
  return parts.empty() || std::any_of(parts.begin(), parts.end(), [&](const std::string& part) {
           return name.find(part) != std::string::npos;
         });
}

double positive(const std::string& word, const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  DELASSUS_EXPECT(!value.empty() && *end == 0 && number > 0, word + " '" + value + "' must be a number > 0");
  return number;
}

Options parse(int count, char** words) {
  Options o;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    if (word == "--no-sweeps") {
      o.sweeps = false;
    } else if (word.rfind("--", 0) == 0) {
      DELASSUS_EXPECT(k + 1 < count, word + " needs a value");
      const std::string value = words[++k];
      if (word == "--out")
        o.out = value;
      else if (word == "--limit")
        o.limit = positive(word, value);
      else if (word == "--repeat")
        o.repeat = positive(word, value);
      else if (word == "--problems")
        o.problems = split(value);
      else if (word == "--solvers")
        o.solvers = split(value);
      else if (word == "--tolerances")
        o.tolerances = split(value);
      else
        inner::refuse("there is no option " + word);
    } else if (std::filesystem::is_directory(word)) {
      for (const auto& entry : std::filesystem::directory_iterator(word))
        if (entry.path().extension() == ".fcp") o.files.push_back(entry.path());
    } else {
      o.files.push_back(word);
    }
  }
  if (o.files.empty())
    if (const char* folder = std::getenv("DELASSUS_PROBLEMS"))
      for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".fcp") o.files.push_back(entry.path());
  DELASSUS_EXPECT(!o.files.empty(),
                  "compare_siconos: no problem; name a folder or files, or set DELASSUS_PROBLEMS");
  for (const std::string& tolerance : o.tolerances) positive("--tolerances", tolerance);
  std::sort(o.files.begin(), o.files.end());
  return o;
}

/// The rows that are there, as problem,solver,tolerance; and where the next go.
class Table {
 public:
  explicit Table(const std::string& path) {
    std::ifstream before(path);
    for (std::string line; std::getline(before, line);) {
      const auto parts = split(line);
      if (parts.size() > 5) rows_.insert({parts[0] + ',' + parts[3] + ',' + parts[4], parts[5]});
    }
    out_ = std::fopen(path.c_str(), "a");
    DELASSUS_EXPECT(out_ != nullptr, "compare_siconos: cannot write '" + path + "'");
    if (rows_.empty())
      std::fputs(
          "problem,contacts,blocks,solver,tolerance,status,iterations,runs,seconds,build,err,err_s,load\n",
          out_);
  }
  ~Table() { std::fclose(out_); }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  const std::string* status(const std::string& key) const {
    const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const auto& r) { return r.first == key; });
    return row == rows_.end() ? nullptr : &row->second;
  }
  void add(const std::string& problem, Index contacts, std::size_t blocks, const std::string& solver,
           const std::string& tolerance, const char* status, const Result& r) {
    double load = 0;
    if (getloadavg(&load, 1) != 1) load = 0;
    std::fprintf(out_, "%s,%d,%zu,%s,%s,%s,%d,%d,%.4g,%.4g,%.3g,%.3g,%.1f\n", problem.c_str(), int(contacts),
                 blocks, solver.c_str(), tolerance.c_str(), status, r.iterations, r.runs, r.seconds, r.build,
                 r.err, r.err_s, load);
    std::fflush(out_);
    rows_.insert({problem + ',' + solver + ',' + tolerance, status});
  }

 private:
  std::set<std::pair<std::string, std::string>> rows_;
  std::FILE* out_ = nullptr;
};

/// The median of five differences between 2 N and N sweeps, over N; false when a solve ended before.
bool time_sweeps(FrictionProblem& p, const Entry& e, int N, double limit, Result& result) {
  std::vector<double> times;
  for (int k = 0; k < 5; ++k) {
    start_alarm(limit);
    const double once = run_once(p, e, 0, N, result);
    if (result.iterations != N) return false;
    const double twice = run_once(p, e, 0, 2 * N, result);
    if (result.iterations != 2 * N) return false;
    times.push_back((twice - once) / N);
  }
  result.seconds = median(times);
  result.runs = int(times.size());
  result.iterations = N;
  return true;
}

/// With the longest N that the problem is not solved in.
void time_sweep(FrictionProblem& p, const Entry& e, double limit, Result& result) {
  const int blocks = int(p.W.blocks<0, 0>().column.size()) + int(p.rows.pool<0>().items());
  for (int N = std::clamp(400000 / blocks, 50, 2000); N >= 10; N /= 2)
    if (time_sweeps(p, e, N, limit, result)) return;
}

void compare(const std::filesystem::path& file, const Options& o, Table& table) {
  const std::string name = file.stem().string();
  FrictionProblem p = read_problem(file.string());
  const Index n = p.rows.pool<0>().items();
  const std::size_t blocks = p.W.blocks<0, 0>().column.size() + std::size_t(n);
  std::vector<Entry> entries{{"delassus"}, {"delassus-plain", nullptr, true}};
  for (const Configuration& c : configurations()) entries.push_back({c.name, &c, c.sweeps});
  for (const Entry& e : entries) {
    if (!is_wanted(e.name, o.solvers)) continue;
    if (o.sweeps && e.sweeps && table.status(name + ',' + e.name + ",sweep") == nullptr) {
      Result result;
      const bool came = apart([&](Result& r) { time_sweep(p, e, o.limit, r); }, result);
      table.add(name, n, blocks, e.name, "sweep", came && result.runs > 0 ? "timed" : "none", result);
    }
    bool has_failed = false;
    for (const std::string& tolerance : o.tolerances) {
      const std::string key = name + ',' + e.name + ',' + tolerance;
      if (const std::string* before = table.status(key)) {
        has_failed = has_failed || *before == "time";
        continue;
      }
      Result result;
      const double number = positive("--tolerances", tolerance);
      const bool came = !has_failed && apart(
                                           [&](Result& r) {
                                             repeat(r, o.limit, o.repeat, [&](Result& one) {
                                               return run_once(p, e, number, no_limit, one);
                                             });
                                             measure(p, r);
                                           },
                                           result);
      has_failed = !came;
      // What a solver calls converged counts when the error is within the tolerance, but for its own
      // rounding.
      const char* status = !came ? "time" : result.err <= 1.01 * number ? "converged" : "missed";
      table.add(name, n, blocks, e.name, tolerance, status, result);
    }
  }
}

}  // namespace

int main(int count, char** words) try {
  const Options o = parse(count, words);
  Table table(o.out);
  for (const auto& file : o.files) {
    if (!is_wanted(file.stem().string(), o.problems)) continue;
    const double begin = SteadyClock{}.now();
    compare(file, o, table);
    std::printf("%-40s %6.1f s\n", file.stem().string().c_str(), SteadyClock{}.now() - begin);
    std::fflush(stdout);
  }
  return 0;
} catch (const InvalidArgument& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
