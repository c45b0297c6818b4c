// HC-31: ropes, one around a post and one with a knot.
#include "knot.hpp"
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/collision/with_filter.hpp>
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include <numbers>

namespace ladders {

namespace {

using std::numbers::pi;

/// The load that a rope of beads holds over a post by the load 1 at its other end: Euler's exp(π μ) for links
/// that meet at angles 2 α and beads of mass m. A bead that is about to slip, at θ from the light side, bears
/// N = T sin α + T' sin α' + m g sin θ, and T' cos α' = T cos α + m g cos θ + μ N.
double capstan(double mu, int around, double mass) {
  double load = 1;
  for (int k = 0; k <= around; ++k) {
    const double theta = pi * k / around, alpha = 0.5 * pi / around;
    const double in = k == 0 ? 0 : alpha, out = k == around ? 0 : alpha;  // the loads hang straight
    load = (load * (std::cos(in) + mu * std::sin(in)) + mass * (std::cos(theta) + mu * std::sin(theta))) /
           (std::cos(out) - mu * std::sin(out));
  }
  return load;
}

}  // namespace

// A rope of small beads hangs over a fixed post, one end loaded more.
void bollard(Ladder& ladder) {
  constexpr int around = 40, down = 1;
  constexpr double bead = 1e-2;
  const double mu = 0.3, edge = capstan(mu, around, bead);
  for (const double share : {0.5, 0.8, 0.9, 1.1, 1.25, 0.95, 1.05})
    ladder.rung(format("loads at %g of the capstan's", share), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}, Particles{}},
                         Constraints{Contact{Coulomb{.friction = mu}}, DistanceJoint{}},
                         DirectGaussSeidel{.tolerance = 1e-8}, WholeViolation{}};
      auto& rigid = bodies<RigidBodies>(loop.world());
      auto& beads = bodies<Particles>(loop.world());
      rigid.add_fixed(Cylinder{1, 4}, {0, 0, 0}, frame_along({0, 1, 0}));
      const double radius = 0.02, r = 1 + radius, length = 2 * r * std::sin(pi / around / 2);
      std::vector<Particles::Handle> rope;
      const auto add = [&](const Vec3& at, double mass) {
        rope.push_back(
            beads.add({.position = at, .mass = mass, .radius = radius, .group = 2, .collides_with = ~2u}));
      };
      for (int k = down; k > 0; --k) add({-r, 0, -length * k}, k == down ? 1 : bead);
      for (int k = 0; k <= around; ++k)
        add({-r * std::cos(pi * k / around), 0, r * std::sin(pi * k / around)}, bead);
      for (int k = 1; k <= down; ++k) add({r, 0, -length * k}, k == down ? share * edge : bead);
      for (std::size_t k = 0; k + 1 < rope.size(); ++k)
        loop.add(DistanceJoint::Item{
            .a = anchor(beads, rope[k]), .b = anchor(beads, rope[k + 1]), .length = length});
      const double start = beads.position(rope.back()).z();
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.1 : 1, 0.002);
      const double fall = start - beads.position(rope.back()).z();
      // Beyond it the loads move with a = g (s − 1)/(s + 1), less what the rope's own weight holds: a third
      // will do.
      const double free = share > 1 && !ladder.is_quick() ? 0.5 * g * (share - 1) / (share + 1) : 0;
      const double wrong = share < 1 ? fall : free / 3 - fall;
      return {{"slip of the load that should hang, or what is missing (m)", wrong, share < 1 ? 0.05 : 0,
               share < 1 ? 0.01 : 0},
              energy_mark(seen, (1 + edge) * g)};
    });
}

namespace {

/// Links of 1 kg, 0.25 m long and 0.2 m thick, with ball joints at their ends, hang from the world with an
/// overhand knot in the middle that has more than a diameter of room everywhere. At their end a ball of r kg,
/// of the links' density.
template <class Loop>
struct KnottedRope {
  static constexpr double radius = 0.1, length = 0.25;
  Loop& loop;
  RigidBodies& set = bodies<RigidBodies>(loop.world());
  std::vector<RigidBodies::Handle> links;
  RigidBodies::Handle load;

  KnottedRope(Loop& in, int count, double r) : loop(in) {
    const double unit = 2.5 * radius, half = 0.5 * length;
    std::vector<Vec3> line = overhand_knot(half * count / unit);
    for (Vec3& x : line) x *= unit;
    std::vector<Vec3> at = equal_chords(line, length);
    const auto first = at.begin() + (std::ptrdiff_t(at.size()) - 1 - count) / 2;
    at = {first, first + count + 1};
    for (std::size_t k = 0; k + 1 < at.size(); ++k)
      links.push_back(set.add({.position = 0.5 * (at[k] + at[k + 1]),
                               .orientation = frame_along((at[k + 1] - at[k]).normalized()),
                               .mass = 1.0,
                               .shape = Capsule{radius, length}}));
    const double ball = std::cbrt(0.75 * r * length * radius * radius);
    load = set.add({.position = at.back() - Vec3(0, 0, ball), .mass = r, .shape = Sphere{ball}});
    Anchor above = world_anchor(at[0]);
    for (const auto& link : links) {
      loop.add(BallJoint::Item{above, anchor(set, link, {0, 0, -half})});
      above = anchor(set, link, {0, 0, half});
    }
    loop.add(BallJoint::Item{above, anchor(set, load, {0, 0, ball})});
  }

  /// For the next step: the air is as thick as brakes what falls to g/rate.
  void brake(double rate) {
    for (const auto& link : links) set.apply_force(link, -rate * set.velocity(link));
    set.apply_force(load, -rate * set.mass(load.index) * set.velocity(load));
  }

  bool is_overhand() const {
    std::vector<Vec3> line;
    for (const auto& link : links) line.push_back(set.position(link));
    return std::round(knot_determinant(line)) == 3;
  }
};

struct KnotCase {
  double r;
  bool is_dropped;
};

}  // namespace

// An overhand knot in a rope of 200 links, loaded by r times the mass of a link. The knot is loose at first:
// the load sinks by some twenty links until it is tight, in thick air that is taken away after 5 s, or
// without any. Then it hangs, or goes on bouncing, for 10 s.
void knot(Ladder& ladder) {
  for (const auto& [r, is_dropped] :
       {KnotCase{1, false}, {10, false}, {100, false}, {1000, false}, {10, true}, {100, true}, {1000, true}})
    ladder.rung(
        format("load %g ×%s", r, is_dropped ? ", dropped" : ""),
        [&, r = r, is_dropped = is_dropped]() -> Marks {
          AnimationLoop loop{
              World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}, BallJoint{}},
              DirectGaussSeidel{.tolerance = 1e-6}, WholeViolation{}, WithFilter{NativeCollision{}}};
          const int count = ladder.is_quick() ? 40 : 200;
          KnottedRope rope(loop, count, r);
          const double h = frame / 16, diameter = 2 * rope.radius;
          const double sinking = ladder.is_quick() ? 4 : 5, hanging = ladder.is_quick() ? 0.3 : 10;
          const Seen sinks = run(ladder, loop, sinking, h, [&](int) {
            if (!is_dropped) rope.brake(6);
          });
          const double start = rope.set.position(rope.load).z();
          double way = 0;
          int lost = 0;
          const Seen hangs = run(ladder, loop, hanging, h, [&](int step) {
            way = most(way, start - rope.set.position(rope.load).z());
            if (step % 240 == 239 || step == 0) lost += !rope.is_overhand();
          });
          Seen seen = hangs;
          seen.gain = most(sinks.gain, hangs.gain);
          Marks marks{{"times it was not an overhand knot", double(lost), 0, 0},
                      {"joint gap / link", most(sinks.joint_gap, hangs.joint_gap) / rope.length, 1e-2, 1e-3},
                      {"largest overlap / diameter", most(sinks.penetration, hangs.penetration) / diameter,
                       0.1, 0.01},
                      {"steps not converged / steps",
                       (sinks.unconverged + hangs.unconverged) * h / (sinking + hanging), 1e-2, 1e-3},
                      energy_mark(seen, (0.5 * count + r) * g * count * rope.length)};
          if (!is_dropped) {
            marks.push_back({"joint gap / link while it hangs", hangs.joint_gap / rope.length, 1e-3, 1e-4});
            marks.push_back({"way of the load in 10 s / diameter", way / diameter, 0.1, 0.01});
          }
          return marks;
        });
}

}  // namespace ladders
