// A cylinder or a cone that is let go at a lean rocks down.
#include "scenes.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>

namespace rocking_cylinder_tests {

using namespace scenes;

namespace {

/// A round body of 1 kg that stands on its base, its centre of mass at the height `centre` over it.
struct Standing {
  Shape shape;
  double radius, centre;
  Vec3 inertia;

  /// About a point of the rim, across the plane in which it rocks.
  double about_rim() const { return inertia.x() + radius * radius + centre * centre; }
  double energy_at(double lean) const {
    return g * (radius * std::sin(lean) - centre * (1 - std::cos(lean)));
  }
};

Standing cylinder(double r, double height) {
  const double across = (3 * r * r + height * height) / 12;
  return {Cylinder{r, height}, r, 0.5 * height, {across, across, 0.5 * r * r}};
}

Standing cone(double r, double height) {
  const double across = 3 * (4 * r * r + height * height) / 80;
  return {Cone{r, height}, r, 0.25 * height, {across, across, 0.3 * r * r}};
}

struct Rocked {
  double start = 0, highest = 0, last = 0;  ///< energy over that of standing, J
};

/// Let go where it touches the ground z = 0 at one point, 17° beside a corner of its octagon.
Rocked rock(const Standing& body, const Shape& ground, double below, double lean, double h, double seconds) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& set = bodies<RigidBodies>(loop.world());
  set.add_fixed(ground, {0, 0, -below});
  const Quat turn(Eigen::AngleAxisd(lean, Vec3(1, 0.3, 0).normalized()));
  const Vec3 lowest = turn * support(body.shape, turn.conjugate() * Vec3(0, 0, -1));
  set.add({.position = {0, 0, -lowest.z()},
           .orientation = turn,
           .mass = 1.0,
           .inertia = Mat3(body.inertia.asDiagonal()),
           .shape = body.shape});
  const auto energy = [&] { return kinetic_energy(set) + potential_energy(set) - g * body.centre; };
  Rocked seen{.start = energy(), .highest = energy()};
  for (long n = std::lround(seconds / h); n > 0; --n) {
    loop.step(h);
    seen.highest = std::max(seen.highest, energy());
  }
  seen.last = energy();
  return seen;
}

/// Rocking in a plane, an impact leaves 1 − 2 m r²/I of the angular velocity, I being about the rim, by the
/// moment of momentum about the other end of the diameter [Housner1963]. From lean to lean it takes twice √(2
/// I θ/(m g r)), θ going with the square of what is left: a geometric series.
double time_to_rest(const Standing& body, double lean) {
  const double kept = 1 - 2 * body.radius * body.radius / body.about_rim();
  const double fall = std::sqrt(2 * body.about_rim() * lean / (g * body.radius));
  return fall * (1 + 2 * kept / (1 - kept));
}

/// The explicit step keeps E − ½ h m g v of the centre's upward velocity v, which is r ω at most, and ω that
/// which takes all of the energy. Contacts do no work: they act where the rim touches.
void check_growth(const Standing& body, const Rocked& seen, double lean, double h) {
  const double fastest = body.radius * std::sqrt(2 * seen.start / body.about_rim());
  CAPTURE(name(body.shape.kind), body.radius, lean, h, seen.start, seen.highest, seen.last);
  CHECK(seen.start == Approx(body.energy_at(lean)).epsilon(1e-6));
  CHECK(seen.highest <= seen.start + 0.5 * h * g * fastest);
}

}  // namespace

// A can that rocks in one plane loses energy from rim to rim, a slender one 11 %: it is at rest after
// Housner's time, and after twice that if corners catch it out of the plane.
TEST_CASE("a cylinder that is let go at a lean gains no energy and comes to rest") {
  const Standing body = cylinder(0.1, 1);
  for (const double lean : {1e-5, 1e-4, 1e-3, 1.5e-3, 2.1e-3, 3e-3, 1e-2})
    for (const double h : {4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4}) {
      const double seconds = 2 * time_to_rest(body, lean) + 10 * h;
      const Rocked seen = rock(body, Shape(HalfSpace{}), 0, lean, h, seconds);
      check_growth(body, seen, lean, h);
      CAPTURE(lean, h, seen.start);
      CHECK(seen.last <= 1e-3 * seen.start);
    }
}

// One that does not rock in a plane may roll on without loss: of these nothing is said but that they gain
// nothing.
TEST_CASE("on a box and on a cap a leaning cylinder, and a cone, gain no energy") {
  for (const Standing& body : {cylinder(0.1, 1), cylinder(0.5, 1), cone(0.3, 0.6), cone(0.1, 1)})
    for (const double lean : {1e-4, 1.5e-3, 3e-3})
      for (const double h : {2e-3, 5e-4}) {
        check_growth(body, rock(body, Shape(Box{4, 4, 1}), 0.5, lean, h, 2), lean, h);
        check_growth(body, rock(body, Shape(Cylinder{2, 1}), 0.5, lean, h, 2), lean, h);
      }
}

// It falls in a vertical plane, of which the scene is its own mirror image: no motion leaves that plane. Steps end at 1e-3 of the speeds.
TEST_CASE("what leans and falls flat is not thrown sideways") {
  struct Fall {
    Shape shape;
    double friction, lean;
  };
  for (const Fall& fall : {Fall{Cylinder{0.25, 0.3}, 0.5, 0.6}, Fall{Cylinder{0.3, 0.05}, 0, 0.42}, Fall{Cone{0.25, 0.5}, 0, 0.7}})
    for (const double h : {1.0 / 60, 1.0 / 240})
      for (const double head : {0.0, 0.3}) {
        AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = fall.friction}}}};
        auto& set = bodies<RigidBodies>(loop.world());
        set.add_fixed(HalfSpace{});
        const Quat heading(Eigen::AngleAxisd(head, unit_axis(2))), lean(Eigen::AngleAxisd(fall.lean, unit_axis(1)));
        const auto body = set.add({.position = {0, 0, 0.6}, .orientation = heading * lean, .mass = 1.0, .shape = fall.shape});
        double within = 0, beside = 0;
        for (double t = 0; t < 1.5; t += h) {
          loop.step(h);
          const Vec3 spin = heading.conjugate() * set.angular_velocity(body);
          within = std::max(within, std::abs(spin.y())), beside = std::max(beside, std::hypot(spin.x(), spin.z()));
        }
        CAPTURE(h, head, fall.lean);
        CHECK(within > 2);
        CHECK(beside < 1e-3 * within);
      }
}

// The edge over which it tips is the rim, though the cap that lies flat has eight corners: it falls at tan θ
// = 2 r / height.
TEST_CASE("a cylinder on a slope stands until its centre of mass is over its rim") {
  const double r = 0.5, height = 2;
  for (const double share : {0.985, 1.015}) {
    const double slope = share * std::atan(2 * r / height);
    AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 1}}}};
    auto& set = bodies<RigidBodies>(loop.world());
    const Quat lean(Eigen::AngleAxisd(slope, Vec3::UnitY()));
    set.add_fixed(HalfSpace{lean * unit_axis(2), 0});
    const Quat between(Eigen::AngleAxisd(M_PI / 8, unit_axis(2)));  // two corners at the same height
    const auto body = set.add({.position = lean * Vec3(0, 0, 0.5 * height),
                               .orientation = lean * between,
                               .mass = 1.0,
                               .shape = Cylinder{r, height}});
    for (int n = 0; n < 200; ++n) loop.step(0.005);
    const double leaning = (set.orientation(body) * unit_axis(2)).dot(lean * unit_axis(2));
    CAPTURE(share, leaning);
    CHECK((leaning > 1 - 1e-6) == (share < 1));
  }
}

}  // namespace rocking_cylinder_tests
