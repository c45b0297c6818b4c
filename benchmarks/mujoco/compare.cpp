// A machine of an MJCF file that falls and lies, beside MuJoCo, in one run:
//
//   compare_mujoco FILE... [--step S] [--steps N] [--tolerance T] [--runs N]
//
// Both load the file, with the friction it gives, and make the same steps without controls, a hundred at a
// time in turns. In the second half of them the machine lies on the ground: times are medians of those
// hundreds, µs of processor time a step. Depth is that of the deepest contact, over all steps and over that
// half. Gap is the worst violation of a joint or of an equality constraint over all steps; MuJoCo's joints
// are coordinates and have none.
#include <delassus/adapters/mjcf.hpp>
#include <delassus/adapters/posix.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/delassus.hpp>
#include <delassus/model/add.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/stabilisation/closed_joints.hpp>

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

using namespace delassus;

namespace {

struct Options {
  std::vector<std::string> files;
  double step = 5e-3, tolerance = 1e-6;
  int steps = 4000, runs = 3;
};

/// What one engine shows.
struct Figures {
  std::vector<double> times;  ///< of hundreds of steps in which the machine lies, s a step
  double depth[2] = {};       ///< m, of steps in which it falls and in which it lies
  double gap = 0;             ///< m
  double contacts = 0;        ///< their sum over the steps in which it lies
  int failed = 0;             ///< steps that did not converge
  double median() {
    std::nth_element(times.begin(), times.begin() + long(times.size() / 2), times.end());
    return times[times.size() / 2];
  }
};

/// Joints and what else such files say of them.
auto laws() {
  return Constraints{Contact{Coulomb{.friction = 0.8}},
                     Hinge{},
                     Slider{},
                     BallJoint{},
                     SerialJoint<0, 2>{},
                     SerialJoint<0, 3>{},
                     SerialJoint<1, 1>{},
                     SerialJoint<2, 0>{},
                     SerialJoint<2, 1>{},
                     Limit<Turn>{},
                     Limit<Slide>{},
                     Limit<Precession>{},
                     Limit<Nutation>{},
                     Limit<Spin>{},
                     SpringDamper<Turn>{},
                     SpringDamper<Slide>{},
                     SpringDamper<Precession>{},
                     SpringDamper<Nutation>{},
                     SpringDamper<Spin>{},
                     RotorInertia<Turn>{},
                     RotorInertia<Slide>{},
                     RotorInertia<Precession>{},
                     RotorInertia<Nutation>{},
                     RotorInertia<Spin>{},
                     Coupling<Turn, Turn>{},
                     Tendon<2>{},
                     TendonLimit<2>{}};
}

auto loop_of(const Options& options) {
  return AnimationLoop{World{RigidBodies{}}, laws(), WithFilter{WithCompounds{NativeCollision{}}},
                       DirectGaussSeidel{.tolerance = options.tolerance}, ClosedJoints{}};
}

class Ours {
 public:
  Ours(const std::string& file, const Options& options) : loop_(loop_of(options)) {
    const Model model = read_mjcf(file, {.files = {std::filesystem::path(file).parent_path().string()}});
    add(loop_, model, {}, Base::as_file, {.actuators = true, .surfaces = false});
    bodies<RigidBodies>(loop_.world()).gravity = model.gravity;
  }
  void step(double h) { report_ = loop_.step(h); }
  void note(Figures& to, bool lies) const {
    for (const ContactResult& c : loop_.contacts()) to.depth[lies] = std::max(to.depth[lies], -c.record.gap);
    to.gap = std::max(to.gap, report_.max_joint_violation);
    if (lies) to.contacts += report_.contacts;
    to.failed += report_.status != Status::converged;
  }

 private:
  decltype(loop_of({})) loop_;
  StepReport report_;
};

class Theirs {
 public:
  Theirs(const std::string& file, const Options& options) {
    char error[1000] = "";
    model_.reset(mj_loadXML(file.c_str(), nullptr, error, sizeof error));
    if (!model_) std::fprintf(stderr, "%s\n", error), std::exit(1);
    model_->opt.timestep = options.step;
    data_.reset(mj_makeData(model_.get()));
  }
  void step(double) { mj_step(model_.get(), data_.get()); }
  void note(Figures& to, bool lies) const {
    for (int k = 0; k < data_->ncon; ++k)
      to.depth[lies] = std::max(to.depth[lies], double(-data_->contact[k].dist));
    for (int k = 0; k < data_->nefc; ++k)
      if (data_->efc_type[k] == mjCNSTR_EQUALITY)
        to.gap = std::max(to.gap, std::abs(double(data_->efc_pos[k])));
    if (lies) to.contacts += data_->ncon;
  }

 private:
  std::unique_ptr<mjModel, void (*)(mjModel*)> model_{nullptr, mj_deleteModel};
  std::unique_ptr<mjData, void (*)(mjData*)> data_{nullptr, mj_deleteData};
};

constexpr int hundred = 100;

void make_hundred(auto& engine, double h, bool lies, Figures& figures) {
  double time = 0;
  for (int k = 0; k < hundred; ++k) {
    const double start = ThreadClock{}.now();
    engine.step(h);
    time += ThreadClock{}.now() - start;
    engine.note(figures, lies);
  }
  if (lies) figures.times.push_back(time / hundred);
}

void compare(const std::string& file, const Options& options) {
  Figures of[2];
  for (int run = 0; run < options.runs; ++run) {
    Ours ours(file, options);
    Theirs theirs(file, options);
    for (int n = 0; n < options.steps; n += hundred) {
      const bool lies = 2 * n >= options.steps;
      make_hundred(theirs, options.step, lies, of[1]);
      make_hundred(ours, options.step, lies, of[0]);
    }
  }
  const double steps = hundred * double(of[0].times.size()), ratio = of[0].median() / of[1].median();
  const std::string name = std::filesystem::path(file).stem().string();
  for (int k : {0, 1})
    std::printf("| %s | %s | %.1f | %.2f | %.1e | %.1e | %.1e | %.1f | %s |\n", name.c_str(),
                k == 0 ? "delassus" : (std::string("MuJoCo ") + mj_versionString()).c_str(),
                1e6 * of[k].median(), k == 0 ? ratio : 1.0, std::max(of[k].depth[0], of[k].depth[1]),
                of[k].depth[1], of[k].gap, of[k].contacts / steps,
                k == 0 ? std::to_string(of[k].failed).c_str() : "–");
}

}  // namespace

int main(int count, char** words) {
  Options options;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    const auto number = [&] { return k + 1 < count ? std::atof(words[++k]) : 0.0; };
    if (word == "--step")
      options.step = number();
    else if (word == "--steps")
      options.steps = std::max(2 * hundred, int(number()));
    else if (word == "--tolerance")
      options.tolerance = number();
    else if (word == "--runs")
      options.runs = std::max(1, int(number()));
    else
      options.files.push_back(word);
  }
  std::printf(
      "| machine | engine | time of a step, µs | ratio | depth, m | lying, m | gap, m | contacts | not "
      "converged |\n|---|---|--:|--:|--:|--:|--:|--:|--:|\n");
  try {
    for (const std::string& file : options.files) compare(file, options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compare_mujoco: %s\n", error.what());
    return 1;
  }
}
