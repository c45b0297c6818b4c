#include "catch.hpp"

#include <delassus/bodies/rigid_bodies.hpp>
#include <delassus/bodies/world.hpp>
#include <delassus/collision/with_compounds.hpp>
#include <delassus/collision/with_meshes.hpp>
#include <delassus/constraints/contact/coulomb.hpp>
#include <delassus/constraints/contact/pyramid.hpp>
#include <delassus/constraints/contact/restitution.hpp>
#include <delassus/constraints/contact/rolling_coulomb.hpp>
#include <delassus/loop/animation_loop.hpp>
#include <delassus/loop/defaults.hpp>
#include <delassus/step/friction_places.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace spinning_patch_tests {

using namespace delassus;

namespace {

constexpr double mu = 0.3, g = 9.81, h = 1e-3, spin = 20;

using Area = std::function<bool(double, double)>;

/// ∫ |x − m| dA / A of the points of a square of side 2 for which `is_inside` says so, m their middle; by sums over a grid.
double mean_distance(const Area& is_inside) {
  constexpr int n = 400;
  const auto each = [&](const auto& f) {
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double x = (2 * i + 1.0) / n - 1, y = (2 * j + 1.0) / n - 1;
        if (is_inside(x, y)) f(x, y);
      }
  };
  double count = 0, mx = 0, my = 0, sum = 0;
  each([&](double x, double y) { ++count, mx += x, my += y; });
  each([&](double x, double y) { sum += std::hypot(x - mx / count, y - my / count); });
  return sum / count;
}
Area rectangle(double a, double b) {
  return [=](double x, double y) { return std::abs(x) <= a / 2 && std::abs(y) <= b / 2; };
}
/// Convex, counter-clockwise.
Area polygon(std::vector<Vec3> corner) {
  return [=](double x, double y) {
    for (std::size_t k = 0; k < corner.size(); ++k) {
      const Vec3 &p = corner[k], &q = corner[(k + 1) % corner.size()];
      if ((q.x() - p.x()) * (y - p.y()) - (q.y() - p.y()) * (x - p.x()) < 0) return false;
    }
    return true;
  };
}
std::vector<Vec3> regular(int corners, double radius) {
  std::vector<Vec3> at;
  for (int k = 0; k < corners; ++k)
    at.push_back({radius * std::cos(2 * M_PI * k / corners), radius * std::sin(2 * M_PI * k / corners), 0});
  return at;
}
/// The hull of a polygon between z = −0.01 and 0.01 m.
ConvexHull plate(const std::vector<Vec3>& corner) {
  std::vector<Vec3> points;
  for (const Vec3& p : corner)
    for (const double z : {-0.01, 0.01}) points.push_back({p.x(), p.y(), z});
  return ConvexHull(points);
}

using Detection = WithCompounds<WithMeshes<NativeCollision>>;

/// A body of 1 kg on z = 0 spins at 20 rad/s. From its angular acceleration between steps 10 and 40, the arm at which μ m g
/// acts, m.
double arm(auto& loop, RigidBodies::Handle body, double inertia) {
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.set_velocity(body, {0, 0, 0}, {0, 0, spin});
  double before = 0;
  for (int i = 0; i <= 40; ++i) {
    loop.step(h);
    if (i == 10) before = rigid.angular_velocity(body).z();
  }
  return (before - rigid.angular_velocity(body).z()) * inertia / (30 * h * mu * g);
}

/// The same of a body whose flat face is at z = −bottom, on what reaches up to z = depth of its frame.
double arm(const std::function<Shape(Detection&)>& body, double bottom, const std::function<Shape(Detection&)>& ground, double depth) {
  const double inertia = 0.02;
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}, Detection{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  auto& detection = loop.get<Detection>();
  rigid.add_fixed(ground(detection), {0.01, 0.02, -depth});
  return arm(loop, rigid.add({.position = {0, 0, bottom}, .mass = 1, .inertia = Mat3(inertia * Mat3::Identity()), .shape = body(detection)}), inertia);
}
/// The same of a disc on a plane under a law.
template <class Law>
double arm_of_disc(Law law, double R) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{law}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  return arm(loop, rigid.add({.position = {0, 0, 0.01}, .mass = 1, .shape = Cylinder{R, 0.02}}), 0.5 * R * R);
}

Shape plane(Detection&) { return HalfSpace{}; }

}  // namespace

// Even pressure p brakes with μ p ∫ |x| dA = μ m g times the mean distance of the face: 2R/3 of a disc, a/6 (√2 + ln(1 + √2))
// of a square. 3 % is what is asked.
TEST_CASE("a body that spins flat is braked at the mean distance of its face") {
  const double R = 0.3;
  const std::vector<Vec3> triangle{{-0.3, -0.2, 0}, {0.5, -0.2, 0}, {-0.2, 0.4, 0}}, uneven{{-0.4, -0.3, 0}, {0.5, -0.3, 0}, {0.3, 0.1, 0}, {0, 0.35, 0}, {-0.4, 0.35, 0}};
  struct Row {
    const char* name;
    Shape shape;
    double bottom, arm;
  };
  const ConvexHull hexagon = plate(regular(6, R)), round = plate(regular(40, R));
  const std::vector<Row> rows{
      {"disc", Cylinder{R, 0.02}, 0.01, 2 * R / 3},
      {"cone", Cone{R, 0.04}, 0.01, 2 * R / 3},
      {"square", Box{0.4, 0.4, 0.02}, 0.01, 0.4 / 6 * (std::sqrt(2.0) + std::log(1 + std::sqrt(2.0)))},
      {"rectangle", Box{0.8, 0.2, 0.02}, 0.01, mean_distance(rectangle(0.8, 0.2))},
      {"hexagon", hexagon, 0.01, mean_distance(polygon(regular(6, R)))},
      {"polygon of 40 corners", round, 0.01, 2 * R / 3},
  };
  for (const Row& row : rows)
    for (const int ground : {0, 1, 2, 3}) {
      CAPTURE(row.name, ground);
      const double measured = arm([&](Detection&) { return row.shape; }, row.bottom, [&](Detection& d) -> Shape {
        if (ground == 0) return HalfSpace{};
        if (ground == 1) return Box{2, 2, 1};
        if (ground == 2) return Cylinder{1, 1};
        return d.backend.add(HeightField(9, 9, 0.25, 0.25, std::vector<double>(81, 0.0)));
      }, ground == 0 || ground == 3 ? 0 : 0.5);
      CHECK(std::abs(measured / row.arm - 1) < 0.03);
    }
  // The centre of mass is over the middle of the face; the corners lie at different distances from there.
  for (const auto& corners : {triangle, uneven}) {
    const ConvexHull hull = plate(corners).centred();
    const double measured = arm([&](Detection&) -> Shape { return hull; }, 0.01, plane, 0);
    CAPTURE(corners.size());
    CHECK(std::abs(measured / mean_distance(polygon(corners)) - 1) < 0.03);
  }
}

// Parts of one body are one patch: two boxes side by side, a frame of four bars, a ring of 16 wedges, four feet.
TEST_CASE("a compound that spins flat is braked at the mean distance of all its faces") {
  const auto measured = [](const std::vector<CompoundPart>& parts, double half) {
    return arm([&](Detection& d) { return d.add(Compound(parts)); }, half, plane, 0);
  };
  const auto box = [](double a, double b, double x, double y) { return CompoundPart{.shape = Box{a, b, 0.02}, .position = {x, y, 0}}; };
  const double two = measured({box(0.3, 0.3, 0.15, 0), box(0.3, 0.3, -0.15, 0)}, 0.01);
  CHECK(std::abs(two / mean_distance(rectangle(0.6, 0.3)) - 1) < 0.03);
  const double frame = measured({box(0.6, 0.1, 0, 0.25), box(0.6, 0.1, 0, -0.25), box(0.1, 0.4, 0.25, 0), box(0.1, 0.4, -0.25, 0)}, 0.01);
  const Area hollow = [](double x, double y) { return rectangle(0.6, 0.6)(x, y) && !rectangle(0.4, 0.4)(x, y); };
  CHECK(std::abs(frame / mean_distance(hollow) - 1) < 0.03);
  const double Ri = 0.2, Ro = 0.3;
  std::vector<ConvexHull> wedge;
  const std::vector<Vec3> in = regular(16, Ri), out = regular(16, Ro);
  for (int k = 0; k < 16; ++k) wedge.push_back(plate({in[k], out[k], out[(k + 1) % 16], in[(k + 1) % 16]}));
  std::vector<CompoundPart> wedges;
  for (const ConvexHull& w : wedge) wedges.push_back({.shape = w});
  const double annulus = measured(wedges, 0.01);
  CHECK(std::abs(annulus / (2 * (Ro * Ro * Ro - Ri * Ri * Ri) / (3 * (Ro * Ro - Ri * Ri))) - 1) < 0.03);
  // Where parts meet inside, no load gathers: eight slices of a disc that meet in its middle, nine tiles, an L.
  wedge.clear(), wedges.clear();
  for (int k = 0; k < 8; ++k) {
    std::vector<Vec3> corner{{0, 0, 0}};
    for (int i = 0; i <= 4; ++i) corner.push_back(regular(32, Ro)[(4 * k + i) % 32]);
    wedge.push_back(plate(corner));
  }
  for (const ConvexHull& w : wedge) wedges.push_back({.shape = w});
  CHECK(std::abs(measured(wedges, 0.01) / mean_distance(polygon(regular(32, Ro))) - 1) < 0.03);
  std::vector<CompoundPart> tiles;
  for (int k = 0; k < 9; ++k) tiles.push_back(box(0.2, 0.2, 0.2 * (k % 3 - 1), 0.2 * (k / 3 - 1)));
  CHECK(std::abs(measured(tiles, 0.01) / mean_distance(rectangle(0.6, 0.6)) - 1) < 0.03);
  const double angle = measured({box(0.6, 0.2, 0.1, 0.1), box(0.2, 0.2, -0.1, -0.1)}, 0.01);
  const Area bent = [](double x, double y) { return (std::abs(x - 0.1) < 0.3 && y > 0 && y < 0.2) || (x > -0.2 && x < 0 && y > -0.2 && y <= 0); };
  CHECK(std::abs(angle / mean_distance(bent) - 1) < 0.03);
  const double feet = measured({box(0.1, 0.1, 0.25, 0.2), box(0.1, 0.1, -0.25, 0.2), box(0.1, 0.1, 0.25, -0.2), box(0.1, 0.1, -0.25, -0.2)}, 0.01);
  const Area squares = [](double x, double y) { return std::abs(std::abs(x) - 0.25) < 0.05 && std::abs(std::abs(y) - 0.2) < 0.05; };
  CHECK(std::abs(feet / mean_distance(squares) - 1) < 0.03);
}

namespace {

/// A ring between the radii Ri and Ro, 0.02 m high, of triangles that look outward; Ri = 0: a disc.
TriangleMesh ring_mesh(double Ri, double Ro) {
  constexpr int n = 48;
  std::vector<Vec3> at;
  for (const double z : {-0.01, 0.01})
    for (const double r : {Ri, Ro})
      for (const Vec3& p : regular(n, r)) at.push_back({p.x(), p.y(), z});
  std::vector<std::array<Index, 3>> triangles;
  const auto quad = [&](Index a, Index b, Index c, Index d) { triangles.push_back({a, b, c}), triangles.push_back({a, c, d}); };
  for (Index k = 0; k < n; ++k) {
    const Index l = (k + 1) % n, low_in = 0, low_out = n, high_in = 2 * n, high_out = 3 * n;
    quad(low_in + k, low_in + l, low_out + l, low_out + k);
    quad(high_in + k, high_out + k, high_out + l, high_in + l);
    quad(low_out + k, low_out + l, high_out + l, high_out + k);
    quad(low_in + k, high_in + k, high_in + l, low_in + l);
  }
  return TriangleMesh(at, triangles);
}

}  // namespace

TEST_CASE("a mesh that spins flat is braked at the mean distance of its face") {
  const double Ri = 0.2, Ro = 0.3;
  const double on_plane = arm([&](Detection& d) { return d.backend.add(ring_mesh(Ri, Ro)); }, 0.01, plane, 0);
  const double right = 2 * (Ro * Ro * Ro - Ri * Ri * Ri) / (3 * (Ro * Ro - Ri * Ri));
  const auto table = [](Detection&) -> Shape { return Box{2, 2, 1}; };
  const double on_box = arm([&](Detection& d) { return d.backend.add(ring_mesh(Ri, Ro)); }, 0.01, table, 0.5);
  CHECK(std::abs(on_box / right - 1) < 0.03);
  CHECK(std::abs(on_plane / right - 1) < 0.03);
}

// The friction of a disc that slides with v and spins with w, by sums over the disc: stops at 0.646 s.
TEST_CASE("a disc that slides and spins stops in the time of an even pressure") {
  const double R = 0.1, v0 = 1, inertia = 0.5 * R * R;
  double v = v0, w = spin, right = 0;
  for (const double dt = 1e-4; v > 1e-3 || w * R > 1e-3; right += dt) {
    double force = 0, moment = 0, count = 0;
    for (int i = 0; i < 12; ++i)
      for (int k = 0; k < 24; ++k) {
        const double r = R * std::sqrt((i + 0.5) / 12), a = 2 * M_PI * (k + 0.5) / 24, x = r * std::cos(a), y = r * std::sin(a);
        const double ux = v - w * y, uy = w * x, u = std::hypot(ux, uy) + 1e-12;
        force += mu * g * ux / u, moment += mu * g * (x * uy - y * ux) / u, ++count;
      }
    v -= dt * force / count, w -= dt * moment / count / inertia;
  }
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = mu}}}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  rigid.add_fixed(HalfSpace{});
  const auto disc = rigid.add({.position = {0, 0, 0.01}, .mass = 1, .shape = Cylinder{R, 0.02}});
  rigid.set_velocity(disc, {v0, 0, 0}, {0, 0, spin});
  int steps = 0;
  while (steps < 2000 && (rigid.velocity(disc).norm() > 1e-6 || std::abs(rigid.angular_velocity(disc).z()) > 1e-6)) loop.step(h), ++steps;
  CHECK(std::abs(steps * h / right - 1) < 0.06);
}

// RollingCoulomb without lengths of its own is Coulomb. The corners of the pyramid brake harder, by up to √2, and no side less.
TEST_CASE("all laws of friction brake a spin alike") {
  const double R = 0.3, round = arm_of_disc(Coulomb{.friction = mu}, R);
  CHECK(std::abs(round / (2 * R / 3) - 1) < 1e-4);
  CHECK(std::abs(arm_of_disc(RollingCoulomb{.friction = mu}, R) / round - 1) < 1e-6);
  CHECK(std::abs(arm_of_disc(Restitution{Coulomb{.friction = mu}}, R) / round - 1) < 1e-6);
  const double pyramid = arm_of_disc(Pyramid{.friction = mu}, R);
  CHECK(pyramid > 0.99 * round);
  CHECK(pyramid < 1.42 * round);
}

}  // namespace spinning_patch_tests
