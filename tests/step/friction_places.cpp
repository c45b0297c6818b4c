#include <delassus/step/friction_places.hpp>

#include "catch.hpp"

#include <cmath>
#include <vector>

namespace friction_places_tests {

using namespace delassus;

namespace {

/// A square of side 2 m in z = 0 whose corners are touched, each for a quarter of it.
struct Patch {
  std::vector<ContactPoint> points;
  std::vector<ContactResult> results;
  ContactMemory memory;

  explicit Patch(int count = 4) {
    constexpr double corner[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    const double share = mean_distance() / std::sqrt(2.0);
    for (int k = 0; k < count; ++k) {
      ContactPoint p{.a = 0, .b = 1, .pair = 7, .feature = std::uint32_t(10 + k), .area = 1};
      p.point_a = p.point_b = Vec3(corner[k][0], corner[k][1], 0);
      p.middle = share * p.point_a;
      points.push_back(p);
    }
  }
  static double mean_distance() { return (std::sqrt(2.0) + std::log(1 + std::sqrt(2.0))) / 3; }

  void remember(const std::vector<double>& loads, const Vec<2>& friction = {0.1, 0.2}) {
    const auto entries = memory.renew(loads.size());
    for (std::size_t k = 0; k < loads.size(); ++k)
      entries[k] = {7, points[k].feature, false, points[k].point(), Vec3(friction[0], friction[1], loads[k])};
    memory.sort();
  }
  std::vector<Vec3> arms() {
    results.clear();
    for (const ContactPoint& p : points) {
      ContactResult r;
      r.record = {.point_a = p.point_a, .point_b = p.point_b, .normal = p.normal, .gap = p.gap, .pair = p.pair, .feature = p.feature};
      results.push_back(r);
    }
    BasicFrictionPlaces<double>{}.find(points, results, memory);
    std::vector<Vec3> arms;
    for (const ContactResult& r : results) arms.push_back(r.record.friction_arm);
    return arms;
  }
  /// Σ λ |P + arm| / Σ λ.
  double brakes_at(const std::vector<double>& loads) {
    const std::vector<Vec3> arm = arms();
    double sum = 0, load = 0;
    for (std::size_t k = 0; k < loads.size(); ++k) sum += loads[k] * (points[k].point() + arm[k]).norm(), load += loads[k];
    return sum / load;
  }
};

}  // namespace

TEST_CASE("friction of a patch acts at its mean distance from the middle, however its corners share the load") {
  for (const std::vector<double>& loads : {std::vector<double>{}, {1, 1, 1, 1}, {2, 0, 2, 0}, {3, 1, 3, 1}}) {
    Patch patch;
    patch.remember(loads);
    CHECK(std::abs(patch.brakes_at(loads.empty() ? std::vector<double>{1, 1, 1, 1} : loads) - Patch::mean_distance()) < 1e-14);
    for (const Vec3& arm : patch.arms()) CHECK(arm.z() == 0);
  }
}

TEST_CASE("what one corner carries alone acts at that corner, and what an edge carries on that edge") {
  Patch one, edge;
  one.remember({0, 5, 0, 0});
  CHECK(one.arms()[1].norm() == 0);
  edge.remember({2, 2, 0, 0});
  const std::vector<Vec3> arms = edge.arms();
  for (const int k : {0, 1}) CHECK(std::abs(arms[std::size_t(k)].y()) < 1e-15);
  CHECK(arms[0].x() < 0);
  CHECK(arms[1].x() > 0);
}

TEST_CASE("a patch that hardly rubbed is left as it is, one that nothing is known of is not") {
  for (const double friction : {0.0, 5e-4, 2e-3}) {
    Patch patch;
    patch.remember({1, 1, 1, 1}, {friction, 0});
    for (const Vec3& arm : patch.arms()) CHECK((arm.norm() > 0) == (friction > 1e-3));
  }
  for (const Vec3& arm : Patch().arms()) CHECK(arm.norm() > 0);
}

TEST_CASE("two contacts, those without an area and what hangs above the deepest are no patch") {
  Patch two(2), bare, hanging;
  for (const Vec3& arm : two.arms()) CHECK(arm.norm() == 0);
  for (ContactPoint& p : bare.points) p.area = 0;
  for (const Vec3& arm : bare.arms()) CHECK(arm.norm() == 0);
  for (const int k : {0, 1}) hanging.points[std::size_t(k)].gap = 0.01;
  for (const Vec3& arm : hanging.arms()) CHECK(arm.norm() == 0);
}

}  // namespace friction_places_tests
