#include <delassus/collision/contact_area.hpp>
#include <delassus/collision/inner/face_pieces.hpp>
#include <delassus/collision/native.hpp>

#include "catch.hpp"
#include "collision/scene.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <vector>

namespace contact_area_tests {

using namespace delassus;
using namespace scenes;

namespace {

ContactArea area_of(const std::vector<Vec3>& corner, const Vec3& n, const inner::RoundFace& round = {}) {
  return inner::area_of(int(corner.size()), [&](int k) -> const Vec3& { return corner[std::size_t(k)]; }, n, round);
}
std::vector<Vec3> on_circle(int count, double radius, double from, double to) {
  std::vector<Vec3> at;
  for (int k = 0; k <= count; ++k) {
    const double angle = from + (to - from) * k / count;
    at.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return at;
}

}  // namespace

// Of a square a/6 (√2 + ln(1 + √2)), wherever it lies and however it is turned and run through.
TEST_CASE("a square's points lie 0.3826 of its side from its middle") {
  const double a = 0.7, right = a / 6 * (std::sqrt(2.0) + std::log(1 + std::sqrt(2.0)));
  const Mat3 R = turned(0.8, Vec3(1, 2, 3));
  const Vec3 at(3, -2, 5);
  std::vector<Vec3> corners;
  for (const auto& [x, y] : {std::pair{-0.5, -0.5}, std::pair{0.5, -0.5}, std::pair{0.5, 0.5}, std::pair{-0.5, 0.5}})
    corners.push_back(at + R * Vec3(a * x, a * y, 0));
  for (const double side : {1.0, -1.0}) {
    const ContactArea area = area_of(corners, side * R.col(2));
    CHECK(std::abs(area.size - a * a) < 1e-13);
    CHECK((area.middle - at).norm() < 1e-13);
    CHECK(std::abs(area.mean_distance - right) < 1e-13);
  }
}

// Sides that run to the middle, or past it by next to nothing, add next to nothing: not a logarithm of 0.
TEST_CASE("a square cut into triangles about a point near its middle has the same mean distance") {
  const double a = 0.7, right = a / 6 * (std::sqrt(2.0) + std::log(1 + std::sqrt(2.0)));
  const Vec3 n(0, 0, 1);
  const std::vector<Vec3> corners{{-0.5 * a, -0.5 * a, 0}, {0.5 * a, -0.5 * a, 0}, {0.5 * a, 0.5 * a, 0}, {-0.5 * a, 0.5 * a, 0}};
  for (double off = 1e-14; off < 0.2; off *= 3) {
    inner::FacePieces pieces;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::array<Vec3, 3> piece{Vec3(off, -0.4 * off, 0), corners[k], corners[(k + 1) % 4]};
      pieces.add(3, [&](int i) -> const Vec3& { return piece[std::size_t(i)]; }, n, 0);
    }
    CAPTURE(off);
    CHECK(std::abs(pieces.area(n, 1).mean_distance - right) < 1e-9);  // sides at less than 1e-9 of their length are none
  }
}

// Equilateral, side a: the middle is h = a/(2√3) from each side, and ∫ |x| dA = h/6 · 6 [s ρ + h² asinh(s/h)] with s = a/2,
// ρ = a/√3, over the area √3 a²/4.
TEST_CASE("a triangle's middle is its centroid") {
  const double a = 2, height = a / (2 * std::sqrt(3.0)), s = a / 2, rho = a / std::sqrt(3.0);
  const double sum = height * (s * rho + height * height * std::asinh(s / height));
  const ContactArea area = area_of({{0, 0, 1}, {a, 0, 1}, {a / 2, a * std::sqrt(0.75), 1}}, Vec3::UnitZ());
  CHECK((area.middle - Vec3(a / 2, height, 1)).norm() < 1e-14);
  CHECK(std::abs(area.mean_distance - sum / (std::sqrt(3.0) / 4 * a * a)) < 1e-14);
}

// A whole rim is exact. Half a disc has its middle at 4R/3π; four chords of an octagon become 16 of 11°, and these cut off
// (11.25°)²/6 = 0.64 % of the area.
TEST_CASE("chords of a rim stand for the rim") {
  const double R = 0.4;
  std::vector<Vec3> octagon = on_circle(8, R, 0, 2 * M_PI);
  octagon.pop_back();
  const inner::RoundFace round{Vec3::Zero(), R};
  const ContactArea disc = area_of(octagon, Vec3::UnitZ(), round);
  CHECK(std::abs(disc.size - M_PI * R * R) < 1e-14);
  CHECK(std::abs(disc.mean_distance - 2 * R / 3) < 1e-14);
  CHECK(area_of(octagon, Vec3::UnitZ()).mean_distance < 0.96 * disc.mean_distance);
  const ContactArea half = area_of(on_circle(4, R, 0, M_PI), Vec3::UnitZ(), round);
  CHECK(std::abs(half.size / (M_PI * R * R / 2) - 1) < 0.007);
  CHECK(std::abs(half.middle.y() / (4 * R / (3 * M_PI)) - 1) < 0.007);
}

// Equal shares lie around the middle of the face as the contacts do, at its mean distance.
TEST_CASE("the contacts of a patch share its area, also while they rest; what is no patch has none") {
  const double R = 0.4;
  for (const bool is_plane : {true, false}) {
    Scene scene;
    scene.add(is_plane ? Shape(HalfSpace{}) : Shape(Box{2, 2, 1}), {0, 0, is_plane ? 0 : -0.5}, Mat3::Identity(), false);
    scene.add(Cylinder{R, 1}, {0.1, 0.2, 0.5 - 1e-6});
    for (int step = 0; step < 3; ++step) {
      scene.detect();
      CAPTURE(is_plane, step);
      CHECK(scene.report.queries == (step == 0 ? 1 : 0));
      REQUIRE(scene.contacts.size() == 4);
      double area = 0, distance = 0;
      Vec3 middle = Vec3::Zero();
      for (const ContactPoint& c : scene.contacts) area += c.area, middle += c.middle / 4;
      for (const ContactPoint& c : scene.contacts) distance += (c.middle - middle).norm() / 4;
      CHECK(std::abs(area - M_PI * R * R) < 1e-12);
      CHECK((middle - Vec3(0.1, 0.2, 0)).norm() < 1e-5);
      CHECK(std::abs(distance - 2 * R / 3) < 1e-12);
    }
  }
  const Mat3 lying = turned(std::acos(0.0), Vec3::UnitX());
  for (const auto& [shape, height] : {std::pair{Shape(Sphere{0.5}), 0.5}, std::pair{Shape(Capsule{0.5, 1}), 0.5}, std::pair{Shape(Cylinder{0.5, 1}), 0.5}}) {
    Scene scene;
    scene.add(HalfSpace{}, Vec3::Zero(), Mat3::Identity(), false);
    scene.add(shape, {0, 0, height}, lying);
    scene.detect();
    REQUIRE(!scene.contacts.empty());
    for (const ContactPoint& c : scene.contacts) CHECK(c.area == 0);
  }
}

}  // namespace contact_area_tests
