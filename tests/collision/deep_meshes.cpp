#include "catch.hpp"
#include "collision/mesh_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace deep_meshes_tests {

using namespace delassus;
using namespace scenes;

namespace {

/// Both in one scene; b may move.
MeshScene together(TriangleMesh a, TriangleMesh b, const Vec3& at, const Mat3& R = Mat3::Identity()) {
  MeshScene scene;
  scene.add(scene.collision.add(std::move(a)), {0, 0, 0}, Mat3::Identity(), false);
  scene.add(scene.collision.add(std::move(b)), at, R);
  scene.detect();
  return scene;
}

double deepest(const MeshScene& scene) {
  double least = std::numeric_limits<double>::infinity();
  for (const ContactPoint& p : scene.contacts) least = std::min(least, p.gap);
  return least;
}

/// Moves the second body out by its deepest contact until nothing overlaps; how many times that took.
int part(MeshScene& scene) {
  for (int n = 0; n < 20; ++n) {
    scene.detect();
    const auto at =
        std::min_element(scene.contacts.begin(), scene.contacts.end(),
                         [](const ContactPoint& p, const ContactPoint& q) { return p.gap < q.gap; });
    if (at == scene.contacts.end() || at->gap > -1e-9) return n;
    CHECK(std::abs(at->normal.norm() - 1) < 1e-12);
    scene.colliders[1].pose.position -= at->gap * at->normal;
  }
  return 20;
}

}  // namespace

TEST_CASE(
    "a meshed box wholly inside a closed one leaves by the nearest side, whichever of the two comes first") {
  // A cube of 0.2 m, its middle 1 m from the upper side of a cube of 4 m: its lower corners are 1.1 m deep.
  for (const bool is_first : {true, false}) {
    const TriangleMesh small = fine_box(0.2, 0.2, 0.2, 2), large = fine_box(4, 4, 4, 5);
    const Vec3 apart(0.3, 0.1, 1);
    MeshScene scene = is_first ? together(small, large, -apart) : together(large, small, apart);
    REQUIRE(scene.contacts.size() == 4);
    for (const ContactPoint& p : scene.contacts) {
      CHECK((p.normal - Vec3(0, 0, is_first ? -1 : 1)).norm() < 1e-12);
      CHECK(std::abs(p.gap + 1.1) < 1e-12);
      const Vec3 lower = (is_first ? p.point_a : p.point_b) - (is_first ? Vec3(0, 0, 0) : apart);
      CHECK((lower.cwiseAbs() - Vec3(0.1, 0.1, 0.1)).norm() < 1e-12);  // its lower corners
    }
    CHECK(part(scene) == 1);
  }
}

TEST_CASE("nothing is inside an open surface, beside a closed one or in the hole of a ring") {
  // A box without its lid; and four beams around a hole of 2 m.
  const TriangleMesh whole = box_mesh(4, 4, 4), small = box_mesh(0.2, 0.2, 0.2);
  const std::vector<Corners> all(whole.triangles().begin(), whole.triangles().end());
  const TriangleMesh open(whole.vertices(), std::vector<Corners>(all.begin() + 2, all.end()));
  CHECK(together(open, small, {0.3, 0.1, 1}).contacts.empty());
  CHECK(together(whole, small, {0.3, 0.1, 2.2}).contacts.empty());
  std::vector<Vec3> v;
  for (const double z : {-0.5, 0.5})
    for (const double r : {1.0, 2.0})
      for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) v.push_back({r * x, r * y, z});
  std::vector<Corners> t;
  const auto side = [&](Index a, Index b, Index c, Index d) { t.insert(t.end(), {{a, b, c}, {a, c, d}}); };
  for (Index i = 0; i < 4; ++i) {
    const Index j = (i + 1) % 4;
    side(8 + i, 12 + i, 12 + j, 8 + j);  // above: inner to outer
    side(i, j, 4 + j, 4 + i);            // below
    side(4 + i, 4 + j, 12 + j, 12 + i);  // outside
    side(i, 8 + i, 8 + j, j);            // towards the hole
  }
  const TriangleMesh ring(v, t);
  REQUIRE(ring.is_closed());
  CHECK(together(ring, small, {0.1, 0, 0}).contacts.empty());
  CHECK(deepest(together(ring, small, {1.5, 0, 0})) < -0.5);  // in the beam
}

TEST_CASE("meshed boxes deep in each other in any pose part by their contacts") {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&] {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vec3(x, y, z);
  };
  int silent = 0, slow = 0;
  for (int k = 0; k < 200; ++k) {
    const double angle = 3 * uniform(random);
    const Vec3 axis = draw(), at = 0.6 * draw();
    MeshScene scene = together(fine_box(1, 0.8, 0.6, 2), fine_box(0.7, 1, 0.9, 2), at, turned(angle, axis));
    const Pose pose{at, turned(angle, axis)};
    const SignedPair solid =
        GjkEpa::convex(Shape(Box{1, 0.8, 0.6}), Shape(Box{0.7, 1, 0.9}), pose, 2, Vec3(1, 0, 0));
    if (!(solid.distance < -0.02)) continue;
    silent += scene.contacts.empty();
    slow += part(scene) > 8;
    const SignedPair after = GjkEpa::convex(Shape(Box{1, 0.8, 0.6}), Shape(Box{0.7, 1, 0.9}),
                                            scene.colliders[1].pose, 2, Vec3(1, 0, 0));
    if (!(after.status != PairStatus::near || after.distance > -1e-3)) {
      UNSCOPED_INFO("k " << k << " d " << solid.distance << " after " << after.distance);
      ++slow;
    }
  }
  CHECK(silent == 0);
  CHECK(slow == 0);
}

TEST_CASE("two height fields meet: a slab of hills upside down rests on hills") {
  // Cones of 0.1 m at the points of odd indices below; a plain above, turned by half a turn about x.
  std::vector<double> heights(81, 0.0);
  for (int j = 1; j < 9; j += 2)
    for (int i = 1; i < 9; i += 2) heights[std::size_t(9 * j + i)] = 0.1;
  for (const bool is_hilly_above : {false, true}) {
    MeshScene scene;
    const Shape hills = scene.collision.add(HeightField(9, 9, 0.25, 0.25, heights)),
                plain = scene.collision.add(HeightField(3, 3, 0.5, 0.5, std::vector<double>(9, 0.0)));
    scene.add(is_hilly_above ? plain : hills, {0, 0, 0}, Mat3::Identity(), false);
    scene.add(is_hilly_above ? hills : plain, {0.02, 0.01, 0.099 + (is_hilly_above ? 0.0 : 0.0)},
              turned(3.14159265358979, {1, 0, 0}));
    scene.detect();
    CAPTURE(is_hilly_above);
    REQUIRE(scene.contacts.size() == 4);
    for (const ContactPoint& p : scene.contacts) {
      CHECK((p.normal - Vec3(0, 0, 1)).norm() < 1e-9);
      CHECK(std::abs(p.gap + 1e-3) < 1e-9);
      CHECK(p.a == 0);
    }
  }
}

}  // namespace deep_meshes_tests
