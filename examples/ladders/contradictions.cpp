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

namespace {

/// 2 s of a contradiction, then a second without. pull(): the largest impulse, N·s; off(): how far from its
/// equal share of the conflict the worst constraint is, over that share.
template <class Loop>
Marks contradict(Ladder& ladder, Loop& loop, const auto& pull, const auto& off, const auto& relieve) {
  auto& set = bodies<RigidBodies>(loop.world());
  const double h = 0.01;
  double impulse = 0, kinetic = 0;
  int said = 0, recovery = 0;
  run(ladder, loop, 2, h, [&](int n) {
    said += loop.report().status != Status::converged;
    impulse = most(impulse, pull());
    if (n >= 100) kinetic = most(kinetic, kinetic_energy(set));
  });
  const double share = off();
  relieve();
  run(ladder, loop, 1, h, [&](int n) {
    if (loop.report().status != Status::converged || kinetic_energy(set) > 1e-6) recovery = n + 1;
  });
  return {{"off equal shares / share", share, 1, 0.1},
          {"kinetic energy (J)", kinetic, unbounded, 1e-6},
          {"largest impulse (N·s)", impulse, 1000 * h * g, 100 * h * g},
          {"converged without saying so (steps)", 200. - said, 199, 10},
          {"steps to recover without the conflict", double(recovery), unbounded, 10}};
}

/// A box on the floor with a pin that wants it 0.1 m deeper.
Marks pin_through_floor(Ladder& ladder) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
                     PositionProjection{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(HalfSpace{});
  const auto box = set.add({.position = {0, 0, 0.5}, .mass = 1.0, .shape = Box{1, 1, 1}});
  const auto pin = loop.add(BallJoint::Item{anchor(set, box), world_anchor({0, 0, 0.4})});
  return contradict(
      ladder, loop, [&] { return loop.impulse(pin).norm(); },
      [&] { return std::abs(set.position(box).z() - 0.45) / 0.05; }, [&] { loop.remove(pin); });
}

/// Three rods of 1 m that shall reach over 3.03 m: a quarter of the 0.03 m in each of four joints. The loop is
/// closed by a rod of that length, or by the world, in which the ends are hooks.
Marks short_loop(Ladder& ladder, bool is_closed_by_rod) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, PositionProjection{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const auto add_rod = [&](double middle, double length) {
    const double across = length * length / 12;
    return set.add({.position = {middle, 0, 0},
                    .mass = 1.0,
                    .inertia = Mat3(Vec3(1e-2, across, across).asDiagonal())});
  };
  std::vector<ConstraintHandle<BallJoint>> joints;
  std::vector<RigidBodies::Handle> rods;
  Anchor end = world_anchor({0, 0, 0}), last = world_anchor({3.03, 0, 0});
  if (is_closed_by_rod) {
    const auto rod = add_rod(1.515, 3.03);
    end = anchor(set, rod, {-1.515, 0, 0}), last = anchor(set, rod, {1.515, 0, 0});
  }
  const Anchor first = end;
  for (int k = 0; k < 3; ++k) {
    rods.push_back(add_rod(0.5 + k, 1));
    joints.push_back(loop.add(BallJoint::Item{end, anchor(set, rods.back(), {-0.5, 0, 0})}));
    end = anchor(set, rods.back(), {0.5, 0, 0});
  }
  joints.push_back(loop.add(BallJoint::Item{end, last}));
  const auto off = [&] {
    Vec3 before = loop.world().point(first);
    double worst = 0;
    for (std::size_t k = 0; k <= rods.size(); ++k) {
      const auto tip = [&](double side) {
        return Vec3(set.position(rods[k]) + set.orientation(rods[k]) * Vec3(side, 0, 0));
      };
      const Vec3 next = k < rods.size() ? tip(-0.5) : Vec3(loop.world().point(last));
      worst = most(worst, std::abs((next - before).norm() / (0.03 / 4) - 1));
      if (k < rods.size()) before = tip(0.5);
    }
    return worst;
  };
  return contradict(
      ladder, loop,
      [&] {
        double top = 0;
        for (const auto& joint : joints) top = most(top, loop.impulse(joint).norm());
        return top;
      },
      off, [&] { loop.remove(joints.back()); });
}

/// A wheel with one limit that wants it beyond 0.1 rad and one that wants it before −0.1 rad. A limit with
/// its ends exchanged is refused.
Marks crossed_limits(Ladder& ladder) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Hinge{}, Limit<Turn>{}}, PositionProjection{}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.gravity.setZero();
  const auto wheel = set.add({.mass = 1.0, .inertia = Mat3(Mat3::Identity())});
  const Anchor a = world_anchor({0, 0, 0}), b = anchor(set, wheel);
  loop.add(Hinge::Item{a, b});
  const auto beyond = loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = 0.1});
  const auto before = loop.add(Limit<Turn>::Item{.a = a, .b = b, .upper = -0.1});
  bool is_refused = false;
  try {
    loop.add(Limit<Turn>::Item{.a = a, .b = b, .lower = 0.1, .upper = -0.1});
  } catch (const InvalidArgument&) {
    is_refused = true;
  }
  Marks marks = contradict(
      ladder, loop, [&] { return most(loop.impulse(beyond).norm(), loop.impulse(before).norm()); },
      [&] { return std::abs(loop.item(beyond).position) / 0.1; }, [&] { loop.remove(before); });
  marks.push_back({"limit with its ends exchanged is taken", double(!is_refused), 0, 0});
  return marks;
}

}  // namespace

// What cannot be held together: a compromise in the middle, without a push for what is free, said, and
// forgotten as soon as the conflict ends.
void no_way(Ladder& ladder) {
  ladder.rung("limit beyond its other end", [&] { return crossed_limits(ladder); });
  ladder.rung("pin through the floor", [&] { return pin_through_floor(ladder); });
  ladder.rung("loop a per cent too short", [&] { return short_loop(ladder, true); });
  ladder.rung("chain a per cent too short for its hooks", [&] { return short_loop(ladder, false); });
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
