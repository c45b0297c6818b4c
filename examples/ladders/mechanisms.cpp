// HC-21, HC-33, HC-34: loops through their singular pose, trains of gears, joints at their limits.
#include "plane_loop.hpp"
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/schemes/substeps.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>
#include <delassus/solvers/proximal_newton.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>

#include <numbers>

namespace ladders {

namespace {

using std::numbers::pi;

/// φ¨ = Ω² sin φ by the classical Runge-Kutta method in steps of 1e-5 s: what n four-bars of equal rods do, φ
/// from the upright. Source: verification by reduction; Ω² = g ((n + 1)/2 + n)/((n + 1)/3 + n).
double crank_angle(double rate, double speed, double t) {
  double phi = 0, omega = speed;
  const int steps = int(std::lround(t / 1e-4));
  const double h = t / steps;
  const auto bend = [&](double x) { return rate * std::sin(x); };
  for (int n = 0; n < steps; ++n) {
    const double k1 = bend(phi), l1 = omega, k2 = bend(phi + h / 2 * l1), l2 = omega + h / 2 * k1;
    const double k3 = bend(phi + h / 2 * l2), l3 = omega + h / 2 * k2, k4 = bend(phi + h * l3),
                 l4 = omega + h * k3;
    phi += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
    omega += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return phi;
}

// n + 1 upright unit rods with n level ones between their tops: all lie on one line twice a turn.
template <class... Policies>
void climb_four_bars(Ladder& ladder, double until, const Policies&... policies) {
  struct Case {
    int n;
    double h;
  };
  for (const auto& [n, h] : {Case{1, 1e-3}, {2, 1e-3}, {5, 1e-3}, {10, 1e-3}, {40, 1e-3}, {1, 1e-2}})
    ladder.rung(format("%d four-bars, h = %g s", n, h), [&, n = n, h = h]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}, Planar{}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      const Mat3 slim = Vec3(1. / 12, 1. / 12, 1e-3).asDiagonal();
      std::vector<RigidBodies::Handle> cranks;
      const Quat level = frame_along({0, 1, 0});
      for (int k = 0; k <= n; ++k) {
        cranks.push_back(set.add({.position = {double(k), 0, 0.5},
                                  .velocity = {0.5, 0, 0},
                                  .angular_velocity = {0, 1, 0},
                                  .mass = 1.0,
                                  .inertia = slim}));
        loop.add(BallJoint::Item{world_anchor({double(k), 0, 0}), anchor(set, cranks.back(), {0, 0, -0.5})});
      }
      for (int k = 0; k < n; ++k) {
        const auto bar = set.add({.position = {k + 0.5, 0, 1},
                                  .velocity = {1, 0, 0},
                                  .mass = 1.0,
                                  .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
        loop.add(BallJoint::Item{anchor(set, cranks[std::size_t(k)], {0, 0, 0.5}),
                                 anchor(set, bar, {-0.5, 0, 0})});
        loop.add(BallJoint::Item{anchor(set, cranks[std::size_t(k + 1)], {0, 0, 0.5}),
                                 anchor(set, bar, {0.5, 0, 0})});
        loop.add(Planar::Item{world_anchor({0, 0, 0}, level), anchor(set, bar, {0, 0, 0}, level)});
      }
      double change = 0;
      const double start = energy(loop);
      const Seen seen =
          run(ladder, loop, until, h, [&](int) { change = most(change, std::abs(energy(loop) - start)); });
      const double rate = g * (0.5 * (n + 1) + n) / ((n + 1) / 3. + n), phi = crank_angle(rate, 1, until);
      const Vec3 tip = set.position(cranks[0]) + set.orientation(cranks[0]) * Vec3(0, 0, 0.5);
      return {{"place at the end (m)", (tip - Vec3(std::sin(phi), 0, std::cos(phi))).norm(), 0.1, 1e-3},
              {"change of energy / energy of the scene", change / (g * (0.5 * (n + 1) + n) * 2), 1e-3, 1e-5},
              {"joint gap (m)", seen.joint_gap, 1e-2, 1e-4}};
    });
}

/// 20 s; off(time) says how far it is from its branch, m.
Marks twenty_seconds(Ladder& ladder, PlaneLoop& m, double h, const auto& off) {
  double change = 0, worst = 0;
  const double start = kinetic_energy(m.rigid);
  const Seen seen = run(ladder, m.loop, ladder.is_quick() ? 2 : 20, h, [&](int n) {
    change = most(change, std::abs(kinetic_energy(m.rigid) / start - 1));
    worst = most(worst, off((n + 1) * h));
  });
  return {{"off its branch (m)", worst, 1e-2, 1e-6},
          {"change of energy", change, 1e-3, 1e-5},
          {"joint gap (m)", seen.joint_gap, 1e-2, 1e-4},
          {"steps not converged", double(seen.unconverged), unbounded, 0}};
}

// A crank and a rod of one length: where the slider is over the crank's axle it could stay there while both
// turn on. On its branch x = 2 cos θ, and 2 T = M θ̇² with M = ⅔ + 6 sin² θ: θ comes at the time ∫ √(M/2T) dθ.
Marks slider_crank(Ladder& ladder, double h) {
  PlaneLoop m;
  const double first = 0.3, speed = 2, c = std::cos(first), s = std::sin(first);
  const Vec3 tip(c, 0, s), v_tip = speed * Vec3(-s, 0, c), at(2 * c, 0, 0), v_at(-2 * s * speed, 0, 0);
  const auto crank = m.rod({0, 0, 0}, tip, {0, 0, 0}, v_tip), link = m.rod(tip, at, v_tip, v_at);
  const auto slider =
      m.rigid.add({.position = at, .velocity = v_at, .mass = 1.0, .inertia = Mat3(0.1 * Mat3::Identity())});
  m.pin(world_anchor({0, 0, 0}, m.across), crank, {0, 0, 0});
  m.pin(m.on(crank, tip), link, tip);
  m.pin(m.on(slider, at), link, at);
  const Quat along = frame_along({1, 0, 0});
  m.loop.add(Slider::Item{world_anchor(at, along), anchor_at(m.rigid, slider, at, along)});
  const auto slowness = [&](double x) {
    const auto M = [](double y) { return 2. / 3 + 6 * std::sin(y) * std::sin(y); };
    return std::sqrt(M(x) / M(first)) / speed;
  };
  double theta = first, time = 0, late = 0;
  Marks marks = twenty_seconds(ladder, m, h, [&](double now) {
    const Vec3 end = m.end(crank, 1);
    const double turn = std::remainder(std::atan2(end.z(), end.x()) - theta, 2 * pi);
    time += turn / 6 * (slowness(theta) + 4 * slowness(theta + turn / 2) + slowness(theta + turn));
    theta += turn;
    late = most(late, std::abs(time - now) / 20);
    return std::abs(m.rigid.position(slider).x() - 2 * end.x());
  });
  marks.push_back({"late / 20 s", late, 1e-2, 1e-3});
  if (!ladder.is_quick())
    marks.push_back({"dead centres not passed, of 6", std::max(0., 6 - (theta / pi + 0.5)), 0, 0});
  return marks;
}

// Two unit cranks a metre apart that turn apart, and two unit rods between their ends, which come to lie on
// one line: there the tip could go back up. Nothing tells left from right on the way there.
Marks five_bar(Ladder& ladder, double h) {
  PlaneLoop m;
  const double angle = 65 * pi / 180, x = std::cos(angle), z = std::sin(angle), w = 0.2;
  const Vec3 left(-x, 0, z), right(1 + x, 0, z), half(0.5 + x, 0, 0);
  const double rise = std::sqrt(1 - half.squaredNorm());
  const Vec3 tip(0.5, 0, z + rise), v_left = w * Vec3(-z, 0, -x), v_right = w * Vec3(z, 0, -x);
  // The rods keep their length: half · v + rise · v_z = 0 of the tip against the elbow.
  const Vec3 v_tip(0, 0, v_left.z() + v_left.x() * half.x() / rise);
  const auto a = m.rod({0, 0, 0}, left, {0, 0, 0}, v_left), b = m.rod({1, 0, 0}, right, {0, 0, 0}, v_right);
  const auto p = m.rod(left, tip, v_left, v_tip), q = m.rod(right, tip, v_right, v_tip);
  m.pin(world_anchor({0, 0, 0}, m.across), a, {0, 0, 0});
  m.pin(world_anchor({1, 0, 0}, m.across), b, {1, 0, 0});
  m.pin(m.on(a, left), p, left);
  m.pin(m.on(b, right), q, right);
  m.pin(m.on(p, tip), q, tip);
  double lowest = 1;
  Marks marks = twenty_seconds(ladder, m, h, [&](double) {
    const Vec3 elbow = m.end(a, 1), other = m.end(b, 1);
    lowest = std::min(lowest, m.end(p, 1).z() - 0.5 * (elbow.z() + other.z()));
    return lowest > -0.1 ? std::abs(elbow.x() + other.x() - 1) : 0.;
  });
  if (!ladder.is_quick())
    marks.push_back({"short of 0.2 m beyond the line (m)", std::max(0., lowest + 0.2), 0, 0});
  return marks;
}

// A train of gears, each pair with a ratio, for a thousand turns and more of the fastest: driven at the first
// wheel, or set going and left alone.
template <bool is_driven, class... Policies>
void climb_gears(Ladder& ladder, const Policies&... policies) {
  struct Case {
    int wheels;
    double ratio;
  };
  for (const auto& [wheels, ratio] : {Case{2, 1.}, {2, 10.}, {10, 1.}, {10, 2.}, {2, 1e3}, {2, 1e-3}})
    ladder.rung(format("%d wheels, ratio %g", wheels, ratio), [&, wheels = wheels, ratio = ratio]() -> Marks {
      using Laws =
          std::conditional_t<is_driven, Constraints<Hinge, Gear, Motor<Turn>>, Constraints<Hinge, Gear>>;
      AnimationLoop loop{World{RigidBodies{}}, Laws{}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      std::vector<RigidBodies::Handle> train;
      std::vector<ConstraintHandle<Gear>> gears;
      const double fastest = 6, over = std::pow(ratio, wheels - 1),
                   first = ratio >= 1 ? fastest : fastest * over;
      for (int k = 0; k < wheels; ++k) {
        const Vec3 at(2. * k, 0, 0);
        const double rate = is_driven ? 0 : first / std::pow(-ratio, k);
        train.push_back(set.add({.position = at,
                                 .angular_velocity = {0, 0, rate},
                                 .mass = 1.0,
                                 .inertia = Mat3(Mat3::Identity())}));
        loop.add(Hinge::Item{world_anchor(at), anchor(set, train.back())});
        if (k > 0)
          gears.push_back(loop.add(Gear::Item{.a = anchor(set, train[std::size_t(k - 1)]),
                                              .b = anchor(set, train.back()),
                                              .c = world_anchor({2. * (k - 1), 0, 0}),
                                              .d = world_anchor(at),
                                              .ratio = -ratio}));
      }
      if constexpr (is_driven)
        loop.add(Motor<Turn>::Item{.a = world_anchor({0, 0, 0}), .b = anchor(set, train[0]), .speed = first});
      double error = 0;
      run(ladder, loop, ladder.is_quick() ? 5 : 2 * pi * 1000 / fastest, frame, [&](int) {
        for (const auto& gear : gears) {
          const auto& item = loop.item(gear);
          error = most(error, std::abs(item.position_a - item.ratio * item.position_b - item.phase) /
                                  std::max(1.0, std::abs(item.ratio)));
        }
      });
      return {{"error of the angle (rad)", error, 1e-3, 1e-9}};
    });
}

// A chain of hinges, each with limits on both sides, thrown about so that they are hit again and again.
template <class... Policies>
void climb_limits(Ladder& ladder, const Policies&... policies) {
  for (const int links : {1, 3, 10, 32})
    ladder.rung(format("%d links, limits of ±0.5 rad", links), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}}, policies...};
      auto& set = bodies<RigidBodies>(loop.world());
      const Quat axis = frame_along({0, -1, 0});
      std::vector<ConstraintHandle<Limit<Turn>>> all;
      RigidBodies::Handle last;
      for (int k = 0; k < links; ++k) {
        const auto link =
            set.add({.position = {0.2 * (k + 0.5), 0, 0}, .mass = 1.0, .shape = Box{0.2, 0.05, 0.05}});
        const Vec3 at(0.2 * k, 0, 0);
        const Anchor a = k ? anchor_at(set, last, at, axis) : world_anchor(at, axis),
                     b = anchor_at(set, link, at, axis);
        loop.add(Hinge::Item{a, b});
        all.push_back(loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = -0.5, .upper = 0.5}));
        last = link;
      }
      double over = 0;
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 2 : 20, frame, [&](int) {
        for (const auto& limit : all) over = most(over, std::abs(loop.item(limit).position) - 0.5);
      });
      constexpr double degree = pi / 180;
      return {{"beyond a limit (degrees)", over / degree, 5, 0.1},
              {"joint gap / link", seen.joint_gap / 0.2, 0.05, 1e-2},
              energy_mark(seen, links * g * 0.1 * links)};
    });
}

}  // namespace

void four_bars(Ladder& ladder) {
  climb_four_bars(ladder, ladder.is_quick() ? 1 : 10, ProximalNewton{.tolerance = 1e-10}, WholeViolation{});
}
void four_bars_midpoint(Ladder& ladder) {
  climb_four_bars(ladder, ladder.is_quick() ? 1 : 20, NewtonMidpoint{});
}
void four_bars_midpoint_in_parts(Ladder& ladder) {
  climb_four_bars(ladder, ladder.is_quick() ? 1 : 20, NewtonMidpoint{}, Substeps{.count = 4});
}
void dead_centres(Ladder& ladder) {
  for (const double h : {2e-3, 1e-2})
    ladder.rung(format("slider-crank, h = %g s", h), [&] { return slider_crank(ladder, h); });
  for (const double h : {1e-3, 1e-2})
    ladder.rung(format("parallel five-bar, h = %g s", h), [&] { return five_bar(ladder, h); });
}
void gear_train(Ladder& ladder) {
  climb_gears<true>(ladder, AcceleratedGaussSeidel{.tolerance = 1e-9, .max_iterations = 2000});
}
void gear_train_direct(Ladder& ladder) { climb_gears<true>(ladder, DirectGaussSeidel{}); }
void gear_train_rattle(Ladder& ladder) { climb_gears<false>(ladder, Rattle{}); }
void limits(Ladder& ladder) {
  climb_limits(ladder, AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 5000});
}
void limits_in_parts(Ladder& ladder) {
  climb_limits(ladder, AcceleratedGaussSeidel{.tolerance = 1e-8, .max_iterations = 5000}, WholeViolation{},
               Substeps{.count = 4});
}

}  // namespace ladders
