// HC-01, HC-02, HC-05: heavy on light.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/solvers/proximal_newton.hpp>

namespace ladders {

namespace {

/// A box of 1 kg under one of r kg, for 20 s.
template <class Solver>
void climb_pair(Ladder& ladder, const Solver& solver) {
  double easiest = 0;
  for (int power = 1; power <= 8; ++power)
    ladder.rung(format("r = 1e%d", power), [&]() -> Marks {
      const double r = std::pow(10., power);
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, solver};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto ground = set.add_fixed(HalfSpace{});
      set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
      set.add({.position = {0, 0, 1.5}, .mass = r, .shape = Box{1, 1, 1}});
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 2 : 20, frame);
      const double weight = (1 + r) * g;
      if (power == 1) easiest = seen.sweeps;
      return {{"penetration / size", seen.penetration, 1e-2, 1e-3},
              {"speed at the end (m/s)", top_speed(loop), 1e-3, 1e-3},
              {"error of the ground's force", std::abs(force_from(loop, ground.index) / weight - 1),
               unbounded, 1e-4},
              {"work / work at r = 10", seen.sweeps / easiest, unbounded, 2},
              {"steps not converged", double(seen.unconverged), unbounded, 0},
              energy_mark(seen, weight)};
    });
}

/// Ten layers of a pyramid of unit boxes with a top that is `ratio` times heavier, or a box of 20 m on two of
/// 1 m.
template <class Solver>
void climb_big_on_small(Ladder& ladder, const Solver& solver) {
  for (const int ratio : {10, 100, 200, 300, 400})
    ladder.rung(
        ratio == 400 ? "20 m box on two of 1 m, 400 ×" : format("pyramid of 10 rows, top %d ×", ratio),
        [&]() -> Marks {
          AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.6}}}, solver};
          auto& set = bodies<RigidBodies>(loop.world());
          set.add_fixed(HalfSpace{});
          RigidBodies::Handle top;
          double height = 0, mass = 0;
          if (ratio == 400) {
            for (const double x : {-9., 9.})
              set.add({.position = {x, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
            top = set.add({.position = {0, 0, 11}, .mass = 400.0, .shape = Box{20, 20, 20}});
            height = 1, mass = 402;
          } else {
            for (int row = 0; row < 10; ++row)
              for (int k = 0; k < 10 - row; ++k) {
                const double m = row == 9 ? ratio : 1;
                top = set.add(
                    {.position = {1.02 * (k + 0.5 * row), 0, 0.5 + row}, .mass = m, .shape = Box{1, 1, 1}});
                mass += m;
              }
            height = 1;
          }
          const Vec3 start = set.position(top);
          const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.5 : 20, frame);
          return {{"drop of the top / height of a box", (start - set.position(top)).z() / height, 0.05, 0.05},
                  {"penetration / size", seen.penetration, unbounded, 5e-3},
                  {"drift of the top (m)", (start - set.position(top)).norm(), unbounded, 1e-3},
                  energy_mark(seen, mass * g)};
        });
}

}  // namespace

void mass_ratio(Ladder& ladder) { climb_pair(ladder, AcceleratedGaussSeidel{}); }
// λ of 1e8 kg rounds what 1 kg moves by to 1e-7 of it: the tolerance is that of the sweeps above.
void mass_ratio_newton(Ladder& ladder) { climb_pair(ladder, ProximalNewton{.tolerance = 1e-6}); }
void big_on_small(Ladder& ladder) { climb_big_on_small(ladder, AcceleratedGaussSeidel{}); }
void big_on_small_newton(Ladder& ladder) { climb_big_on_small(ladder, ProximalNewton{}); }

// Three spheres on each other; the heavy one on top is taken away at t = 2 s.
void warm_start_energy(Ladder& ladder) {
  for (const double ratio : {1., 10., 100., 1e3, 1e4})
    ladder.rung(format("top %g ×", ratio), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.5}});
      const auto second = set.add({.position = {0, 0, 1.5}, .mass = 1.0, .shape = Sphere{0.5}});
      const auto top = set.add({.position = {0, 0, 2.5}, .mass = ratio, .shape = Sphere{0.5}});
      const Seen loaded = run(ladder, loop, 2, frame);
      loop.remove(top);
      const double rest = set.position(second).z();
      double rise = 0;
      const Seen free =
          run(ladder, loop, 1, frame, [&](int) { rise = most(rise, set.position(second).z() - rest); });
      return {{"rise / diameter", rise, 0.05, 1e-6},
              {"penetration / size", std::max(loaded.penetration, free.penetration), unbounded, unbounded},
              energy_mark(free, 2 * g)};
    });
}

}  // namespace ladders
