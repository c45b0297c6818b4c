// A deformable body that touches itself.
#include <delassus/bodies/world.hpp>
#include <delassus/collision/native.hpp>
#include <delassus/collision/with_filter.hpp>
#include <delassus/collision/with_surfaces.hpp>
#include <delassus/constraints/contact/frictionless.hpp>
#include <delassus/integrators/implicit_euler.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/solvers/gauss_seidel.hpp>

#include "catch.hpp"
#include "soft_scenes.hpp"

namespace soft_self_contact_tests {

using namespace delassus;

namespace {

using Soft = TetrahedralFem<Corotational>;
using Detection = WithSurfaces<NativeCollision>;

/// The cells of a mesh for whose middle `stays` is true.
TetrahedralMesh carved(const TetrahedralMesh& mesh, const auto& stays) {
  TetrahedralMesh out;
  std::vector<Index> number(mesh.points.size(), -1);
  for (const auto& t : mesh.tetrahedra) {
    Vec3 middle = Vec3::Zero();
    for (const Index i : t) middle += 0.25 * mesh.points[i];
    if (!stays(middle)) continue;
    auto& copy = out.tetrahedra.emplace_back();
    for (int k = 0; k < 4; ++k) {
      if (number[t[k]] < 0) number[t[k]] = Index(out.points.size()), out.points.push_back(mesh.points[t[k]]);
      copy[k] = number[t[k]];
    }
  }
  return out;
}

/// A U of two arms 0.1 m thick and 0.8 m high, 0.3 m apart; the right arm's nodes are moved along the arm, so
/// that no node meets a node.
TetrahedralMesh u_shape() {
  TetrahedralMesh mesh = carved(box_mesh({0.5, 0.2, 0.9}, {5, 2, 9}),
                                [](const Vec3& x) { return x[2] < 0.1 || x[0] < 0.1 || x[0] > 0.4; });
  for (Vec3& p : mesh.points)
    if (p[0] > 0.35 && p[2] > 0.15 && p[2] < 0.85) p[2] += 0.03;
  return mesh;
}

/// The least height of a node of one arm over a triangle of the other's inside that it lies over, m.
double least_height(const Soft& soft, Soft::BodyHandle body) {
  const TetrahedralMesh& mesh = soft.mesh(body);
  double least = 1;
  for (const bool is_left : {true, false}) {
    const auto is_inside = [&](const Vec3& x, bool left) {
      return x[2] > 0.15 && std::abs(x[0] - (left ? 0.1 : 0.4)) < 1e-9;
    };
    for (const auto& t : surface(mesh)) {
      Triangle T;
      bool is_other = true;
      for (int k = 0; k < 3; ++k) {
        T.point[k] = soft.position(soft.node(body, t[k]));
        is_other = is_other && is_inside(mesh.points[t[k]], !is_left);
      }
      if (!is_other) continue;
      T.normal = inner::triangle_normal(T.point[0], T.point[1], T.point[2]);
      for (Index i = 0; i < Index(mesh.points.size()); ++i) {
        const Vec3 x = soft.position(soft.node(body, i));
        if (is_inside(mesh.points[i], is_left) && inner::is_over(T, x, 0))
          least = std::min(least, T.height(x));
      }
    }
  }
  return least;
}

auto scene(bool meets_itself) {
  return AnimationLoop{World{Soft{}}, Constraints{Contact{Frictionless{}}},
                       ImplicitEuler{.rayleigh_stiffness = 0.02},
                       WithFilter{Detection{NativeCollision{}, meets_itself}},
                       GaussSeidel{.tolerance = 1e-8, .max_iterations = 1000}};
}

}  // namespace

TEST_CASE("a surface is no thicker against itself than what is apart at rest") {
  auto loop = scene(true);
  auto& soft = bodies<Soft>(loop.world());
  soft.gravity.setZero();
  // 0.2 m on either side of a slot of 0.3 m.
  const auto body = soft.add({.mesh = u_shape(), .elasticity = {.young = 1e5}, .contact_radius = 0.2});
  for (int n = 0; n < 5; ++n) loop.step(0.01);
  CHECK(loop.report().contacts > 0);
  for (Index k = 0; k < soft.node_count(body); ++k)
    CHECK((soft.position(soft.node(body, k)) - soft.mesh(body).points[k]).norm() <
          1e-9);  // rounding of F = 1
}

TEST_CASE("a soft U whose arms are pressed together closes, and the arms do not pass through each other") {
  for (const bool meets_itself : {false, true}) {
    auto loop = scene(meets_itself);
    auto& soft = bodies<Soft>(loop.world());
    soft.gravity.setZero();
    const double radius = 0.01, h = 0.01;
    const auto body = soft.add({.mesh = u_shape(),
                                .elasticity = {.young = 1e5, .poisson = 0.3},
                                .density = 100,
                                .contact_radius = radius});
    soft.fix(body, [](const Vec3& x) { return x.z() < 1e-9; });
    double least = 1;
    Index most = 0;
    for (int n = 0; n < 200; ++n) {
      for (Index k = 0; k < soft.node_count(body); ++k) {
        const Vec3& x = soft.mesh(body).points[k];
        if (x.z() > 0.5) soft.apply_force(soft.node(body, k), {x.x() < 0.25 ? 1.5 : -1.5, 0, 0});
      }
      const StepReport report = loop.step(h);
      CHECK(report.quarantined == 0);
      least = std::min(least, least_height(soft, body));
      most = std::max(most, report.contacts);
    }
    if (meets_itself) {
      // Held 2 r apart; what is less is what faces turn within a step of at most a centimetre.
      CHECK(least > radius);
      CHECK(most > 4);
      CHECK(least_height(soft, body) < 3 * radius);  // closed
    } else {
      CHECK(least < -0.02);
      CHECK(most == 0);
    }
  }
}

}  // namespace soft_self_contact_tests
