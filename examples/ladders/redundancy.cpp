// HC-09, HC-10, HC-11: too many constraints, masses that vanish.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/schemes/substeps.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include <array>

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

/// Five rods of 1 kg and 1 m on six hinges along the edges of a cube, Bricard's loop, gravity along −y: 30
/// rows of rank 29 in every pose. `axial` is the moment of a rod about itself, kg m²; 0 for boxes 0.1 m
/// thick.
RigidBodies::Handle add_bricard(auto& loop, double axial, std::vector<ConstraintHandle<Hinge>>& hinges) {
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity = {0, -g, 0};
  const std::array<Vec3, 6> p{Vec3(0, 0, 0),  Vec3(1, 0, 0),  Vec3(1, -1, 0),
                              Vec3(1, -1, 1), Vec3(0, -1, 1), Vec3(0, 0, 1)};
  std::array<RigidBodies::Handle, 5> rods;
  for (std::size_t k = 0; k < 5; ++k) {
    const Vec3 way = p[k + 1] - p[k], size = Vec3::Constant(0.1) + 0.9 * way.cwiseAbs();
    RigidBody rod{.position = 0.5 * (p[k] + p[k + 1]), .mass = 1.0, .shape = Box{size[0], size[1], size[2]}};
    if (axial > 0) rod.inertia = Mat3(Mat3::Identity() / 12 + (axial - 1. / 12) * way * way.transpose());
    rods[k] = set.add(rod);
  }
  for (std::size_t k = 0; k < 6; ++k) {
    const Vec3 before = p[k] - p[(k + 5) % 6], after = p[(k + 1) % 6] - p[k];
    const Quat axis = frame_along(before.cross(after));
    const Anchor world = world_anchor(p[k], axis);
    hinges.push_back(loop.add(Hinge::Item{k == 0 ? world : anchor_at(set, rods[k - 1], p[k], axis),
                                          k == 5 ? world : anchor_at(set, rods[k], p[k], axis)}));
  }
  return rods[2];
}

/// Two rods of 1 kg and 1 m that hang from hinges 1 m apart, one more between their ends, drawn aside by 60°:
/// 20 rows of rank 17.
RigidBodies::Handle add_parallelogram(auto& loop, double axial,
                                      std::vector<ConstraintHandle<Hinge>>& hinges) {
  auto& set = bodies<RigidBodies>(loop.world());
  const Vec3 down(std::sqrt(0.75), 0, -0.5), aside(1, 0, 0);
  const Quat across = frame_along({0, 1, 0});
  const auto add = [&](const Vec3& from, const Vec3& way) {
    return set.add({.position = from + 0.5 * way,
                    .mass = 1.0,
                    .inertia = Mat3(Mat3::Identity() / 12 + (axial - 1. / 12) * way * way.transpose())});
  };
  const auto left = add({0, 0, 0}, down), right = add(aside, down), bar = add(down, aside);
  const auto pin = [&](const Anchor& a, RigidBodies::Handle b, const Vec3& at) {
    hinges.push_back(loop.add(Hinge::Item{a, anchor_at(set, b, at, across)}));
  };
  pin(world_anchor({0, 0, 0}, across), left, {0, 0, 0});
  pin(world_anchor(aside, across), right, aside);
  pin(anchor_at(set, left, down, across), bar, down);
  pin(anchor_at(set, right, down + aside, across), bar, down + aside);
  return bar;
}

/// Ten seconds and more of a loop on more hinge rows than it needs, and where it is at t. `weight` of one of
/// its rods is what a load is measured by.
Marks around(Ladder& ladder, auto& loop, const std::vector<ConstraintHandle<Hinge>>& hinges, double scale,
             double t, double h, const auto& error) {
  std::vector<double> before(hinges.size());
  const double start = energy(loop);
  double growth = 0, change = 0, off = unbounded;
  const Seen seen = run(ladder, loop, ladder.is_quick() ? t : std::max(t, 10.), h, [&](int n) {
    for (std::size_t k = 0; k < hinges.size(); ++k) {
      const double now = std::max(loop.impulse(hinges[k]).norm() / h, 0.01 * g);
      if (n > 0) growth = most(growth, std::max(now / before[k], before[k] / now));
      before[k] = now;
    }
    change = most(change, std::abs(energy(loop) - start));
    if (n + 1 == std::lround(t / h)) off = error();
  });
  return {{"off its way (m)", off, 1e-2, 1e-3},
          {"change of energy / energy of the scene", change / scale, 1e-3, 1e-5},
          {"joint gap (m)", seen.joint_gap, 1e-6, 1e-9},
          {"a hinge's load grows or shrinks in a step, times", growth, unbounded, 10}};
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
// Planar and spatial loops on hinges, more rows than they need, and with rods as thin as needles. A four-bar
// swings as φ¨ = −1.2 g sin φ, from 60° through its lowest point after 5¼ periods of 4 K(sin 30°)/√(1.2 g);
// where Bricard's loop of thick rods is at 2 s is known to 1e-8 m, and thin ones go where those a thousand
// times less thin go.
void loops_in_space(Ladder& ladder) {
  const auto make = [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Hinge{}}, NewtonMidpoint{}};
  };
  for (const double axial : {1e-3, 1e-9})
    ladder.rung(format("four-bar, %g kg m² about a rod", axial), [&]() -> Marks {
      auto loop = make();
      std::vector<ConstraintHandle<Hinge>> hinges;
      const auto bar = add_parallelogram(loop, axial, hinges);
      const double period = 4 * std::comp_ellint_1(0.5) / std::sqrt(1.2 * g);
      return around(ladder, loop, hinges, g, 5.25 * period, period / 1000, [&] {
        return (bodies<RigidBodies>(loop.world()).position(bar) - Vec3(0.5, 0, -1)).norm();
      });
    });
  for (const double axial : {0., 1e-9})
    ladder.rung(axial > 0 ? format("Bricard's loop, %g kg m² about a rod", axial) : "Bricard's loop",
                [&]() -> Marks {
                  auto loop = make();
                  std::vector<ConstraintHandle<Hinge>> hinges, others;
                  const auto third = add_bricard(loop, axial, hinges);
                  const double h = 2e-3;
                  // Of its end (1, −1, 1), its centre is ½ before that.
                  const auto corner = [&](const auto& of, RigidBodies::Handle rod) {
                    const auto& set = bodies<RigidBodies>(of.world());
                    return Vec3(set.position(rod) + set.orientation(rod) * Vec3(0, 0, 0.5));
                  };
                  Vec3 known(-0.969340345, -1.221246895, 0.754278011);
                  if (axial > 0) {
                    auto less_thin = make();
                    const auto rod = add_bricard(less_thin, 1000 * axial, others);
                    run(ladder, less_thin, 2, h);
                    known = corner(less_thin, rod);
                  }
                  return around(ladder, loop, hinges, 5 * g, 2, h,
                                [&] { return (corner(loop, third) - known).norm(); });
                });
}
void vanishing_mass(Ladder& ladder) {
  climb_vanishing(ladder, AcceleratedGaussSeidel{.tolerance = 1e-8}, PositionProjection{.rate = 1});
}
void vanishing_mass_midpoint(Ladder& ladder) { climb_vanishing(ladder, NewtonMidpoint{}); }

}  // namespace ladders
