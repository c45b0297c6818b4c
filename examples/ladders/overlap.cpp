// HC-13, HC-16: bodies that start in each other, and normals that nobody can tell.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/collision/queries.hpp>

#include <utility>
#include <vector>

namespace ladders {

namespace {

/// A pyramid of six rows whose boxes overlap by a share of their size.
template <class Stabilisation>
void part_pyramids(Ladder& ladder, const Stabilisation& stabilisation) {
  for (const double share : {0.1, 0.25, 0.5, 0.99})
    ladder.rung(format("pyramid, boxes overlap by %g", share), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}, stabilisation};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      const double step = 1 - share;
      for (int row = 0; row < 6; ++row)
        for (int k = 0; k < 6 - row; ++k)
          set.add({.position = {step * (k + 0.5 * row), 0, 0.5 + step * row},
                   .mass = 1.0,
                   .shape = Box{1, 1, 1}});
      double lowest = 0, late = 0, fastest = 0;
      std::vector<Vec3> before;
      for (const Index b : alive(set)) before.push_back(set.pose(b).position);
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.5 : 4, frame, [&](int n, const Seen& now) {
        for (const Index b : alive(set))
          if (set.moves(b)) lowest = most(lowest, -set.pose(b).position.z());
        std::size_t k = 0;  // what moves a body is its velocity, and what the projection adds to its place
        for (const Index b : alive(set)) {
          const Vec3 at = set.pose(b).position;
          fastest = most(fastest, (at - std::exchange(before[k++], at)).norm() / frame);
        }
        if (n >= 120) late = most(late, now.last_penetration);
      });
      return {{"speed (m/s)", seen.speed, 2, 1},
              {"way a second (m/s)", fastest, unbounded, unbounded},
              {"penetration after 2 s / size", late, unbounded, 0.01},
              {"centre below the ground (m)", lowest, 0, 0}};
    });
}

/// Bodies with one centre, 2 m above the ground. For 2 s nothing pulls them, and what speed they have is that
/// with which they part; then they fall and lie in a heap for 2 s more.
template <class Stabilisation>
void part_crowds(Ladder& ladder, const Stabilisation& stabilisation) {
  struct Case {
    int count;
    Shape shape;
    const char* name;
  };
  for (const Case& c : {Case{100, Sphere{0.5}, "spheres"},
                        {30, Box{1, 1, 1}, "boxes"},
                        {100, Box{1, 1, 1}, "boxes"},
                        {1000, Sphere{0.5}, "spheres"}})
    ladder.rung(format("%d %s in one place", c.count, c.name), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                         MatrixFreeCompliance{}, AcceleratedSweeps{.tolerance = 1e-3, .max_iterations = 300},
                         stabilisation};
      auto& set = bodies<RigidBodies>(loop.world());
      set.add_fixed(HalfSpace{});
      for (int k = 0; k < c.count; ++k) set.add({.position = {0, 0, 2}, .mass = 1.0, .shape = c.shape});
      double lowest = 0;
      const auto watch = [&](int) {
        for (const Index b : alive(set))
          if (set.moves(b)) lowest = most(lowest, -set.pose(b).position.z());
      };
      const Vec3 gravity = std::exchange(set.gravity, Vec3::Zero());
      const Seen apart = run(ladder, loop, ladder.is_quick() ? 0.1 : 2, frame, watch);
      set.gravity = gravity;
      run(ladder, loop, ladder.is_quick() ? 0.1 : 2, frame, watch);
      return {{"speed (m/s)", apart.speed, 2, 1},
              {"penetration after 2 s / size", apart.last_penetration, unbounded,
               ladder.is_quick() ? unbounded : 0.01},
              {"centre below the ground (m)", lowest, 0, 0}};
    });
}

struct Degenerate {
  const char* name;
  Shape a, b;
  Vec3 offset;
};

}  // namespace

void overlap(Ladder& ladder) { part_pyramids(ladder, Baumgarte{}); }
void overlap_projected(Ladder& ladder) { part_pyramids(ladder, PositionProjection{}); }
void one_place(Ladder& ladder) { part_crowds(ladder, Baumgarte{}); }
void one_place_projected(Ladder& ladder) { part_crowds(ladder, PositionProjection{}); }

void no_normal(Ladder& ladder) {
  const Degenerate cases[] = {
      {"spheres with one centre", Sphere{0.5}, Sphere{0.5}, {0, 0, 0}},
      {"sphere's centre in a box's centre", Box{1, 1, 1}, Sphere{0.3}, {0, 0, 0}},
      {"sphere's centre on a box's edge", Box{1, 1, 1}, Sphere{0.3}, {0.5, 0.5, 0}},
      {"sphere's centre on a box's corner", Box{1, 1, 1}, Sphere{0.3}, {0.5, 0.5, 0.5}},
      {"boxes with one centre", Box{1, 1, 1}, Box{1, 1, 1}, {0, 0, 0}},
      {"capsules on one line", Capsule{0.2, 1}, Capsule{0.2, 1}, {0, 0, 0}},
      {"cylinders with one axis", Cylinder{0.3, 1}, Cylinder{0.3, 1}, {0, 0, 0.2}}};
  for (const Degenerate& c : cases)
    ladder.rung(c.name, [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      const auto a = set.add({.mass = 1.0, .shape = c.a});
      const auto b = set.add({.position = c.offset, .mass = 2.0, .shape = c.b});
      const Seen seen = run(ladder, loop, 4, frame);
      const double deep = std::max(0.0, -separation(set, a, set, b).distance);
      const double size = std::max(1e-300, 3 * seen.speed);
      return {{"overlap after 4 s (m)", deep, 0.01, 1e-3},
              {"speed (m/s)", seen.speed, 2, 1.01},
              {"momentum", momentum(set).norm() / size, 1e-9, 1e-12},
              {"angular momentum", angular_momentum(set).norm() / size, 1e-9, 1e-12}};
    });
  // Two bodies on one point and a joint that keeps them at no distance, one of them hit.
  ladder.rung("distance joint of no length", [&]() -> Marks {
    AnimationLoop loop{World{RigidBodies{}}, Constraints{DistanceJoint{}}};
    auto& set = bodies<RigidBodies>(loop.world());
    set.gravity.setZero();
    const Mat3 inertia = 0.1 * Mat3::Identity();
    const auto a = set.add({.velocity = {1, 0.5, 0}, .mass = 1.0, .inertia = inertia});
    const auto b = set.add({.mass = 2.0, .inertia = inertia});
    loop.add(DistanceJoint::Item{anchor(set, a), anchor(set, b)});
    const Vec3 start = momentum(set);
    const Seen seen = run(ladder, loop, 4, frame);
    return {{"gap after 4 s (m)", (set.position(a) - set.position(b)).norm(), 0.01, 1e-3},
            {"speed / at the start", seen.speed / std::sqrt(1.25), 2, 1.01},
            {"momentum", (momentum(set) - start).norm() / start.norm(), 1e-9, 1e-12},
            energy_mark(seen, 0.625)};
  });
}

}  // namespace ladders
