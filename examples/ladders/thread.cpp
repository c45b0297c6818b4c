// HC-32: a nut on a bolt, by the contacts of their meshes and by a joint.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/collision/with_meshes.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>

#include <array>
#include <numbers>
#include <vector>

namespace ladders {

namespace {

using std::numbers::pi;

// M12 × 1.75, basic profile: flanks 60° apart, the crest P/8 and the root P/4 wide, 5/8 H deep.
constexpr double pitch = 1.75e-3, major_radius = 6e-3, depth = 0.625 * 0.8660254037844386 * pitch,
                 pitch_radius = major_radius - 0.6 * depth, flank = pi / 6;
constexpr double bore = 2e-3, nut_radius = 9e-3;

/// The solid between the thread, `grown` wider, and a cylinder of radius `back`: a nut, or a bolt with a
/// bore. A helical surface of `segments` strips a turn, its ends ramps; from z = 0 to pitch · (turns + 1),
/// and then moved down by half of that if `is_centred`.
TriangleMesh thread(double grown, double back, int segments, int turns, bool is_centred) {
  const double outer = major_radius + grown, inner = outer - depth;
  const bool is_nut = back > outer;
  const std::array<Vec<2>, 5> profile{Vec<2>(inner, 0), Vec<2>(inner, 0.25 * pitch),
                                      Vec<2>(outer, 0.5625 * pitch), Vec<2>(outer, 0.6875 * pitch),
                                      Vec<2>(back, 0)};
  const int strips = turns * segments, last = strips + segments;
  std::vector<Vec3> vertices;
  for (int i = 0; i <= last; ++i)
    for (const Vec<2>& p : profile) {
      const double angle = 2 * pi * (i % segments) / segments,
                   height = is_centred ? 0.5 * pitch * (turns + 1) : 0;
      vertices.push_back(
          {p[0] * std::cos(angle), p[0] * std::sin(angle), p[1] + pitch * i / segments - height});
    }
  const auto front = [&](int i, int k) { return Index(k < 4 ? 5 * i + k : 5 * (i + segments)); };
  const auto behind = [](int i) { return Index(5 * i + 4); };

  std::vector<std::array<Index, 3>> triangles;
  const auto add = [&](Index a, Index b, Index c) {
    triangles.push_back({a, is_nut ? c : b, is_nut ? b : c});
  };
  const auto add_flat = [&](Index a, Index b, Index c, Index d) {
    add(a, b, c);
    add(a, c, d);
  };
  for (int i = 0; i < strips; ++i) {
    for (int k = 0; k < 4; ++k) add_flat(front(i, k), front(i + 1, k), front(i + 1, k + 1), front(i, k + 1));
    add_flat(behind(i), behind(i + segments), behind(i + segments + 1), behind(i + 1));
  }
  for (int i = 0; i < segments; ++i) {
    const int top = strips + i;
    add_flat(front(i, 0), behind(i), behind(i + 1), front(i + 1, 0));
    add_flat(front(top, 0), front(top + 1, 0), behind(top + 1), behind(top));
  }
  for (int k = 0; k < 4; ++k) {
    add(behind(0), front(0, k), front(0, k + 1));
    add(behind(strips), front(strips, k + 1), front(strips, k));
  }
  add(behind(0), front(0, 4), behind(segments));
  add(behind(strips), behind(last), front(strips, 4));
  std::vector<Index> place(vertices.size(), -1);
  std::vector<Vec3> used;  // the profile's last turn has its first points alone
  for (auto& t : triangles)
    for (Index& v : t) {
      if (place[v] < 0) place[v] = Index(used.size()), used.push_back(vertices[v]);
      v = place[v];
    }
  return TriangleMesh(used, triangles);
}

/// The shape of the bolt and of the nut in a loop's collision.
struct Threads {
  static constexpr int nut_turns = 5;
  static constexpr double half_nut = 0.5 * pitch * (nut_turns + 1), mass = 0.017;

  Threads(auto& meshes, double play, int free_turns, int fineness)
      : clearance(play),
        nut_segments(9 * fineness),
        bolt(meshes.add(thread(0, bore, 8 * fineness, free_turns + nut_turns + 4, false))),
        nut(meshes.add(thread(play, nut_radius, nut_segments, nut_turns, true))) {}

  /// The middle of a nut that has turned so often (whole turns) and lies on the flanks below it: lower by
  /// what the clearance leaves, higher by as much as the middles of its flat strips are nearer to the axis.
  double seat(int turn) const {
    return half_nut + pitch * turn -
           std::tan(flank) * (clearance - major_radius * (1 - std::cos(pi / nut_segments)));
  }
  /// Of a ring as high, kg·m².
  static Mat3 inertia() {
    const double square = nut_radius * nut_radius + pitch_radius * pitch_radius,
                 across = square / 4 + half_nut * half_nut / 3;
    return mass * Vec3(across, across, square / 2).asDiagonal();
  }

  double clearance;
  int nut_segments;
  Shape bolt, nut;
};

auto threaded_loop(double friction) {
  return AnimationLoop{
      World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = friction}}, Motor<Turn>{}},
      AcceleratedGaussSeidel{.tolerance = 1e-4}, WithMeshes{NativeCollision{.margin = 5e-5}}};
}

/// How far a body has turned about z since it was first looked at, rad, over all turns.
class TurnAboutZ {
 public:
  double operator()(const Quat& q) {
    const double now = 2 * std::atan2(q.z(), q.w());
    return angle_ += std::remainder(now - angle_, 2 * pi);
  }

 private:
  double angle_ = 0;
};

void screw_on(Ladder& ladder, double clearance, int turns, double friction, int steps) {
  ladder.rung(
      format("%d × 360°, clearance %g mm, friction %g, %d steps a turn", turns, 1e3 * clearance, friction,
             steps),
      [&]() -> Marks {
        auto loop = threaded_loop(friction);
        auto& set = bodies<RigidBodies>(loop.world());
        const Threads shapes(loop.template get<WithMeshes<NativeCollision>>(), clearance, turns, 3);
        set.add_fixed(shapes.bolt);
        const double start = shapes.seat(2);
        const auto nut = set.add({.position = {0, 0, start},
                                  .velocity = {0, 0, pitch},
                                  .angular_velocity = {0, 0, 2 * pi},
                                  .mass = Threads::mass,
                                  .inertia = Threads::inertia(),
                                  .shape = shapes.nut});
        loop.add(Motor<Turn>::Item{.a = world_anchor({0, 0, 0}), .b = anchor(set, nut), .speed = 2 * pi});
        const double until = ladder.is_quick() ? 0.25 : turns;
        double tilt = 0;
        const Seen seen = run(ladder, loop, until, 1.0 / steps, [&](int) {
          const Vec3 axis = set.orientation(nut) * Vec3(Vec3::UnitZ());
          tilt = most(tilt, axis.template head<2>().norm());
        });
        return {{"way against pitch × turns", std::abs((set.position(nut).z() - start) / (pitch * until) - 1),
                 0.05, 5e-3},
                {"penetration / pitch", seen.penetration / pitch, 0.05, 0.01},
                {"tilt / clearance over half its height", tilt * Threads::half_nut / clearance, 1, 0.5},
                {"steps not converged", double(seen.unconverged), 0.01 * steps * turns, 0}};
      });
}

/// How far a nut that nothing drives goes down in t seconds from rest, m, where it touches at the radius r:
/// W = m (g − a) on the thread turns it by W r tan(λ − ρ), tan λ = P/(2π r), tan ρ = μ/cos(flank).
double way_down(double r, double friction, double t) {
  const double lead = std::atan(pitch / (2 * pi * r)), angle = std::atan(friction / std::cos(flank));
  const double arm = r * std::tan(lead - angle), rise = pitch / (2 * pi), inertia = Threads::inertia()(2, 2);
  return std::max(0.0, 0.5 * t * t * rise * Threads::mass * g * arm / (inertia + Threads::mass * rise * arm));
}

void let_go(Ladder& ladder, double share) {
  const double friction = share * pitch / (2 * pi * pitch_radius) * std::cos(flank);
  ladder.rung(format("nobody turns it, friction %g of tan(lead) cos(flank)", share), [&]() -> Marks {
    auto loop = threaded_loop(friction);
    auto& set = bodies<RigidBodies>(loop.world());
    const Threads shapes(loop.template get<WithMeshes<NativeCollision>>(), 0.2e-3, 4, 3);
    set.add_fixed(shapes.bolt);
    const double start = shapes.seat(6), seconds = 0.25;
    const auto nut = set.add({.position = {0, 0, start},
                              .mass = Threads::mass,
                              .inertia = Threads::inertia(),
                              .shape = shapes.nut});
    TurnAboutZ turned;
    double angle = 0;
    const Seen seen =
        run(ladder, loop, seconds, 1.0 / 3840, [&](int) { angle = turned(set.orientation(nut)); });
    const double way = start - set.position(nut).z(), least = way_down(major_radius, friction, seconds),
                 most_way = way_down(major_radius - depth, friction, seconds);
    const double outside = std::max({0.0, least - way, way - most_way});
    return {{share < 1 ? "way beyond what the contacts' radii allow, of the least" : "turn (rad)",
             share < 1 ? outside / least : std::abs(angle), share < 1 ? 0.2 : 1e-2, share < 1 ? 0.05 : 1e-4},
            {"penetration / pitch", seen.penetration / pitch, 0.05, 0.01},
            {"steps not converged", double(seen.unconverged), 9.6, 0},
            energy_mark(seen, Threads::mass * g * pitch)};
  });
}

}  // namespace

// A nut M12 that is turned up a bolt at a turn a second by a motor about the axis; nothing but the contacts
// of the two meshes guides it in the other five ways. Its own weight loads it, so that it lies on the same
// flanks all the way, and no play is taken off its way. Then it is let go: it must stay where the friction is
// above tan(lead) cos(flank), and run down as the closed form says below that. Bolt and nut have 24 and 27
// flat strips a turn: with as many of both, corners would lie in corners, and hold the nut without friction.
void thread_by_contacts(Ladder& ladder) {
  for (const int turns : {1, 10})
    for (const double clearance : {0.3e-3, 0.2e-3, 0.1e-3}) screw_on(ladder, clearance, turns, 0.2, 120);
  screw_on(ladder, 0.1e-3, 1, 0, 120);
  for (const double share : {0., 0.75, 1.25}) let_go(ladder, share);
  for (const double clearance : {0.3e-3, 0.2e-3, 0.1e-3}) screw_on(ladder, clearance, 100, 0.2, 60);
}

// A nut that is turned on a thread of 1.75 mm.
void screw(Ladder& ladder) {
  for (const double turns : {1., 10., 100.})
    ladder.rung(format("%g turns", turns), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Screw{}, Motor<Turn>{}}};
      auto& set = bodies<RigidBodies>(loop.world());
      const auto nut = set.add({.mass = 0.02, .inertia = Mat3(1e-6 * Mat3::Identity())});
      const Anchor bolt = world_anchor({0, 0, 0}), end = anchor(set, nut);
      loop.add(Screw::Item{.a = bolt, .b = end, .pitch = 1.75e-3});
      loop.add(Motor<Turn>::Item{.a = bolt, .b = end, .speed = 2 * pi});
      const double until = ladder.is_quick() ? 1 : turns;
      run(ladder, loop, until, 0.01);
      return {
          {"way against pitch × turns", std::abs(set.position(nut).z() / (1.75e-3 * until) - 1), 0.05, 5e-3}};
    });
}

}  // namespace ladders
