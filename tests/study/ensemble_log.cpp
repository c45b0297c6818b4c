#include <delassus/study/ensemble.hpp>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "catch.hpp"
#include "scratch_path.hpp"
#include "study/slides.hpp"
#include "study/worker_threads.hpp"

namespace ensemble_log_tests {

using namespace slides;

namespace {

/// Runs that are counted.
struct Counted {
  std::atomic<int>* made;
  Loop operator()(double friction) const {
    ++*made;
    if (friction == 0.35) throw InvalidArgument("no world of 0.35");
    return make_slide(friction);
  }
};

struct Job {
  std::atomic<int> made{0};
  EnsemblePlan plan{.name = "slides", .steps = 40, .h = 0.01, .observations = {"low (m)", "high (m)"}, .every = 20, .is_quiet = true};

  explicit Job(const char* file) {
    if (!file) return;
    plan.log = scratch_path(file).string();
    std::filesystem::remove(plan.log);
  }
  ~Job() { std::filesystem::remove(plan.log); }
  EnsembleResults run(Index workers = 1, const std::vector<double>& parameters = frictions) {
    return Ensemble{Counted{&made}, parameters}.run(plan, places, WorkerThreads(workers));
  }
  std::string refusal() {
    try {
      run();
    } catch (const InvalidArgument& error) {
      return error.what();
    }
    return "accepted";
  }
};

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
void write(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

void check_equal(const EnsembleResults& a, const EnsembleResults& b) {
  REQUIRE(a.runs.size() == b.runs.size());
  for (std::size_t i = 0; i < a.runs.size(); ++i) {
    const EnsembleRun &x = a.runs[i], &y = b.runs[i];
    CHECK((x.number == y.number && x.parameters == y.parameters && x.failure == y.failure && x.steps == y.steps));
    CHECK((x.capped_steps == y.capped_steps && x.hash == y.hash && x.width == y.width && x.values == y.values));
  }
}

}  // namespace

TEST_CASE("a finished ensemble is read from its log, to the bit and failures included, and no world is made") {
  Job plain(nullptr), job("ensemble_whole.tsv");
  const EnsembleResults fresh = plain.run();
  CHECK(fresh.failed() == 1);
  const EnsembleResults first = job.run(3);
  CHECK(first.resumed == 0);
  check_equal(first, fresh);
  const int made = job.made;
  CHECK(made == int(frictions.size()));
  const EnsembleResults known = job.run(2);
  CHECK(known.resumed == long(frictions.size()));
  CHECK(job.made == made);
  check_equal(known, fresh);
}

TEST_CASE("an ensemble that was killed in the middle of a line goes on, wherever the line was cut") {
  Job plain(nullptr), job("ensemble_cut.tsv");
  const EnsembleResults fresh = plain.run();
  job.run();
  const std::string whole = content(job.plan.log);
  const std::size_t last = whole.rfind('\n', whole.size() - 2) + 1;  // where the last line starts
  const long all = long(frictions.size());
  // From the line end that alone is missing to nothing of the line; then what follows is written, and read a second and a third time.
  for (std::size_t end = whole.size() - 1; end >= last; end -= end > last + 40 ? 3 : 1) {
    CAPTURE(end - last);
    write(job.plan.log, whole.substr(0, end));
    const EnsembleResults mended = job.run();
    CHECK(mended.resumed == all - 1);
    check_equal(mended, fresh);
    const EnsembleResults known = job.run();
    CHECK(known.resumed == all);
    check_equal(known, fresh);
  }
  // In the first line, the comment.
  write(job.plan.log, whole.substr(0, 10));
  CHECK(job.run().resumed == 0);
  CHECK(job.run().resumed == all);
}

TEST_CASE("shards do every run once, and their logs joined in any order are the whole ensemble") {
  Job plain(nullptr), job("ensemble_shard.tsv");
  const EnsembleResults fresh = plain.run();
  std::vector<std::string> parts;
  job.plan.shards = 3;
  for (job.plan.shard = 0; job.plan.shard < 3; ++job.plan.shard) {
    std::filesystem::remove(job.plan.log);
    const EnsembleResults part = job.run(2);
    for (const EnsembleRun& run : part.runs) CHECK(run.number % 3 == job.plan.shard);
    parts.push_back(content(job.plan.log));
  }
  CHECK(job.made == int(frictions.size()));
  job.plan.shard = 0, job.plan.shards = 1;
  std::sort(parts.begin(), parts.end());
  do {
    std::string joined;
    for (const std::string& part : parts) joined += part;
    write(job.plan.log, joined);
    const EnsembleResults all = job.run();
    CHECK(all.resumed == long(frictions.size()));
    check_equal(all, fresh);
  } while (std::next_permutation(parts.begin(), parts.end()));

  // One shard was killed in the middle of a line: joined, that run alone is missing.
  std::string joined = parts[0].substr(0, parts[0].size() - 30) + parts[1] + parts[2];
  write(job.plan.log, joined);
  CHECK(job.run().resumed == long(frictions.size()) - 1);
}

TEST_CASE("damaged fields of a log are passed over, and changed parameters are run again") {
  Job job("ensemble_damaged.tsv");
  job.run();
  const std::string sound = content(job.plan.log);
  const std::size_t first = sound.find('\n') + 1;  // after the comment
  for (const int field : {2, 4, 5, 7, 8, 13})
    for (const char* wrong : {"1e300", "-1", "x", "0x1", ""}) {
      if (field >= 7 && field < 13 && (wrong[0] == '1' || wrong[0] == '-')) continue;  // a number: nobody can tell
      std::size_t start = first;
      for (int k = 0; k < field; ++k) start = sound.find('\t', start) + 1;
      std::string damaged = sound;
      damaged.replace(start, sound.find_first_of("\t\n", start) - start, wrong);
      write(job.plan.log, damaged);
      CAPTURE(field, wrong);
      CHECK(job.run().resumed == long(frictions.size()) - 1);
    }
  write(job.plan.log, sound);
  std::vector<double> others = frictions;
  others[4] = 0.42;
  const EnsembleResults changed = job.run(1, others);
  CHECK(changed.resumed == long(frictions.size()) - 1);
  CHECK(changed.runs[4].parameters == "0.42");
  CHECK(changed.failed() == 0);  // it was 0.35, which failed
}

TEST_CASE("a log of another ensemble is refused, and so is one that cannot be written") {
  Job job("ensemble_other.tsv");
  job.run();
  const std::string other = "delassus: ensemble 'slides': its log '" + job.plan.log +
                            "' has runs of another ensemble: another name, number of runs, step, number of steps, or other observations; name "
                            "another file";
  const EnsemblePlan plan = job.plan;
  job.plan.h = 0.02;
  CHECK(job.refusal() == other);
  job.plan = plan, job.plan.steps = 60;
  CHECK(job.refusal() == other);
  job.plan = plan, job.plan.every = 10;
  CHECK(job.refusal() == other);
  job.plan = plan, job.plan.observations[1] = "top (m)";
  CHECK(job.refusal() == other);
  job.plan = plan, job.plan.name = "other";
  CHECK(job.refusal() != "accepted");
  job.plan = plan;
  CHECK_THROWS_AS(job.run(1, {0.1, 0.2}), InvalidArgument);
  CHECK(job.refusal() == "accepted");

  const int made = job.made;
  job.plan.log = "/no such folder/runs.tsv";
  CHECK(job.refusal() == "delassus: cannot open the ensemble's log '/no such folder/runs.tsv' for writing; does its folder exist?");
  CHECK(job.made == made);  // before a world is made
  job.plan = plan;

  struct Unnamed {
    double friction;
  };
  const Ensemble unnamed{[](const Unnamed& p) { return make_slide(p.friction); }, std::vector<Unnamed>{{0.2}, {0.4}}};
  CHECK_THROWS_WITH(unnamed.run(plan, places),
                    "delassus: ensemble 'slides': its log '" + plan.log + "' has runs of another ensemble: another name, number of runs, step, "
                    "number of steps, or other observations; name another file");
  std::filesystem::remove(plan.log);
  CHECK_THROWS_WITH(unnamed.run(plan, places), "delassus: ensemble 'slides': its log cannot tell these parameters apart; make them numbers, words, "
                                               "lists of them, or a type with `std::string code() const`");
  EnsemblePlan without = plan;
  without.log.clear();
  CHECK(unnamed.run(without, places).runs.size() == 2);
}

}  // namespace ensemble_log_tests
