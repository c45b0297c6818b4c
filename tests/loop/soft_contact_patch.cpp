// The contact patch test: two blocks whose meshes do not match, pressed on each other by a uniform pressure.
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/accelerated_gauss_seidel.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

using namespace delassus;

namespace {

using Pressed = TetrahedralFem<Linear>;

/// Of all elements of both blocks, σ_zz + p as a share of p.
struct PatchError {
  double largest = 0, mean_lower = 0, mean_upper = 0;
  Status status = Status::converged;
};

/// A block of 1 × 1 × ½ m in `below` cells along each side, its foot held, and one of `above` cells on it
/// whose top bears p = E/1000. ν = 0, so that the exact answer is σ_zz = −p everywhere, and no node moves
/// sideways. One step in which inertia is 1e-5 of stiffness: statics.
PatchError press_blocks(Index below, Index above) {
  const double young = 1000, pressure = 1, radius = 1e-3, h = 1;
  AnimationLoop loop{World{Pressed{}}, Constraints{Contact{Frictionless{}}}, ImplicitEuler{},
                     WithSurfaces{NativeCollision{.margin = 1e-3}, false},
                     AcceleratedGaussSeidel{.tolerance = 1e-11, .max_iterations = 40000}};
  auto& soft = bodies<Pressed>(loop.world());
  soft.gravity.setZero();
  const auto add = [&](Index cells, double z, std::uint32_t group) {
    return soft.add({.mesh = box_mesh({1, 1, 0.5}, {cells, cells, 2}),
                     .elasticity = {.young = young, .poisson = 0},
                     .density = 0.04,
                     .position = {0, 0, z},
                     .contact_radius = radius,
                     .group = group,
                     .collides_with = ~group});
  };
  const double bottom = 0.5 + 2 * radius;
  const auto lower = add(below, 0, 2), upper = add(above, bottom, 4);
  soft.fix(lower, [](const Vec3& x) { return x.z() < 1e-9; });
  // Consistent with the pressure: a third of the area of each triangle of the top to each of its corners.
  const TetrahedralMesh mesh = soft.mesh(upper);
  for (const auto& t : surface(mesh)) {
    const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    if (std::min({a.z(), b.z(), c.z()}) < bottom + 0.5 - 1e-9) continue;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    for (const Index k : t) soft.apply_force(soft.node(upper, k), {0, 0, -pressure * area / 3});
  }
  // Nothing holds the upper block sideways but its inertia: as no force does either, that is enough.
  PatchError error;
  error.status = loop.step(h).status;
  const auto measure = [&](auto body, double& mean) {
    const TetrahedralMesh& at_rest = soft.mesh(body);
    const Lame lame(young, 0);
    double sum = 0;
    for (Index e = 0; e < Index(at_rest.tetrahedra.size()); ++e) {
      inner::LinearTetrahedron::Corners x;
      for (int a = 0; a < 4; ++a) x[a] = soft.position(soft.node(body, at_rest.tetrahedra[e][a]));
      const auto point = inner::LinearTetrahedron(at_rest, e, lame).points[0];
      const double stress = Linear{.young = young, .poisson = 0}.at(point.deformation(x)).stress()(2, 2);
      error.largest = std::max(error.largest, std::abs(stress / pressure + 1));
      sum += stress * point.volume;
    }
    mean = sum / 0.5 / pressure + 1;
  };
  measure(lower, error.mean_lower);
  measure(upper, error.mean_upper);
  return error;
}

}  // namespace

// Forces are in balance: ∫σ_zz is the sum of f z over the nodes, −p times the volume, but for inertia, 1e-5
// in the whole, and the solver, 1e-11 of the free motion, 1e5 times the answer. 1e-4 allows both ten times.
TEST_CASE("two blocks whose nodes meet pass the contact patch test") {
  const PatchError error = press_blocks(3, 3);
  WARN("contact patch, 3 on 3 cells: stress off by "
       << error.largest << " of the pressure; the solver: " << name(error.status));
  CHECK(error.status == Status::converged);
  CHECK(error.largest < 1e-4);
}

TEST_CASE("two blocks whose nodes do not meet carry the pressure in the mean, and how far off is told") {
  for (const auto& [below, above] : {std::pair<Index, Index>{4, 3}, {3, 4}}) {
    const PatchError error = press_blocks(below, above);
    WARN("contact patch, " << above << " on " << below << " cells: stress off by " << error.largest
                           << " of the pressure; the solver: " << name(error.status));
    CHECK(error.status <= Status::max_iterations);
    CHECK(std::abs(error.mean_lower) < 1e-4);
    CHECK(std::abs(error.mean_upper) < 1e-4);
    CHECK(error.largest < 1);  // no element is pulled
  }
}
