#include "scenes.hpp"

#include "catch.hpp"

namespace quarantine_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 60;

auto contact_loop() {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  rigid_bodies(loop).add_fixed(HalfSpace{});
  return loop;
}

template <class Set>
std::vector<RigidBodies::Handle> add_tower(Set& set, double x, int count) {
  std::vector<RigidBodies::Handle> boxes;
  for (int i = 0; i < count; ++i)
    boxes.push_back(set.add({.position = {x + 0.01 * i, 0, 0.55 + 1.02 * i}, .mass = 1.0 + i, .shape = Box{1, 1, 1}}));
  return boxes;
}

const double not_a_number = std::numeric_limits<double>::quiet_NaN();
const double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a force that is not finite holds its island where it was, counts its bodies, and leaves the rest to the bit") {
  for (const double bad : {not_a_number, infinity, -infinity}) {
    auto loop = contact_loop(), alone = contact_loop();
    auto &set = rigid_bodies(loop), &reference = rigid_bodies(alone);
    const auto good = add_tower(set, 0, 4), expected = add_tower(reference, 0, 4), sick = add_tower(set, 10, 3);
    for (int n = 0; n < 200; ++n) {
      const bool is_bad = n >= 100 && n < 110;
      if (is_bad) set.apply_force(sick[1], {0, bad, 0});
      const Vec3 before = set.position(sick[2]);
      const StepReport report = loop.step(h);
      alone.step(h);
      CAPTURE(n, bad);
      REQUIRE((report.status == Status::quarantined) == is_bad);
      REQUIRE(report.quarantined == (is_bad ? 3 : 0));
      if (is_bad) REQUIRE(set.position(sick[2]) == before);
      for (std::size_t i = 0; i < good.size(); ++i) {
        REQUIRE(set.position(good[i]) == reference.position(expected[i]));
        REQUIRE(set.orientation(good[i]).coeffs() == reference.orientation(expected[i]).coeffs());
        REQUIRE(set.velocity(good[i]) == reference.velocity(expected[i]));
      }
    }
  }
}

TEST_CASE("an island that was quarantined stands again when the force is gone") {
  auto loop = contact_loop();
  auto& set = rigid_bodies(loop);
  const auto sick = add_tower(set, 0, 3);
  for (int n = 0; n < 100; ++n) loop.step(h);
  for (int n = 0; n < 10; ++n) {
    set.apply_force(sick[0], {not_a_number, 0, 0});
    loop.step(h);
  }
  StepReport report;
  for (int n = 0; n < 200; ++n) report = loop.step(h);
  REQUIRE(report.status == Status::converged);
  REQUIRE(report.contacts == 12);
  for (int i = 0; i < 3; ++i) REQUIRE(set.position(sick[i]).z() == Approx(0.5 + i).margin(1e-3));
  double carried = 0;
  for (const ContactResult& c : loop.contacts())
    if (c.record.point().z() < 0.1) carried += c.impulse.z() / h;
  REQUIRE(std::abs(carried) == Approx(6 * g).epsilon(1e-5));
}

TEST_CASE("a free body with a force that is not finite stays where it was, alone") {
  auto loop = contact_loop();
  auto& set = rigid_bodies(loop);
  const auto sick = set.add({.position = {0, 0, 5}, .mass = 1.0, .shape = Sphere{0.1}});
  const auto other = set.add({.position = {3, 0, 5}, .mass = 1.0, .shape = Sphere{0.1}});
  set.apply_torque(sick, {0, infinity, 0});
  const StepReport report = loop.step(h);
  REQUIRE(report.status == Status::quarantined);
  REQUIRE(report.quarantined == 1);
  REQUIRE(set.position(sick) == Vec3(0, 0, 5));
  REQUIRE(set.position(other).z() == Approx(5 - g * h * h).epsilon(1e-15));
  REQUIRE(loop.step(h).status == Status::converged);
}

// 6e37 kg in single precision: the impulses that hold it are no numbers.
TEST_CASE("an island whose solver met what is no number stays where it was") {
  AnimationLoop loop{World{RigidBodiesF{}}, Constraints{Contact{Coulomb{.friction = 0.5}}}};
  auto& set = bodies<RigidBodiesF>(loop.world());
  set.add_fixed(HalfSpace{});
  for (int k = 0; k < 3; ++k) set.add({.position = {0, 0, 0.5 + k}, .mass = 6e37, .shape = Box{1, 1, 1}});
  int quarantined = 0;
  for (int n = 0; n < 30; ++n) {
    const StepReport report = loop.step(h);
    if (report.status == Status::quarantined) quarantined += report.quarantined == 3;
  }
  for (Index b = 0; b < set.blocks(); ++b)
    if (set.moves(b)) CHECK(set.pose(b).position.z() >= 0.49);
  CHECK(quarantined > 0);
}

TEST_CASE("each island has its own sweeps and its own status") {
  auto loop = AnimationLoop{World{RigidBodies{}}, Constraints{Contact{Coulomb{.friction = 0.5}}},
                            AcceleratedSweeps{.max_iterations = 30}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  set.add({.position = {-9, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.5}});
  for (int i = 0; i < 10; ++i) set.add({.position = {0.001 * i, 0, 0.5 + i}, .mass = 1.0, .shape = Box{1, 1, 1}});
  set.add({.position = {9, 0, 0.5}, .mass = 1.0, .shape = Sphere{0.5}});
  const StepReport report = loop.step(h);
  const auto islands = loop.island_reports();
  REQUIRE(islands.size() == 3);
  REQUIRE(islands[0].status == Status::converged);
  REQUIRE(islands[0].sweeps == 1);
  REQUIRE(islands[1].status == Status::max_iterations);
  REQUIRE(islands[1].sweeps == 30);
  REQUIRE(islands[2].status == Status::converged);
  REQUIRE(report.status == Status::max_iterations);
  REQUIRE(report.residual == islands[1].measure.residual);
}

// 1e308 m/s for ten seconds is no place; the body keeps its last one, and its own company is not disturbed.
TEST_CASE("a body that would leave the range of its numbers stays where it was, and is counted") {
  const auto check = [](auto integrator) {
    AnimationLoop loop{World{RigidBodies{}, Particles{}}, integrator};
    auto& set = rigid_bodies(loop);
    auto& points = bodies<Particles>(loop.world());
    for (auto* gravity : {&set.gravity, &points.gravity}) gravity->setZero();
    const auto fast = set.add({.position = {1, 2, 3}, .velocity = {1e308, 0, 0}, .mass = 1.0, .shape = Sphere{1}});
    const auto spun = set.add({.position = {4, 5, 6}, .angular_velocity = {0, 1e308, 0}, .mass = 1.0, .shape = Box{1, 2, 3}});
    const auto lift = set.add({.position = {7, 8, 9}, .velocity = {0, 0, 1e308}, .shape = Sphere{1}, .motion = Motion::kinematic});
    const auto well = set.add({.velocity = {1, 0, 0}, .mass = 1.0, .shape = Sphere{1}});
    const auto grain = points.add({.position = {1, 1, 1}, .velocity = {0, 1e308, 0}, .mass = 1.0});
    for (int n = 1; n <= 3; ++n) {
      const StepReport report = loop.step(10);
      REQUIRE(report.status == Status::quarantined);
      REQUIRE(report.quarantined == 4);
      REQUIRE(set.position(fast) == Vec3(1, 2, 3));
      REQUIRE(set.velocity(fast) == Vec3(1e308, 0, 0));
      REQUIRE(set.position(spun) == Vec3(4, 5, 6));
      REQUIRE(set.orientation(spun).coeffs() == Quat::Identity().coeffs());
      REQUIRE(set.angular_velocity(spun) == Vec3(0, 1e308, 0));
      REQUIRE(set.position(lift) == Vec3(7, 8, 9));
      REQUIRE(points.position(grain) == Vec3(1, 1, 1));
      REQUIRE(set.position(well) == Vec3(10.0 * n, 0, 0));
    }
    set.set_velocity(fast, {1, 0, 0});
    loop.step(10);
    REQUIRE(set.position(fast) == Vec3(11, 2, 3));
  };
  check(SymplecticEuler{});
  check(ImplicitMidpoint{});
}

TEST_CASE("a policy whose number was made invalid is refused at the next step, and nothing has moved") {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{Contact{Coulomb{}}}, GaussSeidel{}};
  auto& set = rigid_bodies(loop);
  const auto ball = set.add({.position = {0, 0, 5}, .mass = 1.0, .shape = Sphere{1}});
  for (const double bad : {0.0, 2.0, -1.0, not_a_number}) {
    loop.get<GaussSeidel>().relaxation = bad;
    REQUIRE_THROWS_WITH(loop.step(0.01), Catch::Contains("GaussSeidel: relaxation") && Catch::Contains("must lie in (0, 2)"));
  }
  loop.get<GaussSeidel>().relaxation = 1.5;
  loop.policy<role::Stabilisation>().rate = -1;  // a default nobody named
  REQUIRE_THROWS_WITH(loop.step(0.01), Catch::Contains("Baumgarte: rate"));
  REQUIRE(set.position(ball) == Vec3(0, 0, 5));
  loop.policy<role::Stabilisation>().rate = 0.2;
  REQUIRE(loop.step(0.01).status == Status::converged);
}

}  // namespace quarantine_tests
