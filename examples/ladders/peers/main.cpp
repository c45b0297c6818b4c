// delassus_peers: the ladders' own rungs on other engines, each row in a process of its own.
#include "page.hpp"
#include "tables.hpp"

#include <delassus/io/csv.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

namespace ladders::peers {

namespace {

namespace fs = std::filesystem;

constexpr const char* help =
    R"text(delassus_peers [ROW...] [--engine NAME]... [--out DIR] [--docs FILE] [--summary FILE] [--seconds S] [--jobs N]
               [--keep] [--quick]

Runs the rungs of delassus_ladders on other engines and on delassus, and measures all by the same geometry.

  ROW            HC-01 or a word of a title; all if none is said
  --engine NAME  only these; delassus is one
  --out DIR      peers.csv has every figure; "out/peers" if not said
  --docs FILE    replaces this page's table of engines, and the best peer beside each row of the ladders
  --summary FILE writes a line an engine and row, which delassus_ladders reads
  --seconds S    a rung whose steps take more processor time has failed, and ends its row; 20 if not said
  --jobs N       processes at once; 1 if not said
  --keep         does not run again what DIR/rows has whole
  --quick        the easiest rung of each row, cut short
  --help         this text, and the engines
)text";

struct Options {
  std::vector<std::string> wanted, engines;
  std::string out = "out/peers", docs, summary, unknown;
  double seconds = 20;
  int jobs = 1;
  bool is_quick = false, keeps = false, wants_help = false;
};

Options read_options(int count, char** words) {
  Options o;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    const auto value = [&]() -> std::string { return k + 1 < count ? words[++k] : (o.unknown = word); };
    if (word == "--engine")
      o.engines.push_back(value());
    else if (word == "--out")
      o.out = value();
    else if (word == "--docs")
      o.docs = value();
    else if (word == "--summary")
      o.summary = value();
    else if (word == "--seconds")
      o.seconds = std::atof(value().c_str());
    else if (word == "--jobs")
      o.jobs = std::atoi(value().c_str());
    else if (word == "--quick")
      o.is_quick = true;
    else if (word == "--keep")
      o.keeps = true;
    else if (word == "--help" || word == "-h")
      o.wants_help = true;
    else if (word.starts_with("-"))
      o.unknown = word;
    else
      o.wanted.push_back(word);
  }
  if (!(o.seconds > 0)) o.unknown = "--seconds";
  if (o.jobs < 1) o.unknown = "--jobs";
  return o;
}

std::vector<const EngineKind*> all_kinds() {
  std::vector<const EngineKind*> out;
  const auto add = [&](std::span<const EngineKind> kinds) {
    for (const EngineKind& kind : kinds) out.push_back(&kind);
  };
  (void)add;
#ifdef DELASSUS_PEERS_BULLET
  add(bullet_kinds());
#endif
#ifdef DELASSUS_PEERS_ODE
  add(ode_kinds());
#endif
#ifdef DELASSUS_PEERS_DART
  add(dart_kinds());
#endif
#ifdef DELASSUS_PEERS_MUJOCO
  add(mujoco_kinds());
#endif
  return out;
}

bool is_wanted(const Row& row, const Options& options) {
  if (options.wanted.empty()) return true;
  for (const std::string& word : options.wanted)
    for (const char* text : {row.id, row.title})
      if (std::string_view(text).find(word) != std::string_view::npos) return true;
  return false;
}

struct Task {
  const Row* row;
  const EngineKind* kind;
  fs::path file;
};

/// Ours with the parts of every row; the others once a case, on the row of it that stands last: it has the
/// most rungs.
std::vector<Task> tasks_of(const Options& options) {
  std::vector<Task> out;
  std::vector<const EngineKind*> kinds{nullptr};
  for (const EngineKind* kind : all_kinds()) kinds.push_back(kind);
  for (const Row& row : rows) {
    if (!is_wanted(row, options)) continue;
    bool is_last = true;
    for (const Row* next = &row + 1; next != std::end(rows); ++next)
      is_last =
          is_last && (std::string_view(next->id) != row.id || std::string_view(next->title) != row.title);
    for (const EngineKind* kind : kinds) {
      const std::string name = kind ? kind->name : "delassus";
      bool is_in = options.engines.empty();
      for (const std::string& engine : options.engines) is_in = is_in || engine == name;
      if (!is_in || (kind && !is_last)) continue;
      out.push_back(
          {&row, kind, fs::path(options.out) / "rows" / (std::to_string(&row - rows) + "-" + name + ".txt")});
    }
  }
  return out;
}

/// Runs one row and never comes back: what an engine prints goes to a log, and what it breaks is its process.
[[noreturn]] void climb(const Task& task, const Options& options) {
  std::FILE* out = std::fopen(task.file.c_str(), "w");
  const std::string log = task.file.string() + ".log";
  if (!out || !std::freopen(log.c_str(), "w", stdout) || !std::freopen(log.c_str(), "a", stderr)) _exit(4);
  const rlimit memory{rlim_t(6) << 30, rlim_t(6) << 30};
  setrlimit(RLIMIT_AS, &memory);
  Referee referee(task.kind, options.seconds, out);
  // Measuring may take longer than the steps, whose time the referee keeps.
  Ladder ladder("", options.is_quick, 20 * options.seconds, &referee);
  task.row->climb(ladder);
  std::fputs("done\n", out);
  std::fclose(out);
  _exit(0);  // no engine's destructors of statics: the figures are written
}

/// Adds what ended the process, if that was not the end of the row.
void bury(const Task& task, int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  std::ofstream(task.file, std::ios::app)
      << "died\t"
      << (signal == 0         ? "stopped itself"
          : signal == SIGPROF ? "hung"
                              : std::string("crashed: ") + strsignal(signal))
      << "\n";
}

/// What the process wrote; a rung that began and did not end is its last. `is_whole`: nothing is to come.
Climb read_climb(const Task& task, bool& is_whole) {
  Climb out{task.row, task.kind, {}};
  is_whole = false;
  std::ifstream in(task.file);
  std::string begun;
  for (std::string line; std::getline(in, line);) {
    const std::string rest = line.substr(std::min(line.size(), line.find('\t') + 1));
    if (line.starts_with("begin")) begun = rest;
    if (line.starts_with("end")) begun.clear(), out.rungs.push_back(outcome_of(rest));
    if (line.starts_with("died") && !begun.empty()) out.rungs.push_back({.difficulty = begun, .said = rest});
    is_whole = is_whole || line.starts_with("died") || line == "done";
  }
  return out;
}

void say(const Climb& climb) {
  std::printf("%s %s, %s: ", climb.row->id, climb.row->title, climb.engine().c_str());
  if (climb.is_refused())
    std::printf("%s\n", climb.rungs.empty() ? "nothing" : climb.rungs.front().said.c_str());
  else
    std::printf("silver %zu, gold %zu of the %zu rungs it saw\n", climb.up_to(Level::silver),
                climb.up_to(Level::gold), climb.rungs.size());
  std::fflush(stdout);
}

std::vector<Climb> climb_all(const std::vector<Task>& tasks, const Options& options) {
  std::vector<Climb> out(tasks.size());
  std::map<pid_t, std::size_t> running;
  bool is_whole = false;
  const auto wait_for_one = [&] {
    int status = 0;
    const auto found = running.find(wait(&status));
    if (found == running.end()) return;
    const std::size_t k = found->second;
    bury(tasks[k], status);
    out[k] = read_climb(tasks[k], is_whole);
    say(out[k]);
    running.erase(found);
  };
  for (std::size_t k = 0; k < tasks.size(); ++k) {
    if (const char* reason = why_not(*tasks[k].row)) {
      out[k] = {tasks[k].row, tasks[k].kind, {{.difficulty = "", .said = reason, .is_refused = true}}};
      continue;
    }
    if (options.keeps) out[k] = read_climb(tasks[k], is_whole);
    if (options.keeps && is_whole) continue;
    if (int(running.size()) == options.jobs) wait_for_one();
    const pid_t child = fork();
    DELASSUS_EXPECT(child >= 0, "delassus_peers: no process could be made");
    if (child == 0) climb(tasks[k], options);
    running[child] = k;
  }
  while (!running.empty()) wait_for_one();
  return out;
}

void compare(const Options& options) {
  fs::create_directories(fs::path(options.out) / "rows");
  const std::vector<Climb> all = climb_all(tasks_of(options), options);
  delassus::write_csv((fs::path(options.out) / "peers.csv").string(), figures(all));
  const std::string table = markdown(all);
  std::printf("\n%s\n", table.c_str());
  const std::string lines = (fs::path(options.out) / "summary.csv").string();
  delassus::write_csv(lines, summary(all));
  if (!options.summary.empty()) fs::copy_file(lines, options.summary, fs::copy_options::overwrite_existing);
  if (!options.docs.empty()) write_page(options.docs, table, read_peers(lines));
}

}  // namespace
}  // namespace ladders::peers

int main(int count, char** words) {
  using namespace ladders::peers;
  const Options options = read_options(count, words);
  if (options.wants_help) {
    std::fputs(help, stdout);
    for (const EngineKind* kind : all_kinds())
      std::printf("  %-14s %s; set: %s\n", kind->name, kind->title, kind->settings);
    return 0;
  }
  if (!options.unknown.empty()) {
    std::fprintf(stderr,
                 "delassus_peers: '%s' is not an option, or its value is not one; --help lists them.\n",
                 options.unknown.c_str());
    return 2;
  }
  try {
    compare(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "delassus_peers: %s\n", error.what());
    return 1;
  }
}
