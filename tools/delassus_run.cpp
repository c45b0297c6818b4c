// delassus_run: simulates robots of URDF and MJCF files, and shows them.
#include "delassus_run/control.hpp"
#include "delassus_run/options.hpp"
#include "delassus_run/read.hpp"
#include "delassus_run/show.hpp"
#include "delassus_run/start.hpp"
#include "delassus_run/study.hpp"

#include <delassus/bodies/invariants.hpp>
#include <delassus/io/replay_page.hpp>
#include <delassus/io/vtk.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>

namespace delassus_run {

namespace {

/// The first of them, or all.
void list(const char* what, const std::vector<std::string>& sentences, const Options& options) {
  const std::size_t shown = options.lists_all ? sentences.size() : std::min<std::size_t>(sentences.size(), 5);
  for (std::size_t k = 0; k < shown; ++k) std::printf("%s: %s\n", what, in_words_of_options(sentences[k]).c_str());
  if (shown < sentences.size()) std::printf("%s: %zu more, which --all lists\n", what, sentences.size() - shown);
}

/// "39 links, which are 13 bodies: fixed joints make one of several; 3 of the links stand still".
std::string size_of(const Model& model, const Machine& machine) {
  std::set<Index> bodies;
  int still = 0;
  for (const model::Part& part : machine.parts) part.is_world ? void(++still) : void(bodies.insert(part.body.index));
  const auto count = [](std::size_t n, const char* one, const char* more) { return std::to_string(n) + " " + (n == 1 ? one : more); };
  const std::size_t links = model.bodies.size();
  std::string text = count(links, "link", "links");
  if (bodies.size() + std::size_t(still) < links) text += " in " + count(bodies.size(), "body", "bodies") + ", since links that a fixed joint holds move as one,";
  if (still > 0) text += (text.ends_with(',') ? " " : ", ") + std::to_string(still) + " at rest,";
  if (!text.ends_with(',')) text += ",";
  return text + " " + count(model.joints.size(), "joint", "joints");
}

void print_head(bool is_controlled) {
  std::printf("%10s %18s %9s %12s %12s %12s%s\n", "time (s)", "kinetic energy (J)", "contacts", "residual", "gap (m)", "overlap (m)", is_controlled ? "  inner steps" : "");
}

/// False where bodies were held.
bool simulate(const Model& model, const Start& start, const Options& options, const std::string& name, const std::string& base) {
  const Asked asked = options.asked();
  const std::unique_ptr<Motion> motion = start.put(asked);
  list("not done", motion->machine.left_out, options);
  if (!options.is_quiet) std::printf("%s: %s\n%s: %s\n", name.c_str(), size_of(model, motion->machine).c_str(), name.c_str(), name_of(model, asked).c_str());

  Show show(model, *motion, start.pose(), start.adds_floor(), options.frames);
  Rows rows(base + ".csv", model, *motion);
  std::optional<VtkSeries> vtk;
  if (options.writes_vtk) vtk.emplace(base);
  ControlTable control = options.control.empty() ? ControlTable() : ControlTable(options.control, motion->machine);
  for (const std::string& note : control.notes) std::printf("note: %s\n", note.c_str());
  const double h = options.caller_step();
  const long steps = std::max(1l, std::lround(options.seconds / h)), every = std::max(1l, steps / 10);
  double gap = 0, overlap = 0;  // m, the largest of all steps
  long unconverged = 0, held = 0, inner_steps = 0, at_floor = 0;
  const auto begin = std::chrono::steady_clock::now();
  if (!options.is_quiet) print_head(asked.accuracy > 0);
  for (long n = 1; n <= steps; ++n) {
    control.set(motion->machine, motion->time());
    const StepReport report = motion->step(h);
    unconverged += report.status != Status::converged && report.status != Status::stalled;
    held += report.quarantined;
    gap = std::max(gap, double(report.max_joint_violation)), overlap = std::max(overlap, double(report.max_penetration));
    inner_steps += motion->error_report().steps, at_floor += motion->error_report().at_floor;
    const double kinetic = kinetic_energy(motion->set());
    rows.take(*motion, report, kinetic);
    if (show.take(*motion, report, kinetic + potential_energy(motion->set())) && vtk) vtk->add(show.recording.bodies, show.recording.frames.back());
    if (options.is_quiet || (n % every != 0 && n != steps)) continue;
    std::printf("%10.3f %18.6g %9d %12.2g %12.2g %12.2g", motion->time(), kinetic, int(motion->contacts().size()), report.residual, report.max_joint_violation, report.max_penetration);
    if (asked.accuracy > 0) std::printf(" %12ld", inner_steps);
    std::puts(""), std::fflush(stdout);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  rows.close();
  show.recording.steps.tolerance = asked.tolerance;
  write_replay_page(base + ".html", model.name.empty() ? name : model.name, std::vector{show.recording});

  if (options.audits) {
    const AuditReport report = motion->audit();
    std::puts(""), print(audit_table(report));
    if (!report.causes.empty()) std::puts(""), print(step_table(report));
    std::puts("");
  }
  std::printf("%s: %s, %ld steps, %ld not converged, %.0f µs a step, gaps of joints up to %.2g m, overlaps up to %.2g m\n", name.c_str(), size_of(model, motion->machine).c_str(), steps, unconverged,
              1e6 * seconds / double(steps), gap, overlap);
  if (at_floor > 0) std::printf("%s: %ld inner steps were as small as they may be and missed the accuracy\n", name.c_str(), at_floor);
  if (held > 0) std::printf("%s: bodies were held since their motion was not finite\n", name.c_str());
  std::printf("%s.html\n%s.csv\n", base.c_str(), base.c_str());
  if (vtk) std::printf("%s.pvd\n", base.c_str());
  return held == 0;
}

/// False where bodies were held.
bool run(const std::string& path, const std::string& name, const Options& options) {
  const Model model = read(path, options);
  list("not read", model.skipped, options);
  const Start start(model, options);
  for (const std::string& note : start.notes) std::printf("note: %s\n", note.c_str());
  const std::string base = (std::filesystem::path(options.out) / name).string();
  const bool is_sound = simulate(model, start, options, name, base);
  if (options.studies) study_of(model, start, options, path, base);
  return is_sound;
}

}  // namespace
}  // namespace delassus_run

int main(int count, char** arguments) {
  using namespace delassus_run;
  CLI::App app{"Simulates robots of URDF and MJCF files. Writes a page that replays the run, and the joints of each step as a table."};
  Options options;
  describe(app, options);
  CLI11_PARSE(app, count, arguments);
  try {
    check(options);
    std::filesystem::create_directories(options.out);
  } catch (const std::exception& error) {
    return std::fprintf(stderr, "delassus_run: %s\n", error.what()), 2;
  }
  const std::vector<std::string> names = names_of_outputs(options.models);
  bool is_sound = true;
  for (std::size_t k = 0; k < options.models.size(); ++k) {
    try {
      is_sound = run(options.models[k], names[k], options) && is_sound;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "delassus_run: %s\n", in_words_of_options(error.what()).c_str());
      is_sound = false;
    }
  }
  return is_sound ? 0 : 1;
}
