// Takes a folder, and names of figures if not all are meant. Draws
// docs/evidence/figures/{euler_top,pendulum,pendulum_2000, double_pendulum,double_pendulum_energy,squeezer}.svg and
// writes their .csv: error against processor time, one colour an integrator, the step halved from mark to
// mark. The scenes are those of the tests. From the root of the tree:
//
//   g++ -std=c++20 -O3 -DNDEBUG -Iinclude -Itests -isystem /usr/include/eigen3 docs/evidence/figures/integrators.cpp
//   -o integrators && ./integrators docs/evidence/figures
#include "loop/chains.hpp"
#include "loop/smooth_scenes.hpp"
#include "loop/squeezer.hpp"

#include <delassus/io/csv.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>
#include <delassus/study/diagram.hpp>
#include <delassus/study/sweep.hpp>
#include <delassus/study/tables.hpp>

#include <algorithm>
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

using namespace delassus;

namespace {

/// h = first, first/2, …
std::vector<double> halved(double first, int count) {
  std::vector<double> steps;
  for (int k = 0; k < count; ++k, first /= 2) steps.push_back(first);
  return steps;
}

/// The folder, and the figures that are meant.
struct Wanted {
  std::string folder;
  std::vector<std::string> figures;

  bool has(const std::string& file) const {
    return figures.empty() || std::find(figures.begin(), figures.end(), file) != figures.end();
  }
};

template <class Scene, class List, class M>
void draw(const Wanted& wanted, const std::string& file, const Scene& scene, const List& list, StudyPlan plan,
          const M& measures) {
  if (!wanted.has(file)) return;
  plan.max_seconds = 20;
  const Study study = sweep(scene, list, plan, measures);
  write_diagram(wanted.folder + "/" + file + ".svg", study, {.joins_steps = true});
  write_csv(wanted.folder + "/" + file + ".csv", runs_table(study));
}

/// The parts that one-solve integrators need beside them: gaps closed, and the solve taken to rounding.
template <class Make, class Integrator, class Solver = GaussSeidel>
auto with_solver(const Make& make, Integrator integrator,
                 Solver solver = {.tolerance = 1e-12, .max_iterations = 500}) {
  using Gaps =
      std::conditional_t<std::is_same_v<Integrator, ImplicitMidpoint>, PositionProjection, WholeViolation>;
  Gaps gaps;
  if constexpr (requires { gaps.rate; }) gaps.rate = 1;
  return make(integrator, gaps, solver);
}

auto place_of_end() {
  return [](const auto& loop) { return smooth::end_of(loop); };
}
/// `start` at 0, `end` at the end: what lies between is not compared.
auto from_to(const Vec3& start, const Vec3& end) {
  return [=](double t) { return t > 0 ? end : start; };
}

}  // namespace

int main(int count, char** names) {
  const Wanted folder{count > 1 ? names[1] : ".", {names + std::min(count, 2), names + count}};

  const auto top = [](auto integrator) {
    AnimationLoop loop{World{RigidBodies{}}, integrator};
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    set.add({.angular_velocity = {1, 1, 1}, .mass = 1.0, .inertia = Mat3(Vec3(1, 2, 3).asDiagonal())});
    return loop;
  };
  const auto orientation = [](const auto& loop) {
    const auto& set = loop.world().template set<0>();
    return set.orientation(set.handle(0));
  };
  const auto jacobi = [](double t) {
    return t > 0 ? Quat(0.46254544055464281993, -0.31433514514460551582, 0.049429631279299836969,
                        0.8275275484844136788)
                 : Quat::Identity();
  };
  draw(folder, "euler_top", top, Combinations{Choices{SymplecticEuler{}, LiePoisson{}, RungeKutta4{}}},
       {.name = "Euler top (AC-04)", .call = "top", .duration = 10, .steps = halved(0.1, 11), .outputs = 1},
       Measures{Compared{"orientation at 10 s", "rad", orientation, jacobi, AngleBetween{}}});

  const auto pendulum = [](auto integrator) {
    using I = decltype(integrator);
    if constexpr (std::is_same_v<I, NewtonMidpoint>) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, integrator};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto bob =
          set.add({.position = {1, 0, 0}, .mass = 1.0, .inertia = Mat3(1e-9 * Mat3::Identity())});
      loop.add(BallJoint::Item{anchor(set, bob, {-1, 0, 0}), world_anchor(Vec3::Zero())});
      return loop;
    } else {
      return with_solver([](auto... policies) { return smooth::pendulum(policies...); }, integrator);
    }
  };
  const Choices all{SymplecticEuler{}, ImplicitMidpoint{}, NewtonMidpoint{}, Rattle{}, RungeKutta4{}};
  draw(folder, "pendulum", pendulum, Combinations{all},
       {.name = "Pendulum (AC-08)",
        .call = "pendulum",
        .duration = 10,
        .steps = halved(0.04, 9),
        .outputs = 1},
       Measures{
           Compared{"place at 10 s", "m", place_of_end(), from_to({1, 0, 0}, smooth::pendulum_at_ten())}});
  draw(folder, "pendulum_2000", pendulum, Combinations{all},
       {.name = "Pendulum for 2000 s (AC-08)",
        .call = "pendulum",
        .duration = 2000,
        .steps = halved(0.02, 7),
        .outputs = 4000,
        .repeats = 1},
       Measures{Compared{"place, the worst of 4000", "m", place_of_end(), smooth::pendulum_at}});

  const auto twice = [](auto integrator) {
    if constexpr (std::is_same_v<decltype(integrator), NewtonMidpoint>)
      return chains::double_pendulum(integrator);
    else
      return with_solver([](auto... policies) { return smooth::double_pendulum(policies...); }, integrator);
  };
  draw(folder, "double_pendulum", twice, Combinations{all},
       {.name = "Double pendulum (AC-10)",
        .call = "twice",
        .duration = 1,
        .steps = halved(0.01, 9),
        .outputs = 1},
       Measures{Compared{"place at 1 s", "m", place_of_end(),
                         from_to({2, 0, 0}, chains::double_pendulum_at_one())}});
  draw(folder, "double_pendulum_energy", twice, Combinations{all},
       {.name = "Energy of a double pendulum for 100 s (AC-10)",
        .call = "twice",
        .duration = 100,
        .steps = halved(0.01, 7),
        .outputs = 1000,
        .repeats = 1},
       Measures{
           Kept{"energy, the worst of 1000", "J", [](const auto& loop) { return smooth::energy(loop); }}});

  const auto mechanism = [](auto integrator) {
    return with_solver([](auto... policies) { return squeezer::make(policies...); }, integrator,
                       DirectGaussSeidel{.tolerance = 1e-10});
  };
  const auto rod = [](const auto& loop) { return loop.world().template set<0>().pose(1).position; };
  draw(folder, "squeezer", mechanism, Combinations{all},
       {.name = "Andrews' squeezing mechanism (AC-12)",
        .call = "mechanism",
        .duration = 0.03,
        .steps = halved(1e-4, 8),
        .outputs = 1},
       Measures{Compared{"place of the rod at 30 ms", "m", rod,
                         from_to(squeezer::centre_of_rod(squeezer::at_start),
                                 squeezer::centre_of_rod(squeezer::at_30_ms))}});
}
