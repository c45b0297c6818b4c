// delassus_run: simulates robots of URDF and MJCF files, and shows them.
#include "delassus_run/options.hpp"
#include "delassus_run/show.hpp"

#include <delassus/adapters/mjcf.hpp>
#include <delassus/adapters/urdf.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/io/csv.hpp>
#include <delassus/io/replay_page.hpp>
#include <delassus/model/joint_state.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace delassus_run {

namespace {

/// By the file's name; where that is .xml, by its root.
Model read(const std::string& path, const Options& options) {
  const bool is_urdf = path.ends_with(".urdf") || (!path.ends_with(".mjcf") && inner::read_text(path).find("<robot") != std::string::npos);
  if (is_urdf) return read_urdf(path, {.strict = options.is_strict, .meshes = options.meshes});
  return read_mjcf(path, {.strict = options.is_strict, .files = {}});
}

/// Every law that a machine of a file may need.
auto make_loop(const Options& options) {
  return AnimationLoop{
      World{RigidBodies{}},
      Constraints{Contact{Coulomb{.friction = options.friction}}, Hinge{}, Slider{}, BallJoint{}, Weld{}, SerialJoint<0, 2>{}, SerialJoint<0, 3>{},
                  SerialJoint<1, 1>{}, SerialJoint<2, 0>{}, SerialJoint<2, 1>{}, SerialJoint<3, 0>{}, Limit<Turn>{}, Limit<Slide>{},
                  Limit<Precession>{}, Limit<Nutation>{}, Limit<Spin>{}, Limit<Length>{}, SpringDamper<Turn>{}, SpringDamper<Slide>{},
                  SpringDamper<Precession>{}, SpringDamper<Nutation>{}, SpringDamper<Spin>{}, SpringDamper<Length>{}, RotorInertia<Turn>{}, RotorInertia<Slide>{},
                  RotorInertia<Precession>{}, RotorInertia<Nutation>{}, RotorInertia<Spin>{}, Motor<Turn>{},
                  Motor<Slide>{}, Motor<Precession>{}, Motor<Nutation>{}, Motor<Spin>{}, Coupling<Turn, Turn>{}, Coupling<Slide, Turn>{},
                  Coupling<Turn, Slide>{}, Coupling<Slide, Slide>{}},
      WithFilter{WithCompounds{NativeCollision{}}}, DirectGaussSeidel{.tolerance = options.tolerance}};
}

/// q and v of a keyframe; a sentence with the names where there is none.
const model::Keyframe& keyframe(const Model& model, const std::string& name) {
  std::string names;
  for (const model::Keyframe& key : model.keyframes) {
    if (key.name == name) return key;
    names += " '" + key.name + "'";
  }
  inner::refuse("model '" + model.name + "' has no keyframe '" + name + "'; it has" + (names.empty() ? " none" : names));
}

/// The first of them, or all.
void list(const char* what, const std::vector<std::string>& sentences, const Options& options) {
  const std::size_t shown = options.lists_all ? sentences.size() : std::min<std::size_t>(sentences.size(), 5);
  for (std::size_t k = 0; k < shown; ++k) std::printf("%s: %s\n", what, sentences[k].c_str());
  if (shown < sentences.size()) std::printf("%s: %zu more, which --all lists\n", what, sentences.size() - shown);
}

/// False where steps did not converge or bodies were held.
bool run(const std::string& path, const Options& options) {
  const Model model = read(path, options);
  list("not read", model.skipped, options);
  auto loop = make_loop(options);
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = model.gravity;
  const Pose pose{Vec3(0, 0, options.has_ground ? -lowest_point(model) : 0), Mat3::Identity()};
  const Machine machine = add(loop, model, pose, options.base);
  list("not done", machine.left_out, options);
  if (options.has_ground) set.add_fixed(HalfSpace{});
  if (!options.key.empty()) {
    const model::Keyframe& key = keyframe(model, options.key);
    JointSpace space(model, options.base, pose);
    std::vector<double> v = key.v;
    v.resize(std::size_t(space.v_size()), 0);
    set_joint_state(loop, machine, space, key.q, v);
  }

  Show show(model, machine, pose, options.has_ground);
  const long steps = std::max(1l, std::lround(options.seconds / options.step)), every = std::max(1l, steps / 10);
  long unconverged = 0, held = 0;
  const auto begin = std::chrono::steady_clock::now();
  if (!options.is_quiet) std::printf("%10s %18s %9s %12s %12s %12s\n", "time (s)", "kinetic energy (J)", "contacts", "residual", "gap (m)", "overlap (m)");
  for (long n = 1; n <= steps; ++n) {
    const StepReport report = loop.step(options.step);
    unconverged += report.status != Status::converged && report.status != Status::stalled;
    held += report.quarantined;
    const double kinetic = kinetic_energy(set);
    show.take(loop, report, kinetic, potential_energy(set));
    if (!options.is_quiet && (n % every == 0 || n == steps))
      std::printf("%10.3f %18.6g %9d %12.2g %12.2g %12.2g\n", loop.time(), kinetic, int(loop.contacts().size()), report.residual,
                  report.max_joint_violation, report.max_penetration), std::fflush(stdout);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

  const std::string name = std::filesystem::path(path).stem().string(), base = (std::filesystem::path(options.out) / name).string();
  write_csv(base + ".csv", show.joints);
  write_replay_page(base + ".html", model.name.empty() ? name : model.name, std::vector{show.recording});
  std::printf("%s: %d bodies, %d joints, %ld steps, %ld not converged, %.0f µs a step\n%s.html\n%s.csv\n", name.c_str(), int(model.bodies.size()),
              int(model.joints.size()), steps, unconverged, 1e6 * seconds / double(steps), base.c_str(), base.c_str());
  if (held > 0) std::printf("%s: bodies were held since their motion was not finite\n", name.c_str());
  return held == 0;
}

}  // namespace
}  // namespace delassus_run

int main(int count, char** arguments) {
  using namespace delassus_run;
  CLI::App app{"Simulates robots of URDF and MJCF files. Writes a page that replays the run, and the joints of each step as a table."};
  Options options;
  describe(app, options);
  CLI11_PARSE(app, count, arguments);
  bool is_sound = true;
  for (const std::string& path : options.models) {
    try {
      std::filesystem::create_directories(options.out);
      is_sound = run(path, options) && is_sound;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "delassus_run: %s\n", error.what());
      is_sound = false;
    }
  }
  return is_sound ? 0 : 1;
}
