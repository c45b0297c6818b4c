// The demonstration: nine scenes and two tables, in the terminal and on one page that replays them.
#include "scene.hpp"

#include <delassus/core/expect.hpp>
#include <delassus/io/progress.hpp>
#include <delassus/io/replay_page.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace demonstration {

namespace {

constexpr const char* help = R"text(delassus_demo [--out DIR] [--quick] [--quiet]

  --out DIR   the folder of index.html, made if missing; "out" if not said
  --quick     the same scenes for a fraction of a second each
  --quiet     no tables; what is wrong is still said
  --help      this text
)text";

struct Options {
  std::string out = "out", unknown;
  bool is_quick = false, is_quiet = false, wants_help = false;
};

Options read_options(std::span<char*> arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    if (word == "--quick") options.is_quick = true;
    else if (word == "--quiet") options.is_quiet = true;
    else if (word == "--help" || word == "-h") options.wants_help = true;
    else if (word == "--out" && i + 1 < arguments.size()) options.out = arguments[++i];
    else options.unknown = word;
  }
  return options;
}

/// A part of the run and its share of the time, for the progress line.
struct Part {
  const char* name;
  Scene (*run)(bool, const Watch&);
  double share;
};
constexpr Part parts[] = {{"falling box", falling_box, 0.01}, {"stack", stack, 0.02}, {"slope", slope, 0.01},
                          {"chain", chain, 0.07},             {"wall", wall, 0.38},   {"pile", pile, 0.41},
                          {"soft grip", soft_grip, 0.04},     {"soft beam", soft_beam, 0.02}, {"needle", needle, 0.02}};

int run(const Options& options) {
  Progress progress("demonstration");
  double done = 0, share = 0;
  const Watch watch = [&](double fraction) { progress.show(done + share * fraction); };
  std::vector<Scene> scenes;
  for (const Part& part : parts) {
    share = part.share;
    scenes.push_back(part.run(options.is_quick, watch));
    done += share;
  }
  share = 1 - done;
  const Table tables[] = {table_of_scenes(scenes), table_of_accuracy(options.is_quick, watch)};
  std::vector<std::string> broken;
  std::vector<Recording> recordings;
  for (Scene& scene : scenes) {
    broken.insert(broken.end(), scene.broken.begin(), scene.broken.end());
    recordings.push_back(std::move(scene.recording));
  }
  std::filesystem::create_directories(options.out);
  const std::string path = (std::filesystem::path(options.out) / "index.html").string();
  const std::size_t bytes = write_replay_page(path, "delassus: nine scenes of constrained dynamics", recordings, tables,
      {.introduction = "Rigid and soft bodies under joints, contact and Coulomb friction, as the library computed them: nothing here "
                       "is animated by hand. Each scene states bounds of physics, and the program that wrote this page "
                       "fails when one does not hold."});
  progress.show(1);
  if (!options.is_quiet) {
    std::printf("\n%s\n%s\n%s: %.1f MB, after %.1f s\n", aligned_text(tables[0]).c_str(),
                aligned_text(tables[1]).c_str(), path.c_str(), 1e-6 * double(bytes), progress.elapsed());
  }
  std::fflush(stdout);  // what failed comes last, also in a file
  for (const std::string& sentence : broken) std::fprintf(stderr, "%s.\n", sentence.c_str());
  if (!broken.empty()) std::fprintf(stderr, "%zu of the demonstration's bounds do not hold.\n", broken.size());
  return broken.empty() ? 0 : 1;
}

}  // namespace
}  // namespace demonstration

int main(int count, char** arguments) {
  using namespace demonstration;
  const Options options = read_options(std::span(arguments, std::size_t(count)).subspan(1));
  if (options.wants_help) return std::fputs(help, stdout), 0;
  if (!options.unknown.empty()) {
    std::fprintf(stderr, "delassus_demo: '%s' is not an option, or lacks its value; --help lists them.\n",
                 options.unknown.c_str());
    return 2;
  }
  try {
    return run(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "delassus_demo: %s\n", error.what());
    return 1;
  }
}
