// HC-15, HC-42: scenes far from the origin, and scenes that are tiny or huge.
#include "rows.hpp"
#include "watch.hpp"

namespace ladders {

namespace {

/// A stack of five boxes and a pendulum, of length `a`, mass `b`, at `at`; gravity a g, so that time keeps
/// its unit. What comes out is divided by a.
struct Outcome {
  std::vector<Vec3> places;
  double joint_gap = 0;
  int unconverged = 0;
};

template <class Set = RigidBodies>
Outcome standard(Ladder& ladder, double a, double b, const Vec3& at, double seconds,
                 double tolerance = 1e-10) {
  AnimationLoop loop{World{Set{}}, Constraints{Contact{Coulomb{.friction = 0.4}}, BallJoint{}},
                     AcceleratedGaussSeidel{.tolerance = tolerance, .max_iterations = 5000}};
  auto& set = bodies<Set>(loop.world());
  set.gravity = a * Vec3(0, 0, -g);
  set.add_fixed(HalfSpace{}, at);
  for (int k = 0; k < 5; ++k)
    set.add({.position = at + a * Vec3(0.125 * k / 16, 0, 0.5 + k), .mass = b, .shape = Box{a, a, a}});
  const auto bob = set.add(
      {.position = at + a * Vec3(6, 0, 4), .mass = b, .inertia = Mat3(0.1 * b * a * a * Mat3::Identity())});
  loop.add(BallJoint::Item{world_anchor(at + a * Vec3(5, 0, 4)), anchor(set, bob, {-a, 0, 0})});
  Outcome out;
  const Seen seen = run(ladder, loop, seconds, frame);
  for (const Index body : alive(set)) out.places.push_back((set.pose(body).position - at) / a);
  out.joint_gap = seen.joint_gap / a;
  out.unconverged = seen.unconverged;
  return out;
}

double difference(const Outcome& x, const Outcome& y) {
  double out = 0;
  for (std::size_t k = 0; k < x.places.size(); ++k) out = most(out, (x.places[k] - y.places[k]).norm());
  return out;
}

}  // namespace

void far_away(Ladder& ladder) {
  const double seconds = ladder.is_quick() ? 1 : 5;
  Outcome here;
  for (const double x : {0., 1e3, 1e4, 1e5, 1e6, 1e7, 1e8})
    ladder.rung(format("%g m from the origin", x), [&]() -> Marks {
      const Outcome there = standard(ladder, 1, 1, {x, -x, 0}, seconds);
      if (x == 0) here = there;
      return {{"change (m)", difference(here, there), 1e-6, 1e-8},
              {"joint gap (m)", there.joint_gap, 0.1, 0.1}};
    });
}

// The same in single precision: the places of bodies are kept in double, or they would have an ulp of 1e-3 m
// at 1e4 m and of 0.06 m at 1e6 m. Speeds of 4 to 8 m/s are rounded by 2.4e-7 m/s a step; after 5 s, 300
// steps, that makes 5 · 2.4e-7 √300 = 2e-5 m.
void far_away_in_float(Ladder& ladder) {
  const double seconds = ladder.is_quick() ? 1 : 5;
  Outcome here;
  for (const double x : {0., 1e3, 1e4, 1e5, 1e6})
    ladder.rung(format("%g m from the origin", x), [&]() -> Marks {
      const Outcome there = standard<RigidBodiesF>(ladder, 1, 1, {x, -x, 0}, seconds, 1e-5);
      if (x == 0) here = there;
      return {{"change (m)", difference(here, there), 1e-3, 2e-5},
              {"joint gap (m)", there.joint_gap, 0.1, 0.1}};
    });
}

void scale(Ladder& ladder) {
  const double seconds = ladder.is_quick() ? 1 : 5;
  Outcome unit;
  struct Units {
    double length, mass;
  };
  for (const auto& [a, b] :
       {Units{1, 1}, {1, 1e-6}, {1, 1e6}, {1e-1, 1}, {1e1, 1}, {1e-2, 1}, {1e2, 1}, {1e-4, 1e-6}, {1e4, 1e6}})
    ladder.rung(format("length × %g, mass × %g", a, b), [&, a = a, b = b]() -> Marks {
      const Outcome scaled = standard(ladder, a, b, Vec3::Zero(), seconds);
      if (a == 1 && b == 1) unit = scaled;
      return {{"change / size", difference(unit, scaled), 1e-3, 1e-9},
              {"joint gap / size", scaled.joint_gap, 0.1, 0.1},
              {"steps not converged", double(scaled.unconverged), unbounded, 0}};
    });
}

}  // namespace ladders
