// HC-22: constraints that contradict each other.
#include "rows.hpp"
#include "watch.hpp"

namespace ladders {

// A bar that is too long for the gap between two walls, by a share of its length; then one wall goes.
void no_room(Ladder& ladder) {
  for (const double excess : {0.01, 0.05, 0.1, 0.5})
    ladder.rung(format("bar longer than its gap by %g", excess), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      set.add_fixed(HalfSpace{Vec3(1, 0, 0)}, {-0.5 + 0.5 * excess, 0, 0});
      const auto wall = set.add_fixed(HalfSpace{Vec3(-1, 0, 0)}, {0.5 - 0.5 * excess, 0, 0});
      const auto bar = set.add({.position = {0, 0, 0.1}, .mass = 1.0, .shape = Box{1, 0.2, 0.2}});
      const Seen seen = run(ladder, loop, 5, 0.01);
      const double energy_in = kinetic_energy(set), off = std::abs(set.position(bar).x());
      loop.remove(wall);
      int recovery = 0;
      run(ladder, loop, 1, 0.01, [&](int n) {
        if (loop.report().status != Status::converged || top_speed(loop) > 1.1) recovery = n + 1;
      });
      return {{"speed (m/s)", seen.speed, 10, 1.1},
              {"off the middle / excess", off / excess, 1, 0.1},
              {"kinetic energy (J)", energy_in, unbounded, 1e-6},
              {"converged without saying so (steps)", 500. - seen.unconverged, 499, 250},
              {"steps to recover without the wall", double(recovery), unbounded, 10}};
    });
}

// Two motors on one axis that want opposite speeds, with caps that differ by a share.
void opposed_motors(Ladder& ladder) {
  for (const double share : {0.5, 0.1, 0.01, 0.})
    ladder.rung(share > 0 ? format("caps differ by %g", share) : "no caps at all", [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Motor<Turn>{}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      const auto wheel = set.add({.mass = 1.0, .inertia = Mat3(Mat3::Identity())});
      const Anchor a = world_anchor({0, 0, 0}), b = anchor(set, wheel);
      loop.add(Hinge::Item{a, b});
      const double cap = share > 0 ? 10 : unbounded;
      const auto forth =
          loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = 1, .max_force = cap * (1 + share)});
      const auto back = loop.add(Motor<Turn>::Item{.a = a, .b = b, .speed = -1, .max_force = cap});
      run(ladder, loop, 20, 0.01);
      const double turn = set.angular_velocity(wheel).z(), wanted = share > 0 ? 1 : 0;
      const double impulse = std::max(std::abs(loop.impulse(forth)[0]), std::abs(loop.impulse(back)[0]));
      return {{"off the speed that wins, or the middle (rad/s)", std::abs(turn - wanted), 1, 0.1},
              {"largest motor impulse (N·m·s)", impulse, 100, 10},
              {"energy (J)", kinetic_energy(set), 1, 0.6}};
    });
}

}  // namespace ladders
