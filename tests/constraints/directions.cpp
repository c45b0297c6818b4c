// H of every law against central differences: of φ where the law has one, of the points' distance else.
#include <delassus/delassus.hpp>

#include "catch.hpp"
#include "constraints/poses.hpp"

namespace directions_tests {

using namespace delassus;
using namespace poses;

TEST_CASE("H of a closed ball joint is the derivative of its violation") {
  each_pair([](int a, int b, Scene& scene) {
    const Vec3 point = scene.vector();
    const BallJoint::Item item{scene.end_at(a, point), scene.end_at(b, point)};
    const Written<BallJoint> rows({}, item, scene.world);
    CHECK(rows.phi.norm() <= 1e-15 * 8);
    CHECK(difference<3>(scene, rows.H, [&] { return Written<BallJoint>({}, item, scene.world).phi; }) <=
          1e-8);
  });
}

// Open, its row is the relative velocity of the material points at one place, where both impulses act: the
// particle's, or the middle of the anchors.
TEST_CASE("H of an open ball joint is the relative velocity at the one point where its impulses act") {
  each_pair([](int a, int b, Scene& scene) {
    const BallJoint::Item item{scene.end(a), scene.end(b)};
    const Vec3 xa = scene.world.point(item.a), xb = scene.world.point(item.b);
    const Vec3 point = a == 2 || a == 3 ? xa : b == 2 || b == 3 ? xb : Vec3(0.5 * (xa + xb));
    const auto at_point = [&](Anchor end) {
      if (end.set == 0) end.local = scene.set<RigidBodies>().pose(end.block).to_local(point);
      return end;
    };
    const Anchor first = at_point(item.a), second = at_point(item.b);
    const Written<BallJoint> rows({}, item, scene.world);
    CHECK(difference<3>(scene, rows.H,
                        [&] { return Vec3(scene.world.point(first) - scene.world.point(second)); }) <= 1e-8);
  });
}

TEST_CASE("H of a distance joint is the derivative of its violation, closed or open") {
  each_pair([](int a, int b, Scene& scene) {
    const DistanceJoint::Item item{scene.end(a), scene.end(b), 0.7};
    const Written<DistanceJoint> rows({}, item, scene.world);
    CHECK(rows.phi[0] == Approx((scene.world.point(item.a) - scene.world.point(item.b)).norm() - 0.7));
    // Second derivatives grow like 1/length; the shortest of these is 0.2 m, which adds (1e-6)²/0.2² · 4.
    CHECK(difference<1>(scene, rows.H, [&] { return Written<DistanceJoint>({}, item, scene.world).phi; }) <=
          1e-8);
  });
}

TEST_CASE("H of a contact is the relative velocity at its point, along normal and tangents") {
  using Law = Contact<Coulomb>;
  each_pair([](int a, int b, Scene& scene) {
    const Vec3 normal = scene.vector().normalized(), point = scene.vector();
    const double gap = 0.1 * scene.draw();
    const ContactRecord record{.a = scene.end_at(a, point),
                               .b = scene.end_at(b, point),
                               .point_a = point - 0.5 * gap * normal,
                               .point_b = point + 0.5 * gap * normal,
                               .normal = normal,
                               .gap = gap};
    const Law::Item item{&record, record.point(), gap, contact_frame(normal)};
    const Written<Law> rows({}, item, scene.world);
    CHECK(rows.phi[0] == gap);
    CHECK(difference<3>(scene, rows.H, [&] {
            return Vec3(item.frame * (scene.world.point(record.b) - scene.world.point(record.a)));
          }) <= 1e-8);
  });
}

TEST_CASE("the frame of a contact is right-handed and orthonormal for every normal") {
  Scene scene(7);
  const auto check = [](const Vec3& n) {
    const Mat3 frame = contact_frame(n);
    CHECK(frame.row(0).transpose() == n);
    // A dozen roundings of numbers up to 1/(1 + n_z) = 4.
    CHECK((frame * frame.transpose() - Mat3::Identity()).norm() <= 8e-15);
    CHECK(frame.determinant() == Approx(1).epsilon(1e-14));
  };
  for (int k = 0; k < 3; ++k) {
    check(Vec3::Unit(k));
    check(-Vec3::Unit(k));
  }
  for (int n = 0; n < 1000; ++n) check(scene.vector().normalized());
  for (double tilt : {1e-8, 1e-12, 1e-16}) check(Vec3(tilt, tilt, -1).normalized());
}

TEST_CASE("a distance joint between coinciding points acts along z") {
  Scene scene(1);
  const Vec3 point = scene.vector();
  const DistanceJoint::Item item{scene.end_at(2, point), world_anchor(point), 0.0};
  const Written<DistanceJoint> rows({}, item, scene.world);
  CHECK(rows.phi[0] == 0);
  CHECK(rows.H.middleCols<3>(12) == Vec3::UnitZ().transpose());
}

}  // namespace directions_tests
