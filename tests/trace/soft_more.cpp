/// Soft bodies with other builders of W, other elements, a sheet, and the midpoint rule.
#include <delassus/compliance/lazy.hpp>
#include <delassus/compliance/precomputed.hpp>
#include <delassus/constraints/contact/contact.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/joints/ball_joint.hpp>
#include <delassus/fem/cloth.hpp>
#include <delassus/fem/elasticity/corotational.hpp>
#include <delassus/fem/elasticity/stable_neo_hookean.hpp>
#include <delassus/fem/hexahedral_fem.hpp>
#include <delassus/fem/tetrahedral_fem.hpp>
#include <delassus/geometry/box_mesh.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/integrators/implicit_midpoint.hpp>
#include <delassus/solvers/gauss_seidel.hpp>
#include <delassus/stabilisation/whole_violation.hpp>

#include "scenes.hpp"
#include "trace.hpp"

using namespace trace;

namespace {

using Soft = TetrahedralFem<Corotational>;
constexpr const char* no_factors = "the factor of an earlier A and the answers it gave";

/// A beam held at one end falls on the ground. The builders go on until rounding, so that a step does not
/// hang on their passes.
template <class Compliance>
auto beam() {
  AnimationLoop loop{World{RigidBodies{}, Soft{}}, Constraints{Contact{Coulomb{.friction = 0.4}}},
                     ImplicitEuler{.rayleigh_stiffness = 0.02},
                     Compliance{.violation = 1e-12, .tolerance = 1e-13, .max_passes = 200},
                     GaussSeidel{.tolerance = 1e-12, .max_iterations = 20000}};
  rigid_of(loop).add_fixed(HalfSpace{});
  rigid_of(loop).add({.position = {0.3, 0.05, 0.4}, .mass = 0.3, .shape = Sphere{0.06}});
  auto& soft = bodies<Soft>(loop.world());
  const auto b = soft.add({.mesh = box_mesh({0.4, 0.1, 0.1}, {2, 1, 1}),
                           .elasticity = {.young = 2e4},
                           .position = {0, 0, 0.06},
                           .contact_radius = 0.01});
  soft.fix(b, [](const Vec3& x) { return x.x() < 1e-9; });
  return loop;
}

/// A cube of one brick between the ground and a plate that is let down.
auto brick() {
  using Brick = HexahedralFem<Corotational>;
  AnimationLoop loop{World{RigidBodies{}, Brick{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                     ImplicitEuler{.rayleigh_mass = 4, .rayleigh_stiffness = 0.05}, WholeViolation{}};
  rigid_of(loop).add_fixed(HalfSpace{}, {0, 0, -0.01});
  rigid_of(loop).add({.position = {0.6, 0.5, 1.3}, .mass = 5.0, .shape = Box{1.5, 1.5, 0.25}});
  bodies<Brick>(loop.world())
      .add({.mesh = hexahedral_box({1, 1, 1}, {1, 1, 1}),
            .elasticity = {.young = 1e4, .poisson = 0.3},
            .density = 1,
            .contact_radius = 0.01});
  return loop;
}

/// A beam that swings about a joint at its corner.
auto swinging() {
  using Rubber = TetrahedralFem<StableNeoHookean>;
  AnimationLoop loop{World{Rubber{}}, Constraints{BallJoint{}}, ImplicitMidpoint{}};
  auto& soft = rigid_of(loop);
  const auto b = soft.add({.mesh = box_mesh({0.4, 0.1, 0.1}, {2, 1, 1}),
                           .elasticity = {.young = 1e5, .poisson = 0.4},
                           .velocity = {0, 0.5, 0}});
  loop.add(BallJoint::Item{anchor(soft, soft.node(b, 0)), world_anchor({0, 0, 0})});
  return loop;
}

/// A sheet held at two corners falls against a ball.
auto sheet_on_ball() {
  AnimationLoop loop{World{RigidBodies{}, Cloth<Corotational>{}},
                     Constraints{Contact{Coulomb{.friction = 0.3}}},
                     ImplicitEuler{.rayleigh_mass = 2, .rayleigh_stiffness = 0.01}};
  rigid_of(loop).add({.position = {0.3, 0.25, -0.2}, .mass = 0.3, .shape = Sphere{0.15}});
  rigid_of(loop).add_fixed(HalfSpace{}, {0, 0, -0.4});
  auto& sheets = bodies<Cloth<Corotational>>(loop.world());
  const auto cloth = sheets.add({.mesh = sheet(0.5, 0.5, {2, 2}, 2e-3),
                                 .elasticity = {.young = 5e4},
                                 .density = 100,
                                 .contact_radius = 0.01});
  sheets.fix(cloth, [](const Vec3& x) { return x.x() < 1e-9; });
  return loop;
}

}  // namespace

int main(int argc, char** argv) {
  Trace all("soft_more");
  all.add("beam_lazy", {.h = 0.01, .is_redundant = true, .forgets = no_factors}, beam<LazyCompliance>);
  all.add("beam_precomputed", {.h = 0.01, .is_redundant = true, .forgets = no_factors},
          beam<PrecomputedCompliance>);
  all.add("brick_under_plate", {.h = 0.01, .is_redundant = true}, brick);
  all.add("rubber_swings_midpoint", {.h = 0.005}, swinging);
  all.add("sheet_on_ball", {.h = 0.01, .is_redundant = true}, sheet_on_ball);
  return all.main(argc, argv);
}
