#include <delassus/collision/seamless.hpp>
#include <delassus/delassus.hpp>

#include "catch.hpp"
#include "collision/scene.hpp"

namespace seamless_tests {

using namespace scenes;

namespace {

using Tiled = SceneOf<Seamless<NativeCollision>>;

/// A cube of 1 m that stands on the first of two tiles, its front at the seam; the second lies `lip` m higher.
Tiled at_the_seam(double lip, double before = 1e-3) {
  Tiled scene;
  scene.add(Box{4, 4, 1}, {-2, 0, -0.5}, Mat3::Identity(), false);
  scene.add(Box{4, 4, 1}, {2, 0, lip - 0.5}, Mat3::Identity(), false);
  scene.add(Box{1, 1, 1}, {-0.5 - before, 0, 0.5});
  scene.detect();
  return scene;
}

Index hindering(const Tiled& scene) {
  return Index(std::count_if(scene.contacts.begin(), scene.contacts.end(),
                             [](const ContactPoint& c) { return std::abs(c.normal.z()) < 0.999; }));
}

/// How far a body of 1 kg at 2 m/s leaves its height, m, and the share of its speed it loses, over 28 seams.
template <class Collision>
std::pair<double, double> over_tiles(Collision collision, const Shape& shape, const Quat& lying, double height) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, collision};
  auto& set = bodies<RigidBodies>(loop.world());
  for (int k = 0; k < 40; ++k) set.add_fixed(Box{0.5, 4, 1}, {0.5 * k, 0, -0.5});
  const auto body =
      set.add({.position = {2, 0, height}, .orientation = lying, .velocity = {2, 0, 0}, .mass = 1.0, .shape = shape});
  double hop = 0;
  for (int n = 0; n < 420; ++n) {
    loop.step(1.0 / 60);
    hop = std::max(hop, std::abs(set.position(body).z() - height));
  }
  return {hop, std::abs(set.velocity(body).x() / 2 - 1)};
}

}  // namespace

TEST_CASE("the edge of a tile that lies level is no obstacle, a lip higher than the level is") {
  for (const double before : {1e-3, 1e-6, 0.0, -1e-6}) {
    CAPTURE(before);
    const Tiled level = at_the_seam(0, before);
    CHECK(hindering(level) == 0);
    CHECK(level.contacts.size() >= 4);
    CHECK(level.report.points == Index(level.contacts.size()));
  }
  CHECK(hindering(at_the_seam(5e-4)) == 0);
  CHECK(hindering(at_the_seam(2e-3)) > 0);
  CHECK(hindering(at_the_seam(0.5)) > 0);
}

TEST_CASE("without the rule the edge of a level tile is in the way") {
  SceneOf<NativeCollision> scene;
  scene.colliders = at_the_seam(0).colliders;
  scene.detect();
  CHECK(std::any_of(scene.contacts.begin(), scene.contacts.end(),
                    [](const ContactPoint& c) { return std::abs(c.normal.z()) < 0.999; }));
}

TEST_CASE("a ball in a groove keeps both of its contacts, and so does a box on the floor against a wall") {
  // Faces at 45° whose planes are 0.5 m from the ball's middle: √½ (1 + z) − 1 = 0.5.
  Tiled groove;
  for (const double side : {-1., 1.})
    groove.add(Box{2, 2, 2}, {side, 0, 0}, Mat3(Eigen::AngleAxisd(-side * M_PI / 4, Vec3::UnitY())), false);
  groove.add(Sphere{0.5}, {0, 0, 1.5 * std::sqrt(2) - 1});
  groove.detect();
  REQUIRE(groove.contacts.size() == 2);
  for (const ContactPoint& c : groove.contacts) CHECK(std::abs(c.gap) < 1e-12);

  Tiled corner;
  corner.add(HalfSpace{}, {0, 0, 0}, Mat3::Identity(), false);
  corner.add(Box{1, 4, 4}, {1.0 + 1e-4, 0, 2}, Mat3::Identity(), false);
  corner.add(Box{1, 1, 1}, {0, 0, 0.5});
  corner.detect();
  CHECK(hindering(corner) == 4);
}

// The bodies' own plane is exact: what is left is the rounding of the solve.
TEST_CASE("bodies slide over 28 seams without a hop and keep their speed") {
  const Quat lying(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitX()));
  struct Slider {
    Shape shape;
    Quat turn;
    double height;
  };
  for (const Slider& s : {Slider{Sphere{0.5}, Quat::Identity(), 0.5}, Slider{Box{1, 1, 1}, Quat::Identity(), 0.5},
                          Slider{Cylinder{0.5, 1}, Quat::Identity(), 0.5}, Slider{Capsule{0.3, 0.6}, lying, 0.3}}) {
    const auto [hop, lost] = over_tiles(Seamless{NativeCollision{}}, s.shape, s.turn, s.height);
    CAPTURE(int(s.shape.kind), hop, lost);
    CHECK(hop < 1e-6);
    CHECK(lost < 1e-6);
  }
}

TEST_CASE("a level that is no length is refused") {
  for (const double level : {0.0, -1.0, std::nan("")})
    CHECK_THROWS_WITH((AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Frictionless{}}}, Seamless{NativeCollision{}, level}}),
                      Catch::Contains("Seamless: level"));
}

}  // namespace seamless_tests
