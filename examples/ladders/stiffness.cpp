// HC-06, HC-07, HC-38: stiff springs, small and changing steps, stiff drives.
#include "rows.hpp"
#include "watch.hpp"

namespace ladders {

// A particle of 1 kg under a soft joint of stiffness k, let go at the spring's rest length.
void stiffness(Ladder& ladder) {
  for (const double zeta : {1., 0.})
    for (int power = 3; power <= 12; ++power)
      ladder.rung(format("k = 1e%d N/m, damping ratio %g", power, zeta), [&]() -> Marks {
        const double k = std::pow(10., power);
        AnimationLoop loop{World{Particles{}}, Constraints{DistanceJoint{}}};
        auto& set = bodies<Particles>(loop.world());
        const auto mass = set.add({.position = {0, 0, -1}, .mass = 1.0});
        loop.add(
            DistanceJoint::Item{world_anchor({0, 0, 0}), anchor(set, mass), 1, k, 2 * zeta * std::sqrt(k)});
        const double sag = g / k;
        // Undamped, implicit Euler takes the swing away by (1 + h² ω²)^(−n/2).
        const double omega = std::sqrt(k), until = ladder.is_quick() ? 5 : 30;
        const double left = zeta > 0 ? 0 : std::pow(1 + frame * frame * omega * omega, -0.5 * until / frame);
        const Seen seen = run(ladder, loop, until, frame);
        return {{"error of the sag", std::max(0.0, std::abs((-1 - set.position(mass).z()) / sag - 1) - left),
                 1e-2, power <= 10 ? 1e-6 : unbounded},
                energy_mark(seen, g * 1)};
      });
}

// A stack of three boxes and a pendulum in one scene; steps from 1/30 s down, and steps that jump by up to 16
// times.
void step_size(Ladder& ladder) {
  for (const double h : {1. / 30, 1. / 60, 1. / 240, 1e-3, 1e-4, 0.})
    ladder.rung(h > 0 ? format("h = %.4g s", h) : "h between 1/240 and 1/15 s, drawn", [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                         AcceleratedGaussSeidel{.tolerance = 1e-8}, PositionProjection{.rate = 1}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      RigidBodies::Handle top;
      for (int k = 0; k < 3; ++k)
        top = set.add({.position = {0.01 * k, 0, 0.5 + k}, .mass = 1.0, .shape = Box{1, 1, 1}});
      const auto bob =
          set.add({.position = {6, 0, 4}, .mass = 1.0, .inertia = Mat3(0.01 * Mat3::Identity())});
      loop.add(BallJoint::Item{world_anchor({5, 0, 4}), anchor(set, bob, {-1, 0, 0})});
      const Vec3 start = set.position(top);
      Seen seen;
      if (h > 0) {
        seen = run(ladder, loop, ladder.is_quick() ? 2 : 20, h);
      } else {
        seen.first_energy = energy(loop);
        unsigned state = 12345;
        while (loop.time() < 20) {
          state = state * 1664525u + 1013904223u;
          // loop.step is told another h every time.
          const StepReport report =
              loop.step(frame * std::pow(4., 2.0 * (state >> 8) / double(1u << 24) - 1));
          seen.penetration = std::max(seen.penetration, report.max_penetration);
          seen.gain = most(seen.gain, energy(loop) - seen.first_energy);
          ladder.show(std::min(1.0, loop.time() / 20));
        }
      }
      return {{"drift of the top (m)", (set.position(top) - start).norm(), 1e-2, 1e-5},
              {"penetration / size", seen.penetration, 1e-2, 1e-3},
              energy_mark(seen, g * 1)};
    });
}

// A drive on a hinge: kp from 10 to 1e9 N·m/rad on a link of 0.1 kg·m², against implicit Euler's own closed
// form.
void drives(Ladder& ladder) {
  for (int power = 1; power <= 9; ++power)
    ladder.rung(format("kp = 1e%d N·m/rad", power), [&]() -> Marks {
      const double k = std::pow(10., power), inertia = 0.1, c = 2 * std::sqrt(k * inertia), target = 0.5;
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Drive<Turn>{}},
                         AcceleratedGaussSeidel{.tolerance = 1e-12}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      const auto link = set.add({.mass = 1.0, .inertia = Mat3(inertia * Mat3::Identity())});
      loop.add(Hinge::Item{world_anchor({0, 0, 0}), anchor(set, link)});
      loop.add(Drive<Turn>::Item{.a = world_anchor({0, 0, 0}),
                                 .b = anchor(set, link),
                                 .target = target,
                                 .stiffness = k,
                                 .damping = c});
      // I (ω⁺ − ω) = −h (k (q + h ω⁺ − q*) + c ω⁺)
      double q = 0, omega = 0, error = 0;
      run(ladder, loop, ladder.is_quick() ? 1 : 10, frame, [&](int) {
        omega = (inertia * omega - frame * k * (q - target)) / (inertia + frame * c + frame * frame * k);
        const double x = frame * omega;
        q += 2 * std::atan(x / 2 * (1 + x * x / 12));  // a turn by the midpoint rule, lengthened to x + O(x⁵)
        const Quat turn = set.orientation(link);
        error = most(error, std::abs(2 * std::atan2(turn.z(), turn.w()) - q));
      });
      return {{"error of the angle (rad)", error, 1e-2, 1e-6},
              {"speed at the end (m/s)", top_speed(loop), 1e-3, 1e-3}};
    });
}

}  // namespace ladders
