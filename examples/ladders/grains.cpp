// HC-30, HC-37: heaps, hoppers and silos of grains; crowds, and a box that is too small.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/solvers/proximal_newton.hpp>
#include <delassus/stabilisation/with_compliance.hpp>

#include <numbers>
#include <utility>
#include <vector>

namespace ladders {

namespace {

/// Spheres poured into a box without a lid.
void pour(Ladder& ladder, const AcceleratedGaussSeidel& solver) {
  for (const int count : {64, 216, 512, 1000})
    ladder.rung(format("%d spheres", count), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}}, solver};
      auto& set = bodies<RigidBodies>(loop.world());
      const int edge = int(std::lround(std::cbrt(count)));
      set.add_fixed(HalfSpace{});
      for (int axis = 0; axis < 2; ++axis)
        for (const double side : {-1., 1.}) {
          const Vec3 n = -side * unit_axis(axis);
          set.add_fixed(HalfSpace{n}, 0.11 * edge * side * unit_axis(axis));
        }
      for (int i = 0; i < count; ++i) {
        const Vec3 cell(i % edge, i / edge % edge, i / edge / edge);
        const double wobble = 0.008 * std::sin(12.9 * i);
        set.add({.position = 0.22 * (cell - 0.5 * (edge - 1) * Vec3(1, 1, 0)) + Vec3(wobble, -wobble, 0.12),
                 .mass = 1.0,
                 .shape = Sphere{0.1}});
      }
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 1 : 5, frame);
      return {{"mean overlap / diameter", seen.last_overlap / 0.2, 0.01, 1e-3},
              {"largest overlap at the end / diameter", seen.last_penetration / 0.2, 0.1, 0.01},
              {"largest overlap of the run / diameter", seen.penetration / 0.2, unbounded, unbounded},
              energy_mark(seen, count * g * 0.11 * edge)};
    });
}

}  // namespace

void heap(Ladder& ladder) { pour(ladder, {.tolerance = 1e-5}); }
void heap_loose(Ladder& ladder) { pour(ladder, {.tolerance = 1e-3, .max_iterations = 300}); }

// Spheres on a plane that all want to the middle.
template <class... Policies>
void crowd(Ladder& ladder, const Policies&... policies) {
  for (const int edge : {5, 10, 20})
    ladder.rung(format("%d spheres", edge * edge), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      std::vector<RigidBodies::Handle> all;
      for (int i = 0; i < edge; ++i)
        for (int k = 0; k < edge; ++k)
          all.push_back(
              set.add({.position = {0.3 * (i - 0.5 * (edge - 1)), 0.3 * (k - 0.5 * (edge - 1)), 0.1},
                       .mass = 1.0,
                       .shape = Sphere{0.1}}));
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.2 : 10, frame, [&](int) {
        for (const auto& body : all) {
          const Vec3 x = set.position(body);
          set.apply_force(body, -10 * Vec3(x.x(), x.y(), 0) / std::max(1e-3, std::hypot(x.x(), x.y())));
        }
      });
      double square = 0;
      for (const auto& body : all) square += set.velocity(body).squaredNorm() / double(all.size());
      return {{"rms speed at the end (m/s)", std::sqrt(square), ladder.is_quick() ? 10 : 0.1,
               ladder.is_quick() ? 10 : 1e-3},
              {"largest overlap / diameter", seen.penetration / 0.2, 0.1, 0.01}};
    });
}
void crowding(Ladder& ladder) { crowd(ladder, ProximalNewton{}); }
// Spheres that come in at 7 m/s go half a diameter in a step: a margin as wide lets none in unseen.
void crowding_foreseen(Ladder& ladder) {
  crowd(ladder, AcceleratedGaussSeidel{.tolerance = 1e-3, .max_iterations = 300},
        NativeCollision{.margin = 0.1});
}

namespace {

/// Discs of a metre in a square box without gravity, in rows that fit its walls: their area is 18 % more than
/// the box's, so that their constraints contradict each other. They are spheres without friction: nothing
/// pushes them out of their plane. A turn or mirror of the box is one of the scene's; the rows are an
/// equilibrium that may buckle.
template <class... Policies>
void confine(Ladder& ladder, const Policies&... policies) {
  for (const int edge : {5, 10, 25})
    ladder.rung(format("%d discs, 18 %% over-full", edge * edge), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      const double size = edge * std::sqrt(std::numbers::pi / 4 / 1.18);
      for (int axis = 0; axis < 2; ++axis)
        for (const double side : {-1., 1.}) {
          const Vec3 n = -side * unit_axis(axis);
          set.add_fixed(HalfSpace{n}, 0.5 * size * side * unit_axis(axis));
        }
      std::vector<RigidBodies::Handle> all;
      for (int i = 0; i < edge * edge; ++i) {
        const Vec3 cell(i % edge - 0.5 * (edge - 1), i / edge - 0.5 * (edge - 1), 0);
        all.push_back(set.add({.position = size / edge * cell, .mass = 1.0, .shape = Sphere{0.5}}));
      }
      std::vector<Vec3> before(all.size(), Vec3::Zero());
      double way = 0;
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 2 : 10, frame, [&](int) {
        way = 0;
        for (std::size_t k = 0; k < all.size(); ++k) {
          const Vec3 at = set.position(all[k]);
          way += (at - std::exchange(before[k], at)).squaredNorm() / (frame * frame) / double(all.size());
        }
      });
      double square = 0, off = 0, out = 0;
      for (int i = 0; i < edge * edge; ++i) {
        const int x = i % edge, y = i / edge, far = edge - 1;
        const Vec3 at = set.position(all[i]);
        square += set.velocity(all[i]).squaredNorm() / double(all.size());
        out = most(out, std::abs(at.z()));
        const Vec3 mirrored = set.position(all[far - x + edge * y]),
                   turned = set.position(all[far - y + edge * x]);
        off = most(off, (mirrored - Vec3(-at.x(), at.y(), 0)).norm());
        off = most(off, (turned - Vec3(-at.y(), at.x(), 0)).norm());
      }
      return {{"rms speed at the end (m/s)", std::sqrt(square), 0.1, 1e-3},
              {"rms way a second at the end (m/s)", std::sqrt(way), 0.1, 1e-3},
              {"asymmetry at the end / diameter", off, unbounded, 0.01},
              {"out of the plane (m)", out, 1e-3, 1e-9},
              {"largest overlap at the end / diameter", seen.last_penetration, unbounded, unbounded}};
    });
}

}  // namespace

void confined(Ladder& ladder) {
  confine(ladder, AcceleratedGaussSeidel{.tolerance = 1e-3, .max_iterations = 300});
}
void confined_soft(Ladder& ladder) { confine(ladder, SoftContact{}); }
void confined_yielding(Ladder& ladder) { confine(ladder, WithCompliance{Baumgarte{}, 1e-5}); }

}  // namespace ladders
