// HC-17: edges on edges, corners on corners.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/geometry/convex_hull.hpp>

#include <numbers>
#include <vector>

namespace ladders {

namespace {

using std::numbers::pi;

/// A box of 1 m and 1 kg that begins at rest at `height`, turned so, and is watched for five seconds: it
/// stays, or where it tips at last does not jump.
Marks rest(Ladder& ladder, auto& loop, double height, const Quat& turn, double inertia, bool tips) {
  auto& set = bodies<RigidBodies>(loop.world());
  const Vec3 place(0, 0, height);
  const auto box = set.add({.position = place,
                            .orientation = turn,
                            .mass = 1.0,
                            .inertia = Mat3(inertia * Mat3::Identity()),
                            .shape = Box{1, 1, 1}});
  double hop = 0, away = 0;
  const Seen seen = run(ladder, loop, ladder.is_quick() ? 1 : 5, frame, [&](int) {
    hop = most(hop, set.position(box).z() - height);
    away = most(away, (set.position(box) - place).norm());
  });
  Marks marks{{"hop / size", hop, 1e-3, 1e-6}, energy_mark(seen, g * 0.5)};
  if (!tips) marks.push_back({"way from its place / size", away, unbounded, 1e-6});
  return marks;
}

}  // namespace

// A box that lies on the edges of two thin wedges; one that stands on an edge across another's edge, and one
// that stands on a corner on another's corner. These two tip, from a push of the last digit within five
// seconds: they must not jump. With an inertia of 10⁴ kg·m² they have no time to tip, and must stay.
void edges(Ladder& ladder) {
  const auto loop_of = [] {
    return AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  };
  const double own = 1.0 / 6;  // of the box, kg·m²
  for (const double thickness : {0.1, 1e-2, 1e-3})
    ladder.rung(format("box on two knives, %g m thick", thickness), [&]() -> Marks {
      auto loop = loop_of();
      const double side = thickness / 2, depth = 0.2;
      const std::vector<Vec3> corners{{-side, -1, -depth}, {-side, 1, -depth}, {side, -1, -depth},
                                      {side, 1, -depth},   {0, -1, 0},         {0, 1, 0}};
      const ConvexHull knife(corners);
      for (const double x : {-0.3, 0.3})  // a hull's body is at its centroid
        bodies<RigidBodies>(loop.world()).add_fixed(knife, {x, 0, -2 * depth / 3});
      return rest(ladder, loop, 0.5, Quat::Identity(), own, false);
    });
  const double half_diagonal = std::sqrt(0.5), to_corner = std::sqrt(0.75);
  const Quat on_edge(Eigen::AngleAxisd(pi / 4, Vec3::UnitX())),
      across(Eigen::AngleAxisd(pi / 4, Vec3::UnitY())),
      on_corner = Quat::FromTwoVectors(Vec3(1, 1, 1), Vec3::UnitZ());
  const auto on_its_like = [&](const char* name, bool tips, double height, const Quat& below,
                               const Quat& above) {
    ladder.rung(format("box on %s%s", name, tips ? "" : ", slow to tip"), [&]() -> Marks {
      auto loop = loop_of();
      bodies<RigidBodies>(loop.world()).add_fixed(Box{1, 1, 1}, {0, 0, -height}, below);
      return rest(ladder, loop, height, above, tips ? own : 1e4, tips);
    });
  };
  for (const bool tips : {true, false}) {
    on_its_like("an edge across another's", tips, half_diagonal, across, on_edge);
    on_its_like("a corner on another's", tips, to_corner, on_corner, on_corner);
  }
}

}  // namespace ladders
