/// Integrators that solve a whole step: joints and bodies together by Newton's method, and without joints.
#include <delassus/bodies/anchor_at.hpp>
#include <delassus/bodies/particles.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/constraints/joints/distance_joint.hpp>
#include <delassus/constraints/joints/hinge.hpp>
#include <delassus/integrators/lie_poisson.hpp>
#include <delassus/steppers/bdf2.hpp>
#include <delassus/steppers/generalized_alpha.hpp>
#include <delassus/steppers/newmark.hpp>
#include <delassus/steppers/newton_midpoint.hpp>
#include <delassus/steppers/rattle.hpp>
#include <delassus/steppers/runge_kutta4.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

template <class Integrator>
auto chain() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, Integrator{}};
  add_chain(loop, 3, 0, [&](const Anchor& a, const Anchor& b) { loop.add(BallJoint::Item{a, b}); });
  return loop;
}
/// A point on a rod below a turning box.
auto box_and_point() {
  AnimationLoop loop{World{RigidBodies{}, Particles{}}, Constraints{DistanceJoint{}}, RungeKutta4{}};
  auto& rigid = rigid_of(loop);
  auto& points = bodies<Particles>(loop.world());
  const auto box = rigid.add(
      {.position = {0.3, 0, -0.4}, .angular_velocity = {1, 0, 3}, .mass = 2.0, .shape = Box{0.3, 0.2, 0.1}});
  const auto bob = points.add({.position = {1, 0, -0.4}, .velocity = {0, 1, 0}, .mass = 0.5});
  loop.add(DistanceJoint::Item{anchor(rigid, box, {0, 0, 0.05}), world_anchor({0.3, 0, 0.15}), 0.5});
  loop.add(DistanceJoint::Item{anchor(points, bob), anchor(rigid, box, {0.1, 0, 0}), 0.6});
  return loop;
}
/// Two points on damped springs, pulled round; halfway one of them is put elsewhere.
template <class Integrator>
auto springs() {
  AnimationLoop loop{World{Particles{}}, Integrator{}};
  auto& set = rigid_of(loop);
  const auto first = set.add({.position = {1, 0, 0}, .mass = 1.0}),
             second = set.add({.position = {1.5, 0, 0.5}, .mass = 0.5});
  set.add_spring(first, Vec3(0, 0, 0), 80, 0.5, 0.9);
  set.add_spring(first, second, 60, 1, 0.6);
  return loop;
}
void pull(auto& loop, int n) {
  auto& set = rigid_of(loop);
  if (n == 60) set.place(set.handle(1), {1, 0.4, 0});
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("integrators");
  all.add("newton_midpoint_chain", {.h = 0.01}, chain<NewtonMidpoint>);
  all.add("rattle_chain", {.h = 0.01}, chain<Rattle>);
  all.add("runge_kutta_box_and_point", {.h = 0.01}, box_and_point);
  const auto act = [](auto& loop, int n) { pull(loop, n); };
  all.add("generalized_alpha_springs", {.h = 0.02, .change = 0.2}, springs<GeneralizedAlpha>, act);
  all.add("newmark_springs", {.h = 0.02, .change = 0.2}, springs<Newmark>, act);
  all.add("bdf2_springs", {.h = 0.02, .change = 0.2}, springs<Bdf2>, act);
  all.add(
      "lie_poisson_tops", {.h = 0.02},
      [] {
        AnimationLoop loop{World{RigidBodies{}}, LiePoisson{}};
        auto& set = rigid_of(loop);
        for (int k = 0; k < 3; ++k)
          set.add({.velocity = {0, 0, 3},
                   .angular_velocity = {1, 2. + k, 3},
                   .mass = 1.0,
                   .shape = Box{1, 2, 3}});
        return loop;
      },
      [](auto& loop, int n) {
        rigid_of(loop).apply_torque(rigid_of(loop).handle(n % 3), {0, 1, 0.1 * n});
      });
  return all.main(argc, argv);
}
