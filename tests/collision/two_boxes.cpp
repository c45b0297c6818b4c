#include "catch.hpp"
#include "collision/samples.hpp"

#include <delassus/collision/certified_pair.hpp>
#include <delassus/collision/inner/snap_normal.hpp>
#include <delassus/collision/inner/two_boxes.hpp>

#include <cmath>
#include <random>

namespace two_boxes_tests {

using namespace delassus;

namespace {

/// Poses of all kinds: turned anyhow, aligned, aligned but for a little, as near as they touch.
struct Poses {
  std::mt19937 random;
  std::uniform_real_distribution<double> uniform{-1, 1};

  explicit Poses(unsigned seed) : random(seed) {}
  double between(double low, double high) { return low + 0.5 * (high - low) * (uniform(random) + 1); }
  Shape box() { return Box{between(0.1, 1), between(0.1, 1), between(0.1, 1)}; }
  Mat3 small_turn(double angle) {
    return Eigen::AngleAxisd(angle, samples::any_direction(random)).toRotationMatrix();
  }
  Mat3 quarter_turn() {
    Mat3 turn = Mat3::Zero();
    const int k = int(random() % 3);
    turn(0, k) = 1, turn(1, (k + 1) % 3) = 1, turn(2, (k + 2) % 3) = 1;
    return turn;
  }
  Pose pose(int kind) {
    Pose p{.position = Vec3(uniform(random), uniform(random), uniform(random)), .rotation = Mat3::Identity()};
    if (kind % 4 == 0) p.rotation = samples::any_rotation(random);
    if (kind % 4 == 1) p.rotation = small_turn(std::pow(10., between(-9, -2)));
    if (kind % 4 == 2) p.rotation = quarter_turn();
    if (kind % 4 == 3) p.rotation = small_turn(1e-3) * quarter_turn();
    return p;
  }
};

SignedPair in_full(const Shape& a, const Shape& b, const Pose& pose, double margin, double scale) {
  GjkEpa kernel;
  SignedPair r = inner::better_pair(kernel, a, b, pose, margin, scale, zero<Vec3>()).pair;
  if (r.status == PairStatus::near) inner::Straighten{a, b, pose, scale}(r, true);
  return r;
}

bool holds(const Shape& box, const Vec3& p, double slack) {
  for (int k = 0; k < 3; ++k)
    if (!(std::abs(p[k]) <= box.size[k] + slack)) return false;
  return true;
}

}  // namespace

TEST_CASE("two boxes have the distance of the search in full") {
  Poses poses(1);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  int answers = 0, overlaps = 0, edges = 0;
  for (int i = 0; i < 20000; ++i) {
    const Shape a = poses.box(), b = poses.box();
    Pose pose = poses.pose(i);
    const double scale = std::min(length_scale(a), length_scale(b));
    if (i % 3 == 0) {  // as near as they touch, or by 1e-4 of it
      const SignedPair r = in_full(a, b, pose, infinity, scale);
      pose.position -= (r.distance - (i % 2 ? 1e-4 * scale * poses.uniform(poses.random) : 0.0)) * r.normal;
    }
    const SignedPair full = in_full(a, b, pose, infinity, scale);
    SignedPair r;
    if (!inner::two_boxes(a, b, pose, infinity, r)) {
      REQUIRE(full.distance > -1e-9 * scale);  // of an overlap it always tells
      continue;
    }
    ++answers, overlaps += r.distance < 0, edges += inner::BoxAxis(a, b, pose).face < 0;
    const double tolerance = 2e-9;  // the search ends within 1e-9 of the size
    INFO("pose " << i);
    REQUIRE(std::abs(r.distance - full.distance) <= tolerance);
    // Its normal proves what the answer claims, and its points are where the bodies are.
    SignedPair proven = r;
    REQUIRE(certify(a, b, pose, infinity, scale, proven));
    REQUIRE(std::abs(proven.distance - r.distance) <= 1e-15);
    REQUIRE((r.point_b - r.point_a - r.distance * r.normal).norm() <= 1e-14);
    if (r.distance > 0) {
      REQUIRE(holds(a, r.point_a, 2e-9 * r.distance + 2e-14));
      REQUIRE(holds(b, pose.to_local(r.point_b), 2e-9 * r.distance + 2e-14));
    } else {
      REQUIRE(holds(a, r.point_a, 1e-6 * scale));
      REQUIRE(holds(b, pose.to_local(r.point_b), 1e-6 * scale));
    }
    // Where no other axis does as well, the normals agree: one that leans by θ proves R θ²/2 less, of 1e-9
    // that is 1e-4.
    if (r.normal.dot(full.normal) < 1 - 1e-8) {
      SignedPair other = full;
      other.normal = full.normal;
      REQUIRE(certify(a, b, pose, infinity, scale, other));
      REQUIRE(std::abs(other.distance - r.distance) <= tolerance);
    }
  }
  CHECK(answers > 12000);
  CHECK(overlaps > 3000);
  CHECK(edges > 500);
}

TEST_CASE("boxes farther apart than the margin are far and within it near") {
  Poses poses(2);
  int far = 0;
  for (int i = 0; i < 4000; ++i) {
    const Shape a = poses.box(), b = poses.box();
    Pose pose = poses.pose(i);
    pose.position *= 1.5;
    const double scale = std::min(length_scale(a), length_scale(b)), margin = 0.1;
    const SignedPair full = in_full(a, b, pose, margin, scale);
    SignedPair r;
    if (!inner::two_boxes(a, b, pose, margin, r)) continue;
    if (r.status == PairStatus::far) REQUIRE(full.status == PairStatus::far);
    far += r.status == PairStatus::far;
  }
  CHECK(far > 500);
}

// The deepest corner may be beside the face that it is under: its nearest point there need not be in both.
TEST_CASE("the points of an overlap are in both boxes however little they overlap") {
  Poses poses(4);
  int answers = 0;
  for (int i = 0; i < 20000; ++i) {
    const Shape a = poses.box(), b = poses.box();
    Pose pose = poses.pose(3);
    pose.rotation = poses.small_turn(std::pow(10., poses.between(-12, -1))) * poses.quarter_turn();
    const double scale = std::min(length_scale(a), length_scale(b)),
                 depth = i % 4 == 0 ? 0 : scale * std::pow(10., poses.between(-16, -2));
    const SignedPair full = in_full(a, b, pose, 1e9, scale);
    pose.position -= (full.distance + depth) * full.normal;
    SignedPair r;
    if (!inner::two_boxes(a, b, pose, 1e9, r)) continue;
    ++answers;
    INFO("pose " << i << ", depth " << -r.distance);
    REQUIRE(holds(a, r.point_a, 1e-6 * scale));
    REQUIRE(holds(b, pose.to_local(r.point_b), 1e-6 * scale));
  }
  CHECK(answers > 5000);
}

// Both rotations are those of single precision, as `RigidBodiesF` hands them over: Rᵀ R = 1 to 1e-7 only, and
// the edges of boxes that are turned by θ against each other about z have a product that leans by 1e-7 / θ.
TEST_CASE("two boxes in single precision that are turned a little have the normal of their faces") {
  Poses poses(3);
  int answers = 0;
  for (int i = 0; i < 40000; ++i) {
    const Shape a = Box{1, 1, 1}, b = poses.box();
    const Quat first(samples::any_rotation(poses.random)),
        second = first * Quat(Eigen::AngleAxisd(std::pow(10., poses.between(-6, -5)), Vec3::UnitZ()));
    const auto single = [](const Quat& q) { return Mat3(q.cast<float>().toRotationMatrix().cast<double>()); };
    const double depth = std::pow(10., poses.between(-5, -3));
    const Pose pose{.position = {poses.between(-0.5, 0.5), poses.between(-0.5, 0.5), 0.5 + b.size[2] - depth},
                    .rotation = single(first).transpose() * single(second)};
    GjkEpa kernel;
    const double scale = std::min(length_scale(a), length_scale(b));
    SignedPair r = certified_pair(kernel, a, b, pose, 1, scale, zero<Vec3>()).pair, fast;
    answers += inner::two_boxes(a, b, pose, 1, fast);
    inner::snap_normal_to_face(a, b, pose, scale, inner::NormalOwner::kernel, r);
    // Faces that lean by 2e-7: over 1.5 m that is 3e-7 m.
    INFO("pose " << i);
    REQUIRE((r.normal - Vec3(0, 0, 1)).norm() < 1e-6);
    REQUIRE(std::abs(r.distance + depth) < 1e-6);
  }
  CHECK(answers == 0);
}

// Two needles along x, of half the lengths 1 and the half widths w, one turned by θ < w about the diagonal u
// across them. Along u they reach w √2 each (to θ² w), along y and z farther by θ / √2: so u is their axis,
// and the signed distance the gap along it. In BoxAxis 4e-15 of the sizes across them, 8 w, over θ may be
// wrong.
TEST_CASE("needles that are nearly parallel have the distance across their edges") {
  Poses poses(7);
  for (int i = 0; i < 2000; ++i) {
    const double w = 1e-6, angle = w * poses.between(0.5, 0.95), gap = w * poses.between(-0.2, 0.2);
    const Shape needle = Box{2, 2 * w, 2 * w};
    const Vec3 u = Vec3(0, 1, 1).normalized();
    const Pose pose{.position = (2 * std::sqrt(2.) * w + gap) * u,
                    .rotation = Eigen::AngleAxisd(angle, u).toRotationMatrix()};
    GjkEpa kernel;
    const SignedPair r = certified_pair(kernel, needle, needle, pose, 1, 1, zero<Vec3>()).pair;
    INFO("gap " << gap << " angle " << angle);
    // Apart, edges that are parallel to 1e-3 are left to the search, which ends within 1e-9 of the size; a
    // lean of the normal by θ counts in full.
    REQUIRE(std::abs(r.distance - gap) < (gap < 0 ? 1e-12 : 2e-9));
    if (gap < 0) REQUIRE((r.normal - u).norm() < 1e-6);
  }
}

TEST_CASE("a box over the face of another and one across its edge") {
  const Shape a = Box{1, 1, 1}, b = Box{0.2, 0.2, 0.2};
  SignedPair r;
  REQUIRE(inner::two_boxes(a, b, Pose{.position = {0.3, 0, 0.7}, .rotation = Mat3::Identity()}, 1, r));
  CHECK(r.normal == Vec3(0, 0, 1));
  CHECK(std::abs(r.distance - 0.1) < 1e-15);
  // Beside the face: the distance is one between two edges that are parallel, along no axis.
  CHECK(!inner::two_boxes(a, b, Pose{.position = {0.7, 0, 0.7}, .rotation = Mat3::Identity()}, 1, r));
  // In one place: the least way out of a cube in a cube.
  REQUIRE(inner::two_boxes(a, b, Pose{}, 1, r));
  CHECK(std::abs(r.distance + 0.6) < 1e-15);
  // Not a number.
  CHECK(!inner::two_boxes(a, b, Pose{.position = {std::nan(""), 0, 0}, .rotation = Mat3::Identity()}, 1, r));
}

}  // namespace two_boxes_tests
