// HC-18, HC-24, HC-25: bullets, elastic balls, impacts at one moment.
#include "rows.hpp"
#include "watch.hpp"


namespace ladders {

// A ball of 1 cm flies at a plate of 1 mm, at 60 steps a second.
void bullet(Ladder& ladder) {
  for (const double speed : {0.1, 1., 10., 100., 300., 1000.})
    ladder.rung(format("%g m/s", speed), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      set.add_fixed(Box{0.001, 10, 10});
      int through = 0;
      for (const double phase : {0.1, 0.35, 0.6, 0.85})
        set.add({.position = {-(2 + phase) * speed * frame - 0.1, 10 * phase - 5, 0},
                 .velocity = {speed, 0, 0},
                 .mass = 0.01,
                 .shape = Sphere{0.005}});
      const Seen seen = run(ladder, loop, 0.5 + 0.2 / speed, frame);
      for (const Index b : alive(set)) through += set.moves(b) && set.pose(b).position.x() > 0;
      return {{"through the plate, of 4", double(through), 0, 0},
              energy_mark(seen, 4 * 0.005 * speed * speed)};
    });
}

// Balls of 0.1 m and 10 kg in a closed box, elastic and without friction.
void elastic_balls(Ladder& ladder) {
  struct Case {
    int edge;
    double h, seconds;
  };
  for (const auto& [edge, h, seconds] :
       {Case{2, 1e-2, 60}, {3, 1e-2, 60}, {6, 1e-2, 60}, {6, 1e-3, 10}, {10, 1e-2, 60}})
    ladder.rung(format("%d balls, h = %g s", edge * edge * edge, h), [&, edge = edge, h = h, seconds = seconds]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Frictionless{}, 1}}}};
      auto& set = bodies<RigidBodies>(loop.world());
      const double size = 0.4 * edge;
      for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1., 1.}) {
          const Vec3 n = -side * unit_axis(axis);
          set.add_fixed(HalfSpace{n}, 0.5 * size * side * unit_axis(axis));
        }
      unsigned state = 42;
      const auto draw = [&] { return (state = state * 1664525u + 1013904223u) / 4294967296. - 0.5; };
      for (int i = 0; i < edge * edge * edge; ++i) {
        const Vec3 cell(i % edge, i / edge % edge, i / edge / edge);
        const double x = draw(), y = draw(), z = draw();
        set.add({.position = 0.4 * (cell - 0.5 * (edge - 1) * Vec3(1, 1, 1)) + 0.1 * Vec3(x, y, z),
                 .velocity = 4 * Vec3(y, z, x),
                 .mass = 10.0,
                 .shape = Sphere{0.1}});
      }
      set.gravity.setZero();
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 5 : seconds, h);
      return {{"energy gained", seen.gain / seen.first_energy, 0.02, 1e-6, 1},
              {"energy lost", 1 - seen.last_energy / seen.first_energy, 0.02, 1e-6}};
    });
}

// A row of equal balls, hit by one; a box that lands flat; three balls from both sides at once.
void simultaneous(Ladder& ladder) {
  for (const int balls : {2, 3, 5, 10})
    ladder.rung(format("%d balls that touch, hit by one", balls), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Frictionless{}, 1}}},
                         AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 5000}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      for (int k = 0; k < balls; ++k)
        set.add({.position = {double(k), 0, 0}, .mass = 1.0, .shape = Sphere{0.5}});
      set.add({.position = {-1.05, 0, 0}, .velocity = {1, 0, 0}, .mass = 1.0, .shape = Sphere{0.5}});
      const Seen seen = run(ladder, loop, 0.2, 0.01);
      return {{"momentum", std::abs(momentum(set).x() - 1), 1e-9, 1e-12},
              {"energy gained", seen.gain / seen.first_energy, 1e-9, 1e-12, 1}};
    });
  for (const double e : {0., 0.5, 1.})
    ladder.rung(format("box lands flat, e = %g", e), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Coulomb{.friction = 0.5}, e}}},
                         AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 5000}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      const auto box = set.add({.position = {0, 0, 1}, .mass = 1.0, .shape = Box{1, 1, 1}});
      double turn = 0;
      const Seen seen = run(ladder, loop, 1, 1e-3, [&](int) {
        turn = most(turn, set.angular_velocity(box).norm());
        turn = most(turn, set.velocity(box).head<2>().norm());
      });
      return {{"turn and drift (1/s)", turn, 1e-3, 1e-12}, energy_mark(seen, g * 0.5)};
    });
  // Fifteen balls in a triangle, all touching, and one that comes in along its axis: left and right must be
  // alike.
  for (const double e : {0.5, 1.})
    ladder.rung(format("billiards, e = %g", e), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Frictionless{}, e}}},
                         AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 5000}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      std::vector<std::pair<RigidBodies::Handle, RigidBodies::Handle>> pairs;
      for (int row = 0; row < 5; ++row) {
        std::vector<RigidBodies::Handle> balls;
        for (int k = 0; k <= row; ++k)
          balls.push_back(set.add(
              {.position = {std::sqrt(0.75) * row, k - 0.5 * row, 0}, .mass = 1.0, .shape = Sphere{0.5}}));
        for (int k = 0; k <= row; ++k) pairs.emplace_back(balls[std::size_t(k)], balls[std::size_t(row - k)]);
      }
      set.add({.position = {-1.05, 0, 0}, .velocity = {1, 0, 0}, .mass = 1.0, .shape = Sphere{0.5}});
      const Seen seen = run(ladder, loop, 2, 0.01);
      double unlike = 0;
      for (const auto& [left, right] : pairs)
        unlike = most(unlike,
                      (set.velocity(left) - Vec3(set.velocity(right).cwiseProduct(Vec3(1, -1, 1)))).norm());
      return {{"left against right (m/s)", unlike, 1e-3, 1e-12},
              {"momentum", std::abs(momentum(set).x() - 1), 1e-9, 1e-12},
              {"energy gained", seen.gain / seen.first_energy, 1e-9, 1e-12, 1}};
    });
  ladder.rung("two balls hit a third from both sides", [&]() -> Marks {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Restitution{Frictionless{}, 1}}}};
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    const auto middle = set.add({.mass = 1.0, .shape = Sphere{0.5}});
    for (const double side : {-1., 1.})
      set.add(
          {.position = {1.055 * side, 0, 0}, .velocity = {-side, 0, 0}, .mass = 1.0, .shape = Sphere{0.5}});
    double off = 0;
    const Seen seen =
        run(ladder, loop, 0.3, 0.01, [&](int) { off = most(off, set.velocity(middle).norm()); });
    return {{"speed of the middle one (m/s)", off, 1e-3, 1e-12},
            {"energy gained", seen.gain / seen.first_energy, 1e-9, 1e-12, 1}};
  });
}

}  // namespace ladders
