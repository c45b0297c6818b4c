// delassus_study: what accuracy costs, for scenes that are built in.
#include "scene_study.hpp"

#include <delassus/core/expect.hpp>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace study_program {

namespace {

constexpr const char* help =
    R"text(delassus_study [--accuracy] [--scene NAME] [--budget E] [--shard I/N] [--threads N] [--out DIR] [--quick] [--quiet]

Runs scenes over integrators, stabilisations, solvers, builders, tolerances and steps; draws error against time; and names
the cheapest combination that holds an error budget. A run that was interrupted goes on from its log in DIR.

  --accuracy     fixed steps beside steps that keep an error, of the same parts: double_pendulum and bouncing_ball
  --scene NAME   sliding_box, double_pendulum, ten_boxes, heavy_chain or soft_bar; all that there are if not said
  --budget E     the largest error of a place, m; 1 mm if not said
  --shard I/N    every Nth run, from the Ith, I = 0 ... N-1; logs of shards joined in NAME.log are the whole study
  --threads N    N runs at once, each timed by the time of its thread; 0: one a processor; 1 if not said
  --out DIR      the folder of NAME.svg, NAME.csv and NAME.log, made if missing; "out/study" if not said
  --quick        two steps and one tolerance each
  --quiet        only the manifest and the choice
  --help         this text
)text";

struct Part {
  const char* name;
  bool (*run)(const Options&);
};
constexpr Part parts[] = {{"sliding_box", sliding_box},
                          {"double_pendulum", double_pendulum},
                          {"ten_boxes", ten_boxes},
                          {"heavy_chain", heavy_chain},
                          {"soft_bar", soft_bar}};
constexpr Part parts_of_accuracy[] = {{"double_pendulum", double_pendulum_accuracy}, {"bouncing_ball", bouncing_ball_accuracy}};

std::span<const Part> parts_for(const Options& options) {
  if (options.has_accuracy) return parts_of_accuracy;
  return parts;
}

bool is_scene(std::span<const Part> among, std::string_view name) {
  for (const Part& part : among)
    if (name == part.name) return true;
  return false;
}

/// "1/4": two numbers and nothing else.
bool read_shard(const char* word, Options& options) {
  int read = 0;
  return std::sscanf(word, "%d/%d%n", &options.shard, &options.shards, &read) == 2 && word[read] == '\0' &&
         options.shard >= 0 && options.shard < options.shards;
}

bool read_threads(const char* word, Options& options) {
  int read = 0;
  return std::sscanf(word, "%d%n", &options.threads, &read) == 1 && word[read] == '\0' && options.threads >= 0 && options.threads <= 1024;
}

bool read_budget(const char* word, Options& options) {
  char* end = nullptr;
  options.budget = std::strtod(word, &end);
  return end != word && *end == '\0' && options.budget > 0 && options.budget < 1e300;
}

Options read_options(std::span<char*> arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    const bool has_value = i + 1 < arguments.size();
    if (word == "--quick")
      options.is_quick = true;
    else if (word == "--accuracy")
      options.has_accuracy = true;
    else if (word == "--quiet")
      options.is_quiet = true;
    else if (word == "--help" || word == "-h")
      options.wants_help = true;
    else if (word == "--out" && has_value)
      options.out = arguments[++i];
    else if (word == "--scene" && has_value)
      options.scene = arguments[++i];
    else if (word == "--budget" && has_value && read_budget(arguments[i + 1], options))
      ++i;
    else if (word == "--threads" && has_value && read_threads(arguments[i + 1], options))
      ++i;
    else if (word == "--shard" && has_value && read_shard(arguments[i + 1], options))
      ++i;
    else
      options.unknown = word;
  }
  if (options.unknown.empty() && !options.scene.empty() && !is_scene(parts_for(options), options.scene)) options.unknown = options.scene;
  return options;
}

}  // namespace
}  // namespace study_program

int main(int count, char** arguments) {
  using namespace study_program;
  const Options options = read_options(std::span(arguments, std::size_t(count)).subspan(1));
  if (options.wants_help) return std::fputs(help, stdout), 0;
  if (!options.unknown.empty()) {
    std::fprintf(stderr,
                 "delassus_study: '%s' is not an option, or its value is not one; --help lists them.\n",
                 options.unknown.c_str());
    return 2;
  }
  try {
    std::filesystem::create_directories(options.out);
    bool holds = true;
    for (const Part& part : parts_for(options))
      if (options.scene.empty() || options.scene == part.name) holds = part.run(options) && holds;
    return holds ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "delassus_study: %s\n", error.what());
    return 1;
  }
}
