#include "catch.hpp"

#include <delassus/geometry/inertia.hpp>

#include <cmath>
#include <vector>

using namespace delassus;

namespace {

constexpr double pi = 3.14159265358979323846;

std::vector<Vec3> box_corners(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back({i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]});
  return corners;
}

/// The midpoint rule in n slices along z for a solid of revolution with the radius ρ(z): m = ∫ πρ², I_z = ∫
/// πρ⁴/2, I_x = ∫ π ρ⁴/4 + π ρ² z². Error O(n⁻²), or O(n⁻¹·⁵) where ρ² has a kink.
template <class Radius>
MassProperties revolve(double half, const Radius& radius) {
  MassProperties m;
  const int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double z = -half + (i + 0.5) * 2 * half / n, r2 = radius(z) * radius(z),
                 slice = pi * r2 * 2 * half / n;
    m.mass += slice;
    m.inertia(2, 2) += slice * r2 / 2;
    m.inertia(0, 0) += slice * (r2 / 4 + z * z);
  }
  m.inertia(1, 1) = m.inertia(0, 0);
  return m;
}

/// Relative to the largest entry.
void check_equal(const MassProperties& a, const MassProperties& b, double tolerance) {
  CHECK(a.mass == Approx(b.mass).epsilon(tolerance));
  CHECK((a.centre - b.centre).norm() <= tolerance);
  CHECK((a.inertia - b.inertia).cwiseAbs().maxCoeff() <= tolerance * b.inertia.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("round solids have the inertia of their slices") {
  const double r = 0.7, half = 0.9;
  const auto cap = [&](double z) { return std::sqrt(std::max(0.0, r * r - z * z)); };
  check_equal(mass_properties(Sphere{r}, 1), revolve(r, cap), 1e-8);
  check_equal(mass_properties(Cylinder{r, 2 * half}, 1), revolve(half, [&](double) { return r; }), 1e-8);
  check_equal(mass_properties(Capsule{r, 2 * half}, 1),
              revolve(half + r, [&](double z) { return std::abs(z) < half ? r : cap(std::abs(z) - half); }),
              1e-8);
}

TEST_CASE("a cone has the inertia of its slices about its own centre") {
  // revolve() slices about the middle of [−half, half]; the cone's centre lies h/4 above its base, h/4 below the middle.
  const double r = 0.7, h = 1.8;
  MassProperties slices = revolve(h / 2, [&](double z) { return r * (0.5 - z / h); });
  slices.inertia(0, 0) -= slices.mass * h * h / 16;
  slices.inertia(1, 1) = slices.inertia(0, 0);
  check_equal(mass_properties(Cone{r, h}, 1), slices, 1e-8);
}

TEST_CASE("an ellipsoid is a ball in other units along each axis") {
  // ∫ x² dV of the unit ball is 4π/15; stretched by (a, b, c) it is a² · abc · 4π/15.
  const double a = 0.5, b = 0.3, c = 0.4, share = 4 * pi / 15 * a * b * c;
  const MassProperties m = mass_properties(Ellipsoid{a, b, c}, 7);
  CHECK(m.mass == Approx(7 * 4 * pi / 3 * a * b * c).epsilon(1e-14));
  CHECK(m.inertia.diagonal().isApprox(7 * share * Vec3(b * b + c * c, c * c + a * a, a * a + b * b), 1e-14));
}

TEST_CASE("a box has m/12 (y² + z²) about x") {
  const MassProperties m = mass_properties(Box{1, 2, 3}, 5);
  CHECK(m.mass == Approx(30));
  CHECK(m.inertia.diagonal().isApprox(Vec3(30.0 / 12 * 13, 30.0 / 12 * 10, 30.0 / 12 * 5)));
}

TEST_CASE("the hull of a box's corners has the box's mass, and its centre where the box is") {
  // Rounding: sums of twelve tetrahedra, relative to the size of the box and not to its distance from the
  // origin.
  const Vec3 at(3, -2, 7);
  const ConvexHull hull(box_corners(at - Vec3(0.5, 1, 1.5), at + Vec3(0.5, 1, 1.5)));
  MassProperties expected = mass_properties(Box{1, 2, 3}, 2);
  expected.centre = at;
  check_equal(mass_properties(hull, 2), expected, 1e-13);
}

TEST_CASE("a hull's inertia turns with it") {
  std::vector<Vec3> corners = box_corners(Vec3(-0.5, -1, -1.5), Vec3(0.5, 1, 1.5));
  const Mat3 R = Quat(0.3, -0.5, 0.7, 0.2).normalized().toRotationMatrix();
  for (Vec3& c : corners) c = R * c;
  const Mat3 expected = R * mass_properties(Box{1, 2, 3}, 1).inertia * R.transpose();
  CHECK((mass_properties(ConvexHull(corners), 1).inertia - expected).cwiseAbs().maxCoeff() < 1e-13);
}

TEST_CASE("a tetrahedron has its closed-form moments") {
  // Corners 0, e₁, e₂, e₃: V = 1/6, c = ¼(1,1,1), ∫ x² = 1/60, ∫ xy = 1/120; about c: 1/60 − V/16, 1/120 −
  // V/16.
  const ConvexHull hull(std::vector<Vec3>{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()});
  CHECK(hull.volume() == Approx(1.0 / 6).epsilon(1e-14));
  CHECK((hull.centroid() - Vec3::Constant(0.25)).norm() < 1e-15);
  CHECK(hull.second_moment()(0, 0) == Approx(1.0 / 60 - 1.0 / 96).epsilon(1e-13));
  CHECK(hull.second_moment()(0, 1) == Approx(1.0 / 120 - 1.0 / 96).epsilon(1e-13));
}

TEST_CASE("hulls of many points on a sphere approach its inertia from below") {
  // N points leave caps of area 4πr²/N: the missing share of the volume is O(1/N), here below 15/N.
  std::vector<Vec3> points;
  const int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double z = 1 - 2 * (i + 0.5) / n, r = std::sqrt(1 - z * z), angle = 2.399963229728653 * i;
    points.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  const ConvexHull hull(points);
  CHECK(hull.vertices().size() == std::size_t(n));
  CHECK(hull.face_count() == 2 * n - 4);
  const MassProperties ball = mass_properties(Sphere{1}, 1), inside = mass_properties(hull, 1);
  CHECK(inside.mass < ball.mass);
  CHECK(inside.mass > (1 - 15.0 / n) * ball.mass);
  CHECK(inside.inertia(0, 0) < ball.inertia(0, 0));
  CHECK(inside.inertia(0, 0) > (1 - 30.0 / n) * ball.inertia(0, 0));
}
