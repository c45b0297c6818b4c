/// Scenes of the table of acceptance that every collision backend must pass in a loop: docs/evidence/collision.md
/// lists them.
#pragma once

#include "catch.hpp"
#include "scenes.hpp"

#include <cstdlib>

namespace scenes {

/// Whether the long runs are asked for: DELASSUS_STACKS in the environment.
inline bool is_full_length() { return std::getenv("DELASSUS_STACKS") != nullptr; }

enum class Bricks { boxes, cubes_of_points, cylinders, mixed };

inline Shape brick(Bricks kind, int place) {
  static const ConvexHull cube = cube_of_points();
  if (kind == Bricks::boxes || (kind == Bricks::mixed && place % 3 == 0)) return Box{1, 1, 1};
  if (kind == Bricks::cubes_of_points || (kind == Bricks::mixed && place % 3 == 1)) return cube;
  return Cylinder{0.5, 1};
}

/// What a stack did, the worst of its bodies.
struct Stood {
  double drift = 0;           ///< from where it was set down, m
  double tilt = 0;            ///< degrees
  double kinetic_energy = 0;  ///< largest of the last half second, J
  int sweeps = 0;             ///< most of a step
  int last_sweeps = 0;        ///< most of a step of the last half second
  int unconverged = 0;
};

/// `count` bodies of unit height and mass on a floor, μ = 0.5, dt = 1/60 s, plain Gauss-Seidel with as many
/// sweeps as 1e-6 takes. Each is set down without a gap, 1 mm off the one below at most.
template <class Backend>
Stood stand(Bricks kind, int count, double seconds) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Backend{},
                     GaussSeidel{.tolerance = 1e-6, .max_iterations = 1000000}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(Box{20, 20, 1}, {0, 0, -0.5});
  std::minstd_rand random(7);
  std::uniform_real_distribution<double> off(-1e-3, 1e-3);
  std::vector<RigidBodies::Handle> stack;
  std::vector<Vec3> start;
  for (int i = 0; i < count; ++i) {
    const double x = off(random), y = off(random);
    start.push_back({x, y, 0.5 + i});
    stack.push_back(set.add({.position = start.back(), .mass = 1.0, .shape = brick(kind, i)}));
  }
  Stood seen;
  const int steps = int(std::lround(60 * seconds));
  for (int n = 0; n < steps; ++n) {
    const StepReport report = loop.step(1.0 / 60);
    seen.sweeps = std::max(seen.sweeps, int(report.sweeps));
    seen.unconverged += report.status == Status::converged ? 0 : 1;
    if (n + 30 >= steps) {
      seen.kinetic_energy = std::max(seen.kinetic_energy, kinetic_energy(set));
      seen.last_sweeps = std::max(seen.last_sweeps, int(report.sweeps));
    }
    for (int i = 0; i < count; ++i) {
      const Vec3 up = set.orientation(stack[i]).toRotationMatrix().col(2);
      seen.drift = std::max(seen.drift, (set.position(stack[i]) - start[i]).norm());
      seen.tilt = std::max(seen.tilt, std::atan2(std::hypot(up[0], up[1]), up[2]) * 180 / M_PI);
    }
  }
  return seen;
}

/// 5 and 10 of a kind for 20 s each where DELASSUS_STACKS is set; else 5 of each for half a second, and 10
/// mixed ones. The figures are those of the table.
template <class Backend>
void check_stacks(const char* backend) {
  for (const Bricks kind : {Bricks::boxes, Bricks::cubes_of_points, Bricks::cylinders, Bricks::mixed})
    for (const int count : {5, 10}) {
      if (count == 10 && kind != Bricks::mixed && !is_full_length()) continue;
      const Stood seen = stand<Backend>(kind, count, is_full_length() ? 20 : 0.5);
      CAPTURE(backend, int(kind), count, seen.drift, seen.tilt, seen.kinetic_energy, seen.sweeps,
              seen.last_sweeps);
      if (is_full_length())
        WARN(backend << ", kind " << int(kind) << ", " << count << " high: drift " << seen.drift
                     << " m, tilt " << seen.tilt << " degrees, energy " << seen.kinetic_energy
                     << " J, sweeps " << seen.sweeps << ", at the end " << seen.last_sweeps);
      CHECK(seen.unconverged == 0);
      CHECK(seen.drift < 1e-3);
      CHECK(seen.tilt < 0.05);
      CHECK(seen.kinetic_energy < 1e-8);
    }
}

/// 5 + 4 + 3 + 2 + 1 boxes, each over the gap between two.
template <class Backend>
void check_pyramid() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Backend{},
                     GaussSeidel{.tolerance = 1e-6, .max_iterations = 20000}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(Box{20, 20, 1}, {0, 0, -0.5});
  std::vector<Vec3> start;
  std::vector<RigidBodies::Handle> bricks;
  for (int row = 0; row < 5; ++row)
    for (int i = 0; i < 5 - row; ++i) {
      start.push_back({1.1 * (i + 0.5 * row), 0, 0.5 + row});
      bricks.push_back(set.add({.position = start.back(), .mass = 1.0, .shape = Box{1, 1, 1}}));
    }
  for (int n = 0; n < (is_full_length() ? 1200 : 120); ++n) loop.step(1.0 / 60);
  for (std::size_t i = 0; i < bricks.size(); ++i) CHECK((set.position(bricks[i]) - start[i]).norm() < 1e-3);
  CHECK(kinetic_energy(set) < 1e-8);
}

/// A body created exactly touching the floor: after a step under its weight, and after thirty, it is where it
/// was. What the solver leaves of a step is 1e-6 of the free velocity h g: 1.6e-7 m/s, 3e-9 m a step and less
/// than 1e-7 m in thirty; a jump by the push-out of 1 m/s would be 1.6e-2 m in the first. What stands on a
/// point and would fall is looked at for two steps.
template <class Backend>
void check_no_jump() {
  static const ConvexHull cube = cube_of_points();
  const Mat3 upright = Mat3::Identity(),
             lying = Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()).toRotationMatrix();
  struct Row {
    Shape shape;
    Mat3 rotation;
    int steps = 30;
  };
  const std::vector<Row> rows{{Sphere{0.4}, upright},
                              {Box{1, 0.6, 0.8}, upright},
                              {Capsule{0.25, 0.8}, upright, 2},
                              {Capsule{0.25, 0.8}, lying},
                              {Cylinder{0.35, 0.8}, upright},
                              {Cylinder{0.35, 0.8}, lying},
                              {Cone{0.4, 0.9}, upright},
                              {cube, upright},
                              {Ellipsoid{0.5, 0.3, 0.4}, upright, 2}};
  for (const Shape& floor : {Shape(Box{20, 20, 1}), Shape(Cylinder{8, 1}), Shape(HalfSpace{{0, 0, 1}, 0.5})})
    for (const Row& row : rows)
      for (const double height : {0.0, 3.7}) {  // in the world; 3.7 is no sum of halves
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, Backend{},
                           GaussSeidel{.tolerance = 1e-6, .max_iterations = 20000}};
        auto& set = rigid_bodies(loop);
        set.add_fixed(floor, {0, 0, height});
        const double low = (row.rotation * support(row.shape, Vec3(-row.rotation.row(2).transpose())))[2];
        const Vec3 start(0.1, 0.2, height + 0.5 - low);
        const auto body =
            set.add({.position = start, .orientation = Quat(row.rotation), .mass = 1.0, .shape = row.shape});
        for (int n = 0; n < row.steps; ++n) {
          loop.step(1.0 / 60);
          CAPTURE(name(floor.kind), name(row.shape.kind), height, n);
          REQUIRE((set.position(body) - start).norm() < 1e-7);
        }
      }
}

/// A box on a box that leans by 30°, whose tangent is 0.577: with 0.6 it stays, with 0.55 it goes.
template <class Backend>
void check_slope() {
  for (const double friction : {0.6, 0.55}) {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}}, Backend{},
                       GaussSeidel{.tolerance = 1e-9, .max_iterations = 20000}};
    auto& set = rigid_bodies(loop);
    const Quat lean(Eigen::AngleAxisd(M_PI / 6, Vec3::UnitY()));
    set.add_fixed(Box{40, 40, 1}, lean * Vec3(0, 0, -0.5), lean);
    const auto block = set.add(
        {.position = lean * Vec3(0, 0, 0.25), .orientation = lean, .mass = 1.0, .shape = Box{1, 1, 0.5}});
    for (int n = 0; n < 120; ++n) loop.step(1.0 / 60);
    const Vec3 at = set.position(block);
    for (int n = 0; n < 120; ++n) loop.step(1.0 / 60);
    const double way = (set.position(block) - at).norm();
    CAPTURE(friction, way);
    // v = g (sin 30° − 0.55 cos 30°) t, so 6 t² · 0.116 m in the third and fourth second: 1.39 m, first order
    // in h.
    if (friction > 0.577)
      CHECK(way / 2 < 1e-6);
    else
      CHECK(way == Approx(0.5 * g * (0.5 - 0.55 * std::sqrt(0.75)) * (16 - 4)).epsilon(0.02));
  }
}

}  // namespace scenes
