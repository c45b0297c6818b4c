// HC-23, HC-27: paradoxes, drawers, arches.
#include "rows.hpp"
#include "watch.hpp"

#include <delassus/solvers/proximal_newton.hpp>

#include <numbers>

namespace ladders {

namespace {

using std::numbers::pi;

/// λ of a contact in a plane, normal and along x, from its W and the velocity without it: open, stick or one
/// of two ways of slip, by trying.
Vec<2> planar_coulomb(const Mat<2, 2>& W, const Vec<2>& b, double mu) {
  if (b[0] >= 0) return Vec<2>::Zero();
  const double det = W(0, 0) * W(1, 1) - W(0, 1) * W(1, 0);
  const Vec<2> stick(-(W(1, 1) * b[0] - W(0, 1) * b[1]) / det, -(W(0, 0) * b[1] - W(1, 0) * b[0]) / det);
  if (stick[0] >= 0 && std::abs(stick[1]) <= mu * stick[0]) return stick;
  for (const double way : {-1., 1.}) {
    const double n = -b[0] / (W(0, 0) + way * mu * W(0, 1));
    const double slip = b[1] + (W(1, 0) + way * mu * W(1, 1)) * n;
    if (n >= 0 && way * slip <= 0) return {n, way * mu * n};
  }
  return stick;
}

}  // namespace

// A rod of a metre leans on the ground and is pushed along on its tip: Painlevé's. The impulse of the first
// step.
void painleve(Ladder& ladder) {
  struct Case {
    double degrees, friction, h;
  };
  for (const auto& [degrees, friction, h] : {Case{45, 0.5, 1e-2},
                                             {45, 2, 1e-2},
                                             {60, 1, 1e-3},
                                             {60, 2, 1e-3},
                                             {60, 2, 1e-4},
                                             {70, 3, 1e-4},
                                             {80, 5, 1e-4},
                                             {60, 2, 1e-6}})
    ladder.rung(format("%g degrees, friction %g, h = %g s", degrees, friction, h),
                [&, degrees = degrees, friction = friction, h = h]() -> Marks {
                  double off = 0, slack = 0;
                  for (const double way : {-1., 1.}) {
                    AnimationLoop loop{World{RigidBodies{}},
                                       Constraints{Contact{Coulomb{.friction = friction}}},
                                       AcceleratedGaussSeidel{.tolerance = 1e-13, .max_iterations = 100000}};
                    auto& set = bodies<RigidBodies>(loop.world());
                    set.add_fixed(HalfSpace{});
                    const double lean = degrees * pi / 180, radius = 0.01;
                    const Vec3 along(std::cos(lean), 0, std::sin(lean));
                    const auto rod = set.add({.position = 0.5 * along + Vec3(0, 0, radius),
                                              .orientation = frame_along(along),
                                              .velocity = {3 * way, 0, 0},
                                              .mass = 1.0,
                                              .inertia = Mat3(Vec3(1. / 12, 1. / 12, 1e-4).asDiagonal()),
                                              .shape = Capsule{radius, 1}});
                    // The tip is at arm from the centre: v_x − ω_y … of a plane, ω about y, x' = ω z, z' = −ω
                    // x.
                    const double x = -0.5 * along.x(), z = -0.5 * along.z() - radius;
                    Mat<2, 2> W;
                    W(0, 0) = 1 + 12 * x * x, W(1, 1) = 1 + 12 * z * z;
                    W(0, 1) = W(1, 0) = -12 * x * z;
                    const Vec<2> wanted = planar_coulomb(W, {-g * h, 3 * way}, friction);
                    loop.step(h);
                    Vec3 impulse = Vec3::Zero();
                    for (const ContactResult& c : loop.contacts())
                      impulse += (c.record.b.block == rod.index ? 1. : -1.) * c.impulse;
                    off = most(off, (Vec<2>(impulse.z(), impulse.x()) - wanted).norm() / wanted.norm());
                    const Seen seen = run(ladder, loop, std::min(2., 2000 * h), h);
                    slack = most(slack, seen.gain);
                  }
                  return {{"impulse against the closed form", off, 0.01, 0.01},
                          {"energy gained / energy of the scene", slack / (4.5 + g / 2), 0.01, 0.01}};
                });
}

// A box of a metre, kept in a plane, in a slot with a millimetre of play is pushed along at 0.4 m from its
// middle, without gravity. Two opposite corners bear N = F e/L each, so that it goes with (1 − 2 μ e/L) F/m,
// or jams from μ = L/2e = 1.25.
void drawer(Ladder& ladder) {
  for (const double mu : {0.5, 1., 1.2, 1.3, 2., 10.})
    ladder.rung(format("friction %g", mu), [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}, Planar{}}};
      auto& set = bodies<RigidBodies>(loop.world());
      set.gravity.setZero();
      for (const double side : {-1., 1.}) set.add_fixed(HalfSpace{Vec3(0, -side, 0)}, {0, side * 0.5005, 0});
      const auto box = set.add({.mass = 1.0, .shape = Box{1, 1, 1}});
      loop.add(Planar::Item{world_anchor({0, 0, 0}), anchor(set, box)});
      const double force = 10, arm = 0.4, h = 0.01;
      const auto pushed = [&](double seconds) {
        run(ladder, loop, seconds, h, [&](int) {
          set.apply_force(box, {force, 0, 0}, set.position(box) + Vec3(0, arm, 0));
        });
      };
      pushed(1);  // it turns until its corners meet the walls
      const double speed = set.velocity(box).x(), at = set.position(box).x();
      pushed(1);
      const double rate = set.velocity(box).x() - speed, wanted = std::max(0., 1 - 2 * mu * arm) * force;
      return {{"acceleration against the closed form / F/m", std::abs(rate - wanted) / force, 0.05, 0.01},
              {"way where it jams (m)", wanted > 0 ? 0 : std::abs(set.position(box).x() - at), 1e-3, 1e-6},
              {"kinetic energy / what F may do", set.velocity(box).squaredNorm() / 2 / (force * force * 2),
               1.01, 1.01}};
    });
}

namespace {

struct Arch {
  double times;  ///< the least thickness
  int boxes = 0;
  double shift = 0;  ///< of a support, m
};

/// A half circle of twenty wedges, mean radius 10 m, on the ground's friction; Milankovitch's least thickness
/// is 0.1075 of the radius for radial joints.
void climb_arches(Ladder& ladder, std::initializer_list<Arch> arches) {
  constexpr int count = 20;
  for (const Arch& arch : arches) {
    const std::string also = arch.boxes       ? ", four boxes on it"
                             : arch.shift > 0 ? format(", a support goes %g m", arch.shift)
                                              : "";
    ladder.rung(format("%g × the least thickness", arch.times) + also, [&]() -> Marks {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.8}}},
                         ProximalNewton{}};
      auto& set = bodies<RigidBodies>(loop.world());
      const double half = 0.5 * arch.times * 0.1075 * 10, step = pi / count;
      RigidBodies::Handle support;
      if (arch.shift > 0) {
        set.add_fixed(Box{4, 4, 1}, {-10, 0, -0.5});
        support = set.add({.position = {10, 0, -0.5}, .shape = Box{4, 4, 1}, .motion = Motion::kinematic});
      } else {
        set.add_fixed(HalfSpace{});
      }
      std::vector<RigidBodies::Handle> stones;
      for (int k = 0; k < count; ++k) {
        std::vector<Vec3> corners;
        for (const double angle : {k * step, (k + 1) * step})
          for (const double r : {10 - half, 10 + half})
            for (const double y : {-1., 1.}) corners.push_back({r * std::cos(angle), y, r * std::sin(angle)});
        const ConvexHull hull(corners);
        stones.push_back(set.add({.position = hull.centroid(), .density = 2000., .shape = hull}));
      }
      for (int k = 0; k < arch.boxes; ++k)
        set.add(
            {.position = {0, 0, 10 + half + 0.25 + 0.5 * k}, .density = 2000., .shape = Box{0.5, 0.5, 0.5}});
      const auto top = stones[count / 2];
      const double start = set.position(top).z();
      double given_way = 0;
      const Seen seen = run(ladder, loop, ladder.is_quick() ? 0.3 : 10, frame, [&](int n) {
        if (n < 60 && arch.shift > 0) set.move_to(support, {10 + (given_way += arch.shift / 60), 0, -0.5});
      });
      const double drop = (start - set.position(top).z() - arch.shift) / 10;
      const double wrong = arch.times > 1 ? drop : 0.5 - drop;  // it must fall, or must not
      return {{"drop of the crown / radius, or what is missing of a fall", wrong, 0.01,
               arch.times > 1 ? 1e-3 : 0.01},
              energy_mark(seen, 2000 * 2 * half * 2 * pi * 10 * g * 6)};
    });
  }
}

}  // namespace

void arch(Ladder& ladder) { climb_arches(ladder, {{3}, {2}, {1.5}, {1.2}, {1.2, 4}, {1.07}, {0.93}}); }
// A hundredth of the span is lost, 1 s long: the arch opens into three hinges and stands.
void arch_that_spreads(Ladder& ladder) { climb_arches(ladder, {{2, 0, 0.2}, {1.5, 0, 0.2}, {1.2, 0, 0.2}}); }

}  // namespace ladders
