// Impacts that go from contact to contact, against those that are solved together.
#include "scenes.hpp"

#include "catch.hpp"

namespace sequential_impacts_tests {

using namespace scenes;

namespace {

constexpr double radius = 0.1;

/// Balls in a row along x that touch, without gravity, the first with 1 m/s.
auto row_of_balls(const std::vector<double>& masses, double restitution) {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{SequentialRestitution{Coulomb{.friction = 0.3}, restitution}}}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  for (std::size_t i = 0; i < masses.size(); ++i)
    set.add({.position = {2 * radius * double(i), 0, 0}, .mass = masses[i], .shape = Sphere{radius}});
  set.set_velocity(set.handle(0), {1, 0, 0});
  return loop;
}
template <class Loop>
std::vector<double> speeds(const Loop& loop) {
  std::vector<double> v;
  const auto& set = loop.world().template set<0>();
  for (Index b = 0; b < set.blocks(); ++b) v.push_back(set.velocity()[b][0]);
  return v;
}

}  // namespace

TEST_CASE("touching balls of one mass pass an elastic impact on: the last one leaves alone") {
  for (const int count : {3, 4, 5}) {
    auto loop = row_of_balls(std::vector<double>(std::size_t(count), 1.0), 1);
    loop.step(1e-3);
    const std::vector<double> v = speeds(loop);
    CAPTURE(count);
    for (int i = 0; i + 1 < count; ++i) CHECK(std::abs(v[i]) <= 1e-10);
    CHECK(v[count - 1] == Approx(1).epsilon(0).margin(1e-10));
    // What a contact says it carried is the momentum that went through it.
    REQUIRE(loop.contacts().size() == std::size_t(count - 1));
    for (const ContactResult& c : loop.contacts()) CHECK(c.impulse.norm() == Approx(1).epsilon(1e-10));
  }
}

// AC-25: gaps of a micrometre, ten times less than a ball goes in a step of 1e-5 s.
TEST_CASE("balls a micrometre apart pass an elastic impact on in turn, in steps longer than their gaps") {
  for (const int count : {3, 5}) {
    AnimationLoop loop{World{RigidBodies{}},
                       Constraints{Contact{SequentialRestitution{Coulomb{.friction = 0.3}, 1.0}}}};
    auto& set = rigid_bodies(loop);
    set.gravity.setZero();
    for (int i = 0; i < count; ++i)
      set.add({.position = {(2 * radius + 1e-6) * i, 0, 0}, .mass = 1.0, .shape = Sphere{radius}});
    set.set_velocity(set.handle(0), {1, 0, 0});
    for (int n = 0; n < 10; ++n) loop.step(1e-5);
    const std::vector<double> v = speeds(loop);
    CAPTURE(count);
    for (std::size_t i = 0; i + 1 < v.size(); ++i) CHECK(std::abs(v[i]) <= 1e-10);
    CHECK(v.back() == Approx(1).epsilon(0).margin(1e-10));
  }
}

// One impact after the other: v₁ = (m₁ − e m₂)/(m₁ + m₂) of the first pair, (1 + e) m₁/(m₁ + m₂) into the
// second. With rising masses the second ball comes back and hits the first no more.
TEST_CASE("unequal balls share an impact pair by pair, as the masses and e say") {
  const std::vector<double> m{1, 2, 20};
  const double e = 0.8;
  auto loop = row_of_balls(m, e);
  loop.step(1e-3);
  const std::vector<double> v = speeds(loop);
  const double first = (m[0] - e * m[1]) / (m[0] + m[1]), passed = (1 + e) * m[0] / (m[0] + m[1]);
  const double second = passed * (m[1] - e * m[2]) / (m[1] + m[2]),
               third = passed * (1 + e) * m[1] / (m[1] + m[2]);
  REQUIRE(second < first);
  const double again = (1 + e) * (second - first) / (m[0] + m[1]);
  CHECK(v[0] == Approx(first + m[1] * again).epsilon(0).margin(1e-10));
  CHECK(v[1] == Approx(second - m[0] * again).epsilon(0).margin(1e-10));
  CHECK(v[2] == Approx(third).epsilon(0).margin(1e-10));
}

// Momentum is kept by every pair of impulses, and energy at e = 1; without bound on the rounds but that of
// the law.
TEST_CASE("a break of fifteen balls keeps momentum and energy") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{SequentialRestitution{Coulomb{.friction = 0}, 1.0}}}};
  auto& set = rigid_bodies(loop);
  set.gravity.setZero();
  for (int row = 0; row < 5; ++row)
    for (int k = 0; k <= row; ++k)
      set.add({.position = {std::sqrt(3.0) * radius * row, (2 * k - row) * radius, 0},
               .mass = 1.0,
               .shape = Sphere{radius}});
  set.add({.position = {-2 * radius, 0.3 * radius, 0},
           .velocity = {3, 0, 0},
           .mass = 1.0,
           .shape = Sphere{radius}});
  for (int n = 0; n < 100; ++n) REQUIRE(loop.step(1e-3).status <= Status::stalled);
  Vec3 momentum = Vec3::Zero();
  for (const auto& v : set.velocity()) momentum += v.head<3>();
  CHECK((momentum - Vec3(3, 0, 0)).norm() <= 1e-12);
  CHECK(kinetic_energy(set) == Approx(4.5).epsilon(1e-9));
  CHECK(speeds(loop)[0] != 0);
}

// A rod without gravity that strikes the ground with one end, against its slip. Newton's law for the normal alone would give it
// the energy that friction turns round. What is left are the roundings of sums of squares: 1e-12 of the energy.
TEST_CASE("a rod that strikes the ground against its slip gains nothing under the sequential law") {
  for (const double angle : {0.3, 0.785, 1.2})
    for (const double slip : {-0.7, 0.0, 0.7}) {
      AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{SequentialRestitution{Coulomb{.friction = 0.5}, 1.0}}}};
      auto& set = rigid_bodies(loop);
      set.gravity.setZero();
      set.add_fixed(HalfSpace{});
      set.add({.position = {0, 0, 0.5 * std::sin(angle) + 0.02},
               .orientation = Quat(Eigen::AngleAxisd(angle, Vec3(0, 1, 0))),
               .velocity = {slip, 0, -1},
               .mass = 1.0,
               .shape = Box{1, 0.02, 0.02}});
      const double before = kinetic_energy(set);
      bool is_struck = false;
      for (int n = 0; n < 60; ++n) {
        loop.step(1e-3);
        CAPTURE(angle, slip, n);
        CHECK(kinetic_energy(set) <= before * (1 + 1e-12));
        for (const ContactResult& c : loop.contacts()) is_struck = is_struck || c.impulse.z() > 0.1;
      }
      CHECK(is_struck);
    }
}

// At rest nothing closes: the weight goes through the solve as ever, and the ball stands.
TEST_CASE("a ball that bounces under the sequential law comes to rest") {
  AnimationLoop loop{World{RigidBodies{}},
                     Constraints{Contact{SequentialRestitution{Coulomb{.friction = 0.3}, 0.5}}}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  const auto ball = set.add({.position = {0, 0, 1 + radius}, .mass = 1.0, .shape = Sphere{radius}});
  double after = 0;
  for (int n = 0; n < 3000; ++n) {
    loop.step(1e-3);
    after = std::max(after, set.velocity(ball).z());
  }
  CHECK(after == Approx(0.5 * std::sqrt(2 * g)).epsilon(0.01));  // h g of 4.43 m/s
  CHECK(set.velocity(ball).norm() <= g * 1e-3);
  CHECK(set.position(ball).z() == Approx(radius).margin(1e-4));
}

}  // namespace sequential_impacts_tests
