// Friction problems of running scenes, as files for compare_siconos and fcp_solve:
//
//   scene_problems FOLDER [--scenes TEXT,...] [--check]
//
// Runs walls, piles, stacks, grips, arms and machines, and writes the problem of chosen steps, at least 0.2 s
// apart: SCENE-tMILLISECONDS.fcp. Takes five minutes. Problems of fewer than 20 or more than 3000 contacts
// are not written, nor of contacts that joints fix. Joints are taken out exactly: contacts_alone.hpp. The
// same build writes the same bytes.
//
// Each line has the error of the loop's own impulses, as the loop says it and in the problem as it is
// written. --check also solves each problem from these impulses to 1e-10, and says how far the velocities of
// its contacts move.
#include "contacts_alone.hpp"
#include "machine_scenes.hpp"

#include <delassus/core/clock.hpp>
#include <delassus/io/problem_file.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include <cstdio>
#include <filesystem>
#include <string>

using namespace delassus;
using namespace problems;

namespace {

constexpr Index fewest = 20, most = 3000;
constexpr double h = 1. / 120;

struct Options {
  std::filesystem::path folder;
  std::vector<std::string> scenes;
  bool check = false;
};

/// What was written, and the worst of it.
struct Total {
  int files = 0;
  double error = 0, apart = 0;
};

std::vector<Vec3> velocities(const FrictionProblem& p) {
  std::vector<Vec3> u;
  for (Index i = 0; i < p.rows.pool<0>().items(); ++i) u.push_back(p.W.residual<0>(p.rows, i));
  return u;
}

double norm(const std::vector<Vec3>& u) {
  double sum = 0;
  for (const Vec3& x : u) sum += x.squaredNorm();
  return std::sqrt(sum);
}

/// |u − u*| / |q| of the λ in p and of what a solve to 1e-10 makes of it.
double apart_from_solution(FrictionProblem p) {
  std::vector<Vec3> u = velocities(p);
  const SolveReport report = solve(p, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 20000});
  const std::vector<Vec3> other = velocities(p);
  for (std::size_t i = 0; i < u.size(); ++i) u[i] -= other[i];
  const double apart = norm(u) / norm({p.rows.pool<0>().d.begin(), p.rows.pool<0>().d.end()});
  if (report.status != Status::converged)
    std::printf(" (%s at %.1e)", name(report.status), report.measure.residual);
  return apart;
}

class Scenes {
 public:
  explicit Scenes(const Options& options) : o_(options) {}
  const Total& total() const { return total_; }

  /// Runs a scene of loose bodies; add(set) makes it.
  template <class Add>
  void loose(const std::string& scene, double friction, std::initializer_list<double> times, Add&& add) {
    if (!is_wanted(scene)) return;
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}}};
    add(bodies<RigidBodies>(loop.world()));
    run(scene, loop, times, {});
  }
  /// Runs a scene with joints; add(loop) makes it and says what leads it.
  template <class Add>
  void machine(const std::string& scene, double friction, std::initializer_list<double> times, Add&& add) {
    if (!is_wanted(scene)) return;
    auto loop = machine_loop(friction);
    const Guide guide = add(loop);
    run(scene, loop, times, guide);
  }

 private:
  bool is_wanted(const std::string& scene) const {
    for (const std::string& part : o_.scenes)
      if (scene.find(part) != std::string::npos) return true;
    return o_.scenes.empty();
  }

  void run(const std::string& scene, auto& loop, std::initializer_list<double> times, const Guide& guide) {
    int step = 0;
    const double begin = SteadyClock{}.now();
    for (const double time : times) {
      StepReport report;
      for (; step < int(std::lround(time / h)); ++step) {
        if (guide) guide(step * h);
        report = loop.step(h);
      }
      write(scene, step, loop, report);
    }
    std::printf("%-28s %5.1f s\n", scene.c_str(), SteadyClock{}.now() - begin);
    std::fflush(stdout);
  }

  void write(const std::string& scene, int step, const auto& loop, const StepReport& report) {
    char name[80];
    std::snprintf(name, sizeof name, "%s-t%04d", scene.c_str(), int(std::lround(1e3 * step * h)));
    const auto whole = loop.problem();
    const ContactsAlone alone(whole);
    FrictionProblem p = alone.problem();
    const Index n = p.rows.pool<0>().items();
    std::printf("%-28s %5d contacts, %s", name, int(n), delassus::name(report.status));
    if (n < fewest || n > most || !alone.are_free()) {
      std::printf(": not written\n");
      return;
    }
    const Measure m = solve(p, GaussSeidel{.max_iterations = 0, .min_iterations = 0}).measure;
    std::printf(" at %.1e, written %.1e", report.residual, m.residual);
    if (o_.check) {
      const double apart = apart_from_solution(p);
      total_.apart = std::max(total_.apart, apart);
      std::printf(", u off by %.1e", apart);
    }
    total_.error = std::max(total_.error, m.residual);
    ++total_.files;
    std::printf("\n");
    std::fflush(stdout);
    write_problem((o_.folder / (std::string(name) + ".fcp")).string(), p);
  }

  const Options& o_;
  Total total_;
};

void run_all(Scenes& s) {
  using Set = RigidBodies;
  s.loose("wall-4x4", 0.6, {0.3, 0.6, 1.2}, [](Set& b) { add_wall(b, 4, 4); });
  s.loose("wall-7x6", 0.5, {0.3, 0.6, 1.2}, [](Set& b) { add_wall(b, 7, 6); });
  s.loose("wall-10x10", 0.6, {0.25, 0.5, 0.8}, [](Set& b) { add_wall(b, 10, 10); });
  s.loose("wall-14x14", 0.6, {0.2, 0.5}, [](Set& b) { add_wall(b, 14, 14); });
  s.loose("balls-27", 0.3, {0.3, 0.8, 2}, [](Set& b) { add_balls(b, 3, 3); });
  s.loose("balls-100-heavy", 0.5, {0.3, 0.8, 1.2}, [](Set& b) { add_balls(b, 5, 4, 7); });
  s.loose("balls-343", 0.4, {0.3, 0.8}, [](Set& b) { add_balls(b, 7, 7); });
  s.loose("balls-1000", 0.4, {0.25, 0.5}, [](Set& b) { add_balls(b, 10, 10); });
  s.loose("boxes-12", 0.5, {0.5, 0.8, 1.5}, [](Set& b) { add_boxes(b, 12, 0.5); });
  s.loose("boxes-40", 0.7, {0.5, 1, 2}, [](Set& b) { add_boxes(b, 40, 0.75); });
  s.loose("boxes-120", 0.4, {0.5, 1, 1.6}, [](Set& b) { add_boxes(b, 120, 1); });
  s.loose("boxes-400", 0.5, {0.7, 1}, [](Set& b) { add_boxes(b, 400, 1.5); });
  s.loose("mixed-30", 0.4, {0.5, 1, 2}, [](Set& b) { add_mixed(b, 30, 0.7); });
  s.loose("mixed-100", 0.6, {0.5, 1, 1.6}, [](Set& b) { add_mixed(b, 100, 1); });
  s.loose("stack-6-light-below", 0.6, {0.2, 1}, [](Set& b) { add_stacks(b, 6, 1, 2); });
  s.loose("stack-10", 0.5, {0.2, 1}, [](Set& b) { add_stacks(b, 10, 1, 1); });
  s.loose("stacks-3x8", 0.5, {0.2, 1}, [](Set& b) { add_stacks(b, 8, 3, 1.2); });
  s.loose("pyramid-4", 0.5, {0.2, 1}, [](Set& b) { add_pyramid(b, 4); });
  s.loose("pyramid-12", 0.5, {0.2, 1}, [](Set& b) { add_pyramid(b, 12); });
  s.loose("pyramid-20", 0.5, {0.2}, [](Set& b) { add_pyramid(b, 20); });
  s.loose("cards-2", 0.5, {0.2, 1}, [](Set& b) { add_card_house(b, 2); });
  s.loose("cards-4", 0.4, {0.2, 1.2}, [](Set& b) { add_card_house(b, 4); });
  s.loose("arch-13", 0.7, {0.2, 0.6}, [](Set& b) { add_arch(b, 13, 4); });
  s.loose("slope-boxes", 0.42, {0.2}, [](Set& b) { add_slope(b, 6, 4, false); });
  s.loose("slope-stones", 0.6, {0.4, 1, 2}, [](Set& b) { add_slope(b, 8, 6, true); });
  s.loose("dominoes-20", 0.4, {0.5, 1.2, 2.5}, [](Set& b) { add_dominoes(b, 20); });
  s.loose("tower-8x10", 0.6, {0.2, 0.5, 0.8}, [](Set& b) { add_round_tower(b, 8, 10, 9); });
  s.loose("tower-14x16", 0.6, {0.2}, [](Set& b) { add_round_tower(b, 14, 16, 9); });
  s.loose("logs-6", 0.3, {0.3, 1}, [](Set& b) { add_logs(b, 6, 5); });
  s.loose("logs-16", 0.4, {0.3, 0.8}, [](Set& b) { add_logs(b, 16, 14); });
  s.loose("plough-60", 0.6, {0.5, 1.2, 1.8}, [](Set& b) { add_plough(b, 60); });
  s.loose("hopper-250", 0.5, {0.2, 0.5, 1}, [](Set& b) { add_hopper(b, 250, false); });
  s.loose("hopper-cubes-80", 0.4, {0.2, 0.5}, [](Set& b) { add_hopper(b, 80, true); });
  s.loose("plate-4x4", 0.3, {0.2, 0.6}, [](Set& b) { add_plate(b, 4, 9); });
  s.loose("books-9", 0.35, {0.3, 1}, [](Set& b) { add_books(b, 9); });

  s.machine("grip-5", 0.6, {0.3, 0.9}, [](MachineLoop& l) { return add_grip(l, 5, 60); });
  s.machine("grip-8", 0.9, {0.3, 0.9}, [](MachineLoop& l) { return add_grip(l, 8, 150); });
  s.machine("jaws-60", 0.4, {0.4, 0.9, 1.4}, [](MachineLoop& l) { return add_jaws(l, 60); });
  s.machine("arm-20", 0.5, {0.3, 0.7, 1.1}, [](MachineLoop& l) { return add_arm(l, 20); });
  s.machine("chains-3x20", 0.4, {0.5, 1}, [](MachineLoop& l) { return add_chains(l, 3, 20); });
  s.machine("ragdolls-5", 0.5, {0.8, 1.5, 2.5}, [](MachineLoop& l) { return add_ragdolls(l, 5); });
  s.machine("rollers-14", 0.4, {0.3, 0.9, 1.4}, [](MachineLoop& l) { return add_rollers(l, 14, 10); });
  s.machine("mixer-60", 0.5, {0.8, 1.2}, [](MachineLoop& l) { return add_mixer(l, 60, 0.7); });
  s.machine("bridge-10", 0.6, {0.3, 0.8, 1.4}, [](MachineLoop& l) { return add_bridge(l, 10, 10); });
  s.machine("press-50", 0.4, {0.4, 0.8, 1.2}, [](MachineLoop& l) { return add_press(l, 50, 0.55); });
  s.machine("cart-12", 0.6, {0.3, 0.9, 1.6}, [](MachineLoop& l) { return add_cart(l, 12); });
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

Options parse(int count, char** words) {
  Options o;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    if (word == "--check") {
      o.check = true;
    } else if (word == "--scenes") {
      DELASSUS_EXPECT(k + 1 < count, "--scenes needs a value");
      o.scenes = split(words[++k]);
    } else {
      DELASSUS_EXPECT(word.rfind("--", 0) != 0 && o.folder.empty(),
                      "scene_problems: what is '" + word + "'? Name one folder");
      o.folder = word;
    }
  }
  DELASSUS_EXPECT(!o.folder.empty(), "scene_problems: name the folder that the problems go to");
  std::filesystem::create_directories(o.folder);
  return o;
}

}  // namespace

int main(int count, char** words) try {
  const Options o = parse(count, words);
  Scenes scenes(o);
  run_all(scenes);
  std::printf("%d problems in %s; the largest error of a loop's impulses %.1e", scenes.total().files,
              o.folder.c_str(), scenes.total().error);
  if (o.check) std::printf(", of velocities %.1e", scenes.total().apart);
  std::printf("\n");
  return 0;
} catch (const InvalidArgument& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
