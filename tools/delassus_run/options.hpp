/// What the user says on the command line of delassus_run.
#pragma once

#include "motion.hpp"

#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace delassus_run {

struct Options {
  std::vector<std::string> models, packages, places;
  std::vector<double> hold;  ///< stiffness and damping of joints that hold; empty: none does
  std::string out = "out/run", key, meshes, control;
  double seconds = 5, step = 5e-3, accuracy = 0, tolerance = 0, friction = -1, budget = 1e-3, frames = 30, height = 0;
  int threads = 1;
  Base base = Base::as_file;
  std::optional<Integration> integration;  ///< `euler`, or `midpoint` under an accuracy
  bool has_ground = false, lists_all = false, is_strict = false, is_quiet = false, audits = false, studies = false, writes_vtk = false, pushes_apart = false;

  static constexpr double most_steps = 1e7;
  static constexpr double step_under_control = 0.01;  ///< from row to row of the table, s

  /// Which loop it is, and its numbers. A tolerance that nobody said is fine enough for the accuracy.
  Asked asked() const {
    const double usual = accuracy > 0 ? std::min(1e-6, 1e-3 * accuracy) : 1e-6;
    return {.integration = integration.value_or(Integration::euler), .accuracy = accuracy, .audits = audits, .tolerance = tolerance > 0 ? tolerance : usual, .friction = friction, .longest_step = caller_step(), .threads = threads};
  }
  /// A share of the stiffness that damps where the user says no damping, s: a joint without inertia comes to rest in it.
  static constexpr double usual_damping = 0.05;

  double caller_step() const { return accuracy > 0 ? std::min(step_under_control, seconds) : step; }
};

/// A finite number in [least, most].
inline CLI::Validator number_in(double least, double most, const std::string& words) {
  return CLI::Validator(
      [=](const std::string& word) {
        double number = 0;
        if (CLI::detail::lexical_cast(word, number) && std::isfinite(number) && number >= least && number <= most) return std::string();
        return "'" + word + "' is not " + words;
      },
      "NUMBER");
}

/// One of the words of a map, which becomes what it stands for.
template <class T>
CLI::Validator one_of(std::map<std::string, T> words, const std::string& which) {
  return CLI::Validator(
      [=](std::string& word) {
        const auto found = words.find(word);
        if (found == words.end()) return "'" + word + "' is not " + which;
        word = std::to_string(int(found->second));
        return std::string();
      },
      "WORD");
}

/// Reads them; a wrong word ends the program with a sentence.
inline void describe(CLI::App& app, Options& options) {
  const std::map<std::string, Base> bases{{"free", Base::free}, {"fixed", Base::fixed}};
  const std::map<std::string, Integration> integrations{{"euler", Integration::euler}, {"midpoint", Integration::midpoint}};
  app.add_option("MODEL", options.models, "URDF (.urdf) or MJCF (.xml) files; each runs by itself")->required()->check(CLI::ExistingFile);
  app.add_option("--seconds", options.seconds, "to simulate")->check(number_in(1e-9, 1e6, "a time from 1e-9 to 1e6 s"))->capture_default_str();
  auto* const step = app.add_option("--dt", options.step, "step, s")->check(number_in(1e-9, 10, "a step from 1e-9 to 10 s"))->capture_default_str();
  app.add_option("--accuracy", options.accuracy, "error of an inner step, a share of a body's size: steps follow it, in place of --dt")
      ->check(number_in(1e-9, 0.1, "an accuracy from 1e-9 to 0.1"))
      ->excludes(step);
  app.add_option("--integrator", options.integration, "euler or midpoint, of second order; --accuracy takes midpoint")->transform(one_of(integrations, "euler or midpoint"));
  app.add_option("--tolerance", options.tolerance, "of the solver, a share of the speeds; 1e-6, or what the accuracy takes")->check(number_in(1e-15, 1, "a tolerance from 1e-15 to 1"));
  app.add_option("--friction", options.friction, "of all contacts; else what the file says, and 0.8 where it says nothing")->check(number_in(0, 1e6, "a coefficient from 0 to 1e6"));
  app.add_option("--base", options.base, "free or fixed: whether something holds the root; as the file says if not said")->transform(one_of(bases, "free or fixed"));
  auto* const ground = app.add_flag("--ground", options.has_ground, "adds a floor at z = 0 where the file has none, and sets the machine on it");
  app.add_flag("--push-apart", options.pushes_apart, "links of one tree collide even where they are in each other at the start");
  app.add_option("--height", options.height, "at which the machine is let go above the floor of --ground, m")->check(number_in(0, 1e6, "a height from 0 to 1e6 m"))->needs(ground);
  app.add_option("--key", options.key, "keyframe of the file to start from");
  app.add_option("--at", options.places, "JOINT=PLACE: where a hinge (rad) or a slide (m) starts; may be repeated");
  app.add_option("--hold", options.hold, "STIFFNESS[,DAMPING]: each joint without an actuator holds where it starts, N·m/rad or N/m; capped by the file's effort. An actuator of the joint's name for --control")
      ->delimiter(',')
      ->expected(1, 2)
      ->check(number_in(0, 1e12, "a number from 0 to 1e12"));
  app.add_option("--control", options.control, "a CSV table: time (s), then a column for each actuator it controls, by name; else controls are those of --key, or 0")->check(CLI::ExistingFile);
  app.add_option("--meshes", options.meshes, "a folder of meshes and other files")->check(CLI::ExistingDirectory);
  app.add_option("--package", options.packages, "NAME=FOLDER of package://NAME, for URDF; may be repeated");
  app.add_flag("--study", options.studies, "runs the loops, steps and tolerances there are, and names the cheapest within --budget");
  app.add_option("--budget", options.budget, "largest error of a place in a study, m")->check(number_in(1e-12, 1e6, "a length from 1e-12 to 1e6 m"))->capture_default_str();
  app.add_option("--threads", options.threads, "of a step, or runs of a study at once; 0: one a processor; results do not depend on them")->check(number_in(0, 1024, "a number of threads from 0 to 1024"))->capture_default_str();
  app.add_flag("--audit", options.audits, "says which effects acted");
  app.add_flag("--vtk", options.writes_vtk, "writes NAME_vtk/: a .vtp each picture, and NAME.pvd for ParaView");
  app.add_option("--frames", options.frames, "pictures a simulated second, at most")->check(number_in(1e-3, 1e6, "a rate from 1e-3 to 1e6 /s"))->capture_default_str();
  app.add_flag("--strict", options.is_strict, "refuses what would be left out");
  app.add_flag("--all", options.lists_all, "lists all that was left out");
  app.add_flag("--quiet", options.is_quiet, "no table while it runs");
  app.add_option("--out", options.out, "folder of NAME.html and NAME.csv, made if missing")->capture_default_str();
}

/// What no single option of a machine shows. Throws a sentence.
inline void check_machine(const Options& options) {
  DELASSUS_EXPECT(options.accuracy == 0 || options.integration != Integration::euler,
                  "--accuracy takes an integrator of second order; take --integrator euler out, or write midpoint");
  DELASSUS_EXPECT(options.hold.size() <= 2, "--hold takes a stiffness and a damping, not " + std::to_string(options.hold.size()) + " numbers");
  for (const std::string& package : options.packages)
    DELASSUS_EXPECT(package.find('=') != 0 && package.find('=') != package.npos, "--package " + package + ": write NAME=FOLDER");
}

/// The same of a run.
inline void check(const Options& options) {
  check_machine(options);
  const double steps = options.seconds / options.caller_step();
  DELASSUS_EXPECT(options.accuracy > 0 || options.step <= options.seconds,
                  "--dt " + inner::text(options.step) + " is longer than --seconds " + inner::text(options.seconds));
  DELASSUS_EXPECT(steps <= Options::most_steps, "--seconds " + inner::text(options.seconds) + " are " + inner::text(steps) + " steps of " +
                                                    inner::text(options.caller_step()) + " s; more than 1e7 are refused");
  DELASSUS_EXPECT(!options.studies || options.control.empty(), "--study compares runs with the controls of --key; take --control out");
}

/// A name of its own for what each model writes: the file's, with the folder's before it or a number behind it where two are the same.
inline std::vector<std::string> names_of_outputs(const std::vector<std::string>& models) {
  std::vector<std::string> names;
  std::map<std::string, int> count;
  for (const std::string& model : models) ++count[std::filesystem::path(model).stem().string()];
  std::set<std::string> used;
  for (const std::string& model : models) {
    const std::filesystem::path path = std::filesystem::absolute(model).lexically_normal();
    std::string name = path.stem().string();
    if (count[name] > 1) name = path.parent_path().filename().string() + "_" + name;
    std::string own = name;
    for (int n = 2; !used.insert(own).second; ++n) own = name + "_" + std::to_string(n);
    names.push_back(own);
  }
  return names;
}

}  // namespace delassus_run
