/// What the user says on the command line of delassus_run.
#pragma once

#include <delassus/model/model.hpp>

#include <CLI/CLI.hpp>

#include <map>
#include <string>
#include <vector>

namespace delassus_run {

struct Options {
  std::vector<std::string> models;
  std::string out = "out/run", key, meshes;
  double seconds = 5, step = 5e-3, tolerance = 1e-6, friction = 0.8;
  delassus::Base base = delassus::Base::as_file;
  bool has_ground = false, lists_all = false, is_strict = false, is_quiet = false;
};

/// Reads them; a wrong word ends the program with a sentence.
inline void describe(CLI::App& app, Options& options) {
  const std::map<std::string, delassus::Base> bases{{"free", delassus::Base::free}, {"fixed", delassus::Base::fixed}};
  app.add_option("MODEL", options.models, "URDF (.urdf) or MJCF (.xml) files; each runs by itself")->required()->check(CLI::ExistingFile);
  app.add_option("--seconds", options.seconds, "to simulate")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--dt", options.step, "step, s")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--tolerance", options.tolerance, "of the solver, a share of the speeds")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--friction", options.friction, "of all contacts")->check(CLI::NonNegativeNumber)->capture_default_str();
  app.add_option("--base", options.base, "free or fixed: whether something holds the root; as the file says if not said")->transform(CLI::CheckedTransformer(bases));
  app.add_flag("--ground", options.has_ground, "adds a floor at z = 0, and lifts the machine onto it");
  app.add_option("--key", options.key, "keyframe of the file to start from");
  app.add_option("--meshes", options.meshes, "a folder of meshes, for URDF");
  app.add_flag("--strict", options.is_strict, "refuses what would be left out");
  app.add_flag("--all", options.lists_all, "lists all that was left out");
  app.add_flag("--quiet", options.is_quiet, "no table while it runs");
  app.add_option("--out", options.out, "folder of NAME.html and NAME.csv, made if missing")->capture_default_str();
}

}  // namespace delassus_run
