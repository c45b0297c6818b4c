/// Particles with rigid bodies, and a user's own parts: ropes, springs, an integrator and a listener of one's
/// own.
#include <delassus/bodies/particles.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include <algorithm>
#include <array>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

/// Pulls and never pushes: φ = |x_a − x_b| − L ≤ 0, λ ≤ 0.
struct Rope {
  static constexpr int rows = 1;
  static constexpr std::array kinds{RowKind::upper};
  struct Item {
    Anchor a, b;
    double length;
  };
  void linearize(const Item& item, const auto& world, auto row) const {
    const Vec3 a = world.point(item.a), b = world.point(item.b), e = (a - b).normalized();
    row.end(item.a, a).along(0, e);
    row.end(item.b, b).along(0, -e);
    row.phi(0, (a - b).norm() - item.length);
  }
  Vec<1> solve_local(const Item&, const Mat<1, 1>& W, const Vec<1>& b) const { return Vec<1>(std::min(0.0, -b[0] / W(0, 0))); }
};

/// Symplectic Euler in a medium that takes the share `drag` of the velocity per second.
struct DraggedEuler {
  using plays = role::Integrator;
  double drag = 0;

  SystemScale scale(double h) const { return {.mass = 1 + h * drag}; }
  void impulse(const auto& set, auto& p, double h) const {
    set.add_forces(p);
    set.add_mass_times_velocity(p, -drag);
    for (auto& x : p) x *= h;
  }
  void advance(auto& set, double h) const { set.advance(h); }
};

/// The velocities it sees when the impulses are known.
struct Ear {
  using plays = role::Listener;
  using listens = Listens<stage::Solve, stage::Correct>;
  double solves = 0, speed = 0;
  void after(stage::Solve, const auto&) { ++solves; }
  void after(stage::Correct, const auto& loop) {
    speed = 0;
    for (const auto& v : loop.world().template set<0>().v_next) speed += v.norm();
  }
};

auto ropes() {
  return AnimationLoop{World{RigidBodies{}, Particles{}}, Constraints{Rope{}}, DraggedEuler{.drag = 0.3},
                       Ear{}};
}
auto springs() {
  return AnimationLoop{World{Particles{}}, Constraints{DistanceJoint{}}, ImplicitEuler{.rayleigh_mass = 0.2},
                       GaussSeidel{.tolerance = 1e-12, .max_iterations = 10000}};
}
/// A net of four knots on springs between two rods.
void add_net(auto& loop) {
  auto& set = rigid_of(loop);
  std::vector<Particles::Handle> p;
  for (int i = 0; i < 4; ++i)
    p.push_back(set.add({.position = {0.3 * i, 0.05 * i * i, 0}, .mass = 0.1 + 0.05 * i}));
  for (int i = 0; i < 3; ++i) set.add_spring(p[i], p[i + 1], 50, 0.5, 0.25);
  set.add_spring(p[1], Vec3(0.3, 1, 0), 20, 0.1);
  loop.add(DistanceJoint::Item{anchor(set, p[0]), world_anchor({0, 0, 0.5}), 0.5});
  loop.add(DistanceJoint::Item{anchor(set, p[3]), world_anchor({0.9, 0.45, 0.5}), 0.5});
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("particles");
  // A stone falls until its rope is taut, a box on another rope swings it.
  all.add(
      "ropes_own_parts", {.h = 0.01},
      [] {
        auto loop = ropes();
        auto& rigid = rigid_of(loop);
        auto& stones = bodies<Particles>(loop.world());
        const auto box = rigid.add({.position = {0.5, 0, 0}, .mass = 3.0, .shape = Box{0.2, 0.2, 0.2}});
        const auto stone = stones.add({.position = {0.4, 0.3, 0.2}, .mass = 1.0});
        loop.add(Rope::Item{anchor(rigid, box, {0, 0, 0.1}), world_anchor({0, 0, 0.6}), 1});
        loop.add(Rope::Item{anchor(stones, stone), anchor(rigid, box, {0.1, 0, -0.1}), 0.9});
        return loop;
      },
      Nobody{}, [](const auto& loop, const auto& f) { f(loop.template get<Ear>().speed); });
  all.add("net_implicit_euler", {.h = 0.01}, [] {
    auto loop = springs();
    add_net(loop);
    return loop;
  });
  // Two beads, one hung on a spring with a damper, one that a damper alone slows down.
  all.add("beads_on_dampers", {.h = 0.01}, [] {
    auto loop = springs();
    auto& set = rigid_of(loop);
    const auto hung = set.add({.position = {0, 0.2, 0}, .velocity = {1, 0, 0}, .mass = 0.4});
    const auto slowed = set.add({.position = {1, 0, 0}, .velocity = {0, 2, 0}, .mass = 0.3});
    loop.add(DistanceJoint::Item{anchor(set, hung), world_anchor({0, 0, 0.6}), 0.5, 80.0, 3.0});
    loop.add(DistanceJoint::Item{anchor(set, slowed), anchor(set, hung), 1.0, 0.0, 2.0});
    return loop;
  });
  return all.main(argc, argv);
}
