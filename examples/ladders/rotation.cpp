// HC-12, HC-41: needles, plates and boxes that spin, and runs that are long.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/steppers/newton_midpoint.hpp>

namespace ladders {

namespace {

struct Top {
  const char* name;
  Vec3 inertia;
};

/// A free body whose spin is not along an axis, at `spin` rad/s.
RigidBodies::Handle add_top(auto& set, const Vec3& inertia, double spin) {
  set.gravity.setZero();
  return set.add({.angular_velocity = spin * Vec3(0.3, 1, 0.2).normalized(),
                  .mass = 1.0,
                  .inertia = Mat3(inertia.asDiagonal())});
}

}  // namespace

void free_spin(Ladder& ladder) {
  for (const Top& top : {Top{"box 1:2:3", {1, 2, 3}}, Top{"needle 1:1:1e-6", {1, 1, 1e-6}},
                         Top{"plate 1:1:1.9999", {1, 1, 1.9999}}})
    for (const double spin : {10., 1e2, 1e3, 1e4})
      ladder.rung(format("%s at %g rad/s", top.name, spin), [&]() -> Marks {
        AnimationLoop loop{World{RigidBodies{}}};
        auto& set = bodies<RigidBodies>(loop.world());
        add_top(set, top.inertia, spin);
        const Vec3 before = angular_momentum(set);
        const double start = kinetic_energy(set);
        double turn = 0, low = 0, high = 0;
        run(ladder, loop, 100, frame, [&](int) {
          turn = most(turn, (angular_momentum(set) - before).norm() / before.norm());
          const double change = kinetic_energy(set) / start - 1;
          low = most(low, -change), high = most(high, change);
        });
        return {{"change of angular momentum", turn, 1e-6, 1e-12},
                {"energy gained", high, 0.01, 1e-3, 1},
                {"energy lost", low, 0.5, 1e-3}};
      });
}

// A free box: a million steps and more; what adds up must be rounding only.
void long_spin(Ladder& ladder) {
  for (int power = 4; power <= 7; ++power)
    ladder.rung(format("1e%d steps", power), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto top = add_top(set, {1, 2, 3}, 3);
      const double start = kinetic_energy(set);
      const long steps = std::lround(std::pow(10., power));
      double norm = 0, change = 0;
      for (long n = 0; n < steps; ++n) {
        loop.step(frame);
        if (n % 1000 == 999) {
          norm = most(norm, std::abs(set.orientation(top).coeffs().norm() - 1));
          change = most(change, std::abs(kinetic_energy(set) / start - 1));
          ladder.show((n + 1.0) / double(steps));
        }
      }
      return {{"|q| − 1", norm, 1e-12, 1e-15},
              {"change of energy", change, 1e-6, 1e-10},
              {"t − n h (s)", std::abs(loop.time() - double(steps) * frame), 1e-6, 0}};
    });
}

namespace {

template <class... Policies>
void climb_pendulum(Ladder& ladder, const Policies&... policies) {
  for (int power = 3; power <= 7; ++power)
    ladder.rung(format("1e%d steps", power), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto bob =
          set.add({.position = {1, 0, 0}, .mass = 1.0, .inertia = Mat3(0.01 * Mat3::Identity())});
      loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, bob, {-1, 0, 0})});
      const Seen seen = run(ladder, loop, 0.01 * std::pow(10., power), 0.01);
      const double lost = (seen.first_energy - seen.last_energy) / g;
      return {{"joint gap (m)", seen.joint_gap, 1e-2, 1e-3},
              {"energy lost / energy of the scene", lost, 0.5, 0.01},
              energy_mark(seen, g)};
    });
}

}  // namespace

void long_pendulum(Ladder& ladder) {
  climb_pendulum(ladder, AcceleratedGaussSeidel{.tolerance = 1e-12}, PositionProjection{.rate = 1},
                 ImplicitMidpoint{});
}
void long_pendulum_midpoint(Ladder& ladder) { climb_pendulum(ladder, NewtonMidpoint{}); }

namespace {

/// Runs many steps; look() after each thousandth.
template <class Loop>
void endure(Ladder& ladder, Loop& loop, long steps, double h, const auto& look) {
  for (long n = 0; n < steps; ++n) {
    loop.step(h);
    if (n % 1000 != 999) continue;
    look();
    ladder.show((n + 1.0) / double(steps));
  }
}

Mark time_mark(const auto& loop, long steps, double h) {
  return {"t − n h (s)", std::abs(loop.time() - double(steps) * h), 1e-6, 0};
}

/// |q| − 1, the worst of all bodies.
double off_unit(const auto& set) {
  double worst = 0;
  for (const Index b : alive(set))
    worst = most(worst, std::abs(set.orientation(set.handle(b)).coeffs().norm() - 1));
  return worst;
}

/// Five boxes on the ground, of which the upper ones are a little off the middle.
template <class... Policies>
void climb_rest(Ladder& ladder, int hardest, const Policies&... policies) {
  for (int power = 4; power <= hardest; ++power)
    ladder.rung(format("1e%d steps", power), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.4}}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      RigidBodies::Handle top;
      for (int k = 0; k < 5; ++k)
        top = set.add({.position = {0.125 * k / 16, 0, 0.5 + k}, .mass = 1.0, .shape = Box{1, 1, 1}});
      for (int n = 0; n < 1000; ++n) loop.step(frame);  // it settles
      const long steps = ladder.is_quick() ? 1000 : std::lround(std::pow(10., power));
      const Vec3 start = set.position(top);
      const double first = energy(loop);
      double drift = 0, change = 0, norm = 0;
      endure(ladder, loop, steps, frame, [&] {
        drift = most(drift, (set.position(top) - start).norm());
        change = most(change, std::abs(energy(loop) / first - 1));
        norm = most(norm, off_unit(set));
      });
      return {{"drift of the top (m)", drift, 1e-6, 1e-9},
              {"change of energy", change, 1e-6, 1e-9},
              {"|q| − 1", norm, 1e-12, 1e-15},
              time_mark(loop, steps + 1000, frame)};
    });
}

}  // namespace

// A heavy top at 50 rad/s on its tip, leaning by 0.5 rad; it nods and goes round.
void long_top(Ladder& ladder) {
  for (int power = 4; power <= 7; ++power)
    ladder.rung(format("1e%d steps", power), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
      auto& set = bodies<RigidBodies>(loop.world());
      const Vec3 axis(std::sin(0.5), 0, std::cos(0.5));
      const auto top = set.add({.position = 0.1 * axis,
                                .orientation = exponential<double>({0, 0.5, 0}),
                                .angular_velocity = 50 * axis,
                                .mass = 1.0,
                                .inertia = Mat3(Vec3(2e-3, 2e-3, 3e-3).asDiagonal())});
      loop.add(BallJoint::Item{world_anchor({0, 0, 0}), anchor(set, top, {0, 0, -0.1})});
      const double start = energy(loop), h = 2e-3;
      const long steps = std::lround(std::pow(10., power));
      double change = 0, norm = 0, gap = 0;
      endure(ladder, loop, steps, h, [&] {
        change = most(change, std::abs(energy(loop) / start - 1));
        norm = most(norm, off_unit(set));
        gap = most(gap, loop.report().max_joint_violation);
      });
      return {{"change of energy", change, 1e-6, 1e-6},
              {"joint gap (m)", gap, 1e-6, 1e-9},
              {"|q| − 1", norm, 1e-12, 1e-15},
              time_mark(loop, steps, h)};
    });
}

void long_rest(Ladder& ladder) { climb_rest(ladder, 6); }
void long_rest_exact(Ladder& ladder) {
  climb_rest(ladder, 6, AcceleratedGaussSeidel{.tolerance = 1e-12, .max_iterations = 5000});
}
void long_sleep(Ladder& ladder) { climb_rest(ladder, 7, Sleeping{}); }

}  // namespace ladders
