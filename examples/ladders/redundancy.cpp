// HC-09, HC-10, HC-11, HC-22: too many constraints, masses that vanish, constraints that contradict each
// other.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/loop/newton_midpoint.hpp>
#include <delassus/loop/substeps.hpp>

namespace ladders {

namespace {

Mat3 ball_inertia(double mass) { return 0.1 * mass * Mat3::Identity(); }

struct Swing {
  Vec3 end;
  Vec3 pull;  ///< Σ of the impulses at the hook, N·s
};

/// Two bodies on each other, every joint there `copies` times, let go from the side, after 2 s.
Swing swing(Ladder& ladder, int copies) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}},
                     AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 5000}};
  auto& set = bodies<RigidBodies>(loop.world());
  const auto upper = set.add({.position = {1, 0, 0}, .mass = 1.0, .inertia = ball_inertia(1)});
  const auto lower = set.add({.position = {2, 0, 0}, .mass = 2.0, .inertia = ball_inertia(2)});
  std::vector<ConstraintHandle<BallJoint>> hooks;
  for (int k = 0; k < copies; ++k) {
    hooks.push_back(loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, upper, {-1, 0, 0})}));
    loop.add(BallJoint::Item{anchor(set, upper, {1, 0, 0}), anchor(set, lower)});
  }
  run(ladder, loop, 2, 0.01);
  Vec3 pull = Vec3::Zero();
  for (const auto& hook : hooks) pull += loop.impulse(hook);
  return {set.position(lower), pull};
}

}  // namespace

void duplicates(Ladder& ladder) {
  Swing once{};
  for (const int copies : {1, 2, 5, 50})
    ladder.rung(format("every joint %d times", copies), [&]() -> Marks {
      const Swing many = swing(ladder, copies);
      if (copies == 1) once = many;
      return {{"change of the motion (m)", (many.end - once.end).norm(), 1e-6, 1e-10},
              {"change of the sum of the impulses", (many.pull - once.pull).norm() / once.pull.norm(),
               unbounded, 1e-8}};
    });
}

namespace {

// A door on more hinges than it needs, hit by nothing: the force on each hinge must not jump from step to
// step.
template <class... Policies>
void climb_hinges(Ladder& ladder, const Policies&... policies) {
  double of_one = 0;
  for (const int hinges : {1, 2, 3, 10, 30})
    ladder.rung(format("door on %d hinges", hinges), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto door = set.add(
          {.position = {0.5, 0, 0}, .angular_velocity = {0, 0, 2}, .mass = 20.0, .shape = Box{1, 0.05, 2}});
      set.set_velocity(door, {0, 1, 0}, {0, 0, 2});
      std::vector<ConstraintHandle<Hinge>> all;
      for (int k = 0; k < hinges; ++k) {
        const Vec3 at(0, 0, hinges > 1 ? -0.9 + 1.8 * k / (hinges - 1) : 0);
        all.push_back(loop.add(Hinge::Item{world_anchor(at), anchor_at(set, door, at)}));
      }
      std::vector<Vec<5>> before(all.size());
      double jump = 0, largest = 0;
      const Seen seen = run(ladder, loop, 5, 0.01, [&](int n) {
        for (std::size_t k = 0; k < all.size(); ++k) {
          const Vec<5> now = loop.impulse(all[k]) / 0.01;
          if (n > 0) jump = most(jump, (now - before[k]).norm());
          largest = std::max(largest, now.norm());
          before[k] = now;
        }
      });
      if (hinges == 1) of_one = jump / largest;
      return {{"joint gap (m, rad)", seen.joint_gap, 1e-3, 1e-5},
              {"jump of a hinge's load, to that of one hinge", jump / largest / of_one, 5, 1.5},
              {"steps not converged", double(seen.unconverged), unbounded, 0},
              energy_mark(seen, 20.)};
    });
}

// 1 kg hangs on a body of mass m that hangs on the world; m goes to nothing.
template <class... Policies>
void climb_vanishing(Ladder& ladder, const Policies&... policies) {
  for (int power = 0; power >= -12; power -= 2)
    ladder.rung(format("m = 1e%d kg", power), [&]() -> Marks {
      const double m = std::pow(10., power);
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto light = set.add({.position = {0, 0, -1}, .mass = m, .inertia = ball_inertia(m)});
      const auto heavy = set.add({.position = {0, 0, -2}, .mass = 1.0, .inertia = ball_inertia(1)});
      loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, light, {0, 0, 1})});
      loop.add(BallJoint::Item{anchor(set, light, {0, 0, -1}), anchor(set, heavy)});
      set.set_velocity(heavy, {0.5, 0, 0});
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 1 : 10, 0.01);
      return {{"joint gap (m)", seen.joint_gap, 1e-2, 1e-4},
              {"steps not converged", double(seen.unconverged), unbounded, 0},
              energy_mark(seen, 0.5 * 0.25 + g * 0.1)};
    });
}

}  // namespace

void many_hinges(Ladder& ladder) {
  climb_hinges(ladder, AcceleratedGaussSeidel{.tolerance = 1e-10, .max_iterations = 20000}, WholeViolation{},
               Substeps{.count = 4});
}
void many_hinges_midpoint(Ladder& ladder) { climb_hinges(ladder, NewtonMidpoint{}); }
void vanishing_mass(Ladder& ladder) {
  climb_vanishing(ladder, AcceleratedGaussSeidel{.tolerance = 1e-8}, PositionProjection{.rate = 1});
}
void vanishing_mass_midpoint(Ladder& ladder) { climb_vanishing(ladder, NewtonMidpoint{}); }

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
