#include <delassus/constraints/contact/rolling_coulomb.hpp>

#include "catch.hpp"
#include "scenes.hpp"

#include <cmath>
#include <random>

namespace rolling_coulomb_tests {

using namespace scenes;

namespace {

constexpr double h = 1.0 / 120, R = 0.2, m = 3, mu_r = 0.004, mu_s = 0.003;

/// A ball that touches a plane with this normal through the origin.
struct Ball {
  AnimationLoop<World<RigidBodies>, Constraints<Contact<RollingCoulomb>>, AcceleratedGaussSeidel> loop;
  RigidBodies::Handle body;

  Ball(const RollingCoulomb& law, const Vec3& normal, const Vec3& velocity, const Vec3& spin)
      : loop{World{RigidBodies{}}, Constraints{Contact{law}}, AcceleratedGaussSeidel{.tolerance = 1e-13}} {
    auto& set = rigid_bodies(loop);
    set.add_fixed(HalfSpace{normal, 0});
    body = set.add({.position = R * normal,
                    .velocity = velocity,
                    .angular_velocity = spin,
                    .mass = m,
                    .shape = Sphere{R}});
  }
  Vec3 velocity() { return rigid_bodies(loop).velocity(body); }
  Vec3 spin() { return rigid_bodies(loop).angular_velocity(body); }
  Vec3 place() { return rigid_bodies(loop).position(body); }
};

constexpr RollingCoulomb law{.friction = 0.5, .rolling_friction = mu_r, .torsional_friction = mu_s};

}  // namespace

// The moment μ_r m g brakes 7/5 m R² of inertia about the contact: a = 5/7 μ_r g/R. A step takes h a from the
// speed, so that v_n = v₀ − n h a until it would change its sign, and then is zero; the way is h Σ v_n.
// Solves to 1e-13 of v₀ leave 1e-13 a step.
TEST_CASE("a ball rolls out after the distance that its rolling friction gives") {
  const double a = 5. / 7 * mu_r * g / R, v0 = 1;
  const Vec3 heading = Vec3(1, 2, 0).normalized();
  Ball ball(law, unit_axis(2), v0 * heading, (v0 / R) * unit_axis(2).cross(heading));
  double way = 0;
  for (int n = 1; n <= 1000; ++n) {
    ball.loop.step(h);
    const double v = std::max(v0 - n * h * a, 0.0);
    way += h * v;
    REQUIRE((ball.velocity() - v * heading).norm() <= 1e-13 * (n + 10));
    REQUIRE((ball.spin() - (v / R) * unit_axis(2).cross(heading)).norm() <= 1e-13 * (n + 10) / R);
  }
  REQUIRE(ball.velocity().norm() <= 1e-14 * v0);
  REQUIRE((ball.place() - Vec3(0, 0, R)).norm() == Approx(way).epsilon(1e-10));
  REQUIRE(way == Approx(v0 * v0 / (2 * a)).margin(v0 * h));  // of first order in h
}

// I dω/dt = −μ_s m g, I = 2/5 m R²: it stops after 2/5 R² ω₀/(μ_s g), at the step in which that falls.
TEST_CASE("a ball that spins on the spot stops at the time that its torsional friction gives") {
  const double slower = mu_s * g / (0.4 * R * R), w0 = 10;
  Ball ball(law, unit_axis(2), Vec3::Zero(), w0 * unit_axis(2));
  for (int n = 1; n <= 800; ++n) {
    ball.loop.step(h);
    const double w = std::max(w0 - n * h * slower, 0.0);
    REQUIRE((ball.spin() - w * unit_axis(2)).norm() <= 1e-13 * w0 * (n + 10));
    REQUIRE(ball.velocity().norm() <= 1e-13 * w0 * R * (n + 10));
    REQUIRE((w == 0) == (n * h >= w0 / slower));
  }
  REQUIRE(w0 / slower < 800 * h);  // it has stopped
}

// It stands while the moment m g sin θ R that would roll it is below μ_r m g cos θ. Above, it rolls with
// a = 5/7 (g sin θ − μ_r g cos θ/R), h a more a step.
TEST_CASE("a ball stands on slopes up to tan theta = mu_r/R, and rolls down steeper ones") {
  for (const double side : {1 - 1e-6, 1 + 1e-6, 2.0}) {
    const double slope = std::atan(side * mu_r / R);
    const Vec3 up(std::sin(slope), 0, std::cos(slope)), down(std::cos(slope), 0, -std::sin(slope));
    Ball ball(law, up, Vec3::Zero(), Vec3::Zero());
    for (int n = 0; n < 300; ++n) ball.loop.step(h);
    const double a = 5. / 7 * g * (std::sin(slope) - mu_r / R * std::cos(slope));
    CAPTURE(side);
    REQUIRE((ball.velocity() - std::max(a, 0.0) * 300 * h * down).norm() <= 1e-13 * g * h * 310);
    if (side < 1) REQUIRE(ball.velocity().norm() <= 1e-15);
    if (side > 1.5) REQUIRE(ball.velocity().norm() > 0.3);
  }
}

// Six rows of two bodies that touch, of any inertia: W = G Gᵀ, condition below 1e4, in any unit of turns. The
// equations of a visit are met to 1e-11 of the velocity that there would be without it.
TEST_CASE("one visit of rolling friction meets its law, whatever holds, slips, rolls or spins") {
  std::mt19937 random(5);
  const auto draw = [&] { return 2 * double(random()) / 4294967295.0 - 1; };
  int open = 0, seen[8] = {};
  for (int k = 0; k < 20000; ++k) {
    const double unit = std::pow(10, 3 * draw());
    Mat<6, 6> G, W;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) G(i, j) = (i == j ? 1.0 : 0.0) + 0.3 * draw();
    for (int i = 3; i < 6; ++i) G.row(i) *= unit;
    W = G * G.transpose();
    Vec<6> b;
    for (int i = 0; i < 6; ++i) b[i] = draw() * (i < 3 ? 1 : unit);
    const double rough = k % 4 == 0 ? 20 : k % 4 == 1 ? 1e3 : 0.5;
    RollingCoulomb::Parameters p{};
    p.friction = rough * std::abs(draw());
    p.rolling = rough * std::abs(draw()) / unit;
    p.torsional = rough * std::abs(draw()) / unit;
    if (k % 13 == 0) p.rolling = 1e9 / unit;  // what never rolls, unless its own moment lifts it
    RollingCoulomb::Memory<double> memory;
    law.prepare(W, memory);
    const Vec<6> lambda = law.solve_local(p, W, b, memory);
    const Vec<6> u = W * lambda + b;
    // In one unit of turns, as the law itself weighs them.
    Vec<6> x = lambda, v = u;
    for (int i = 3; i < 6; ++i) x[i] *= unit, v[i] /= unit;
    const RollingCoulomb::Parameters q{p.friction, p.rolling * unit, p.torsional * unit};
    CAPTURE(k);
    REQUIRE(law.natural_map(q, x, v, 1.0).norm() <= 1e-11 * b.norm() * std::max(1.0, 1 / unit));
    if (lambda[0] == 0) {
      ++open;
      continue;
    }
    const auto moves = [](double a, double c) { return std::hypot(a, c) > 1e-9; };
    ++seen[moves(v[1], v[2]) + 2 * moves(v[3], v[4]) + 4 * moves(v[5], 0)];
  }
  REQUIRE(open > 50);
  for (int k = 0; k < 8; ++k) {
    CAPTURE(k, seen[k]);
    REQUIRE(seen[k] >= 20);  // every case was met
  }
}

// The same equations, solved by the same root: equal to the rounding of one visit. Rows that move nothing, as
// those of the turns of a particle, take no impulse.
TEST_CASE("without moments, or for what cannot turn, rolling friction is Coulomb's") {
  std::mt19937 random(7);
  const auto draw = [&] { return 2 * double(random()) / 4294967295.0 - 1; };
  for (int k = 0; k < 500; ++k) {
    Mat<6, 6> G, W;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) G(i, j) = (i == j ? 1.0 : 0.0) + 0.3 * draw();
    W = G * G.transpose();
    Vec<6> b;
    for (int i = 0; i < 6; ++i) b[i] = draw();
    const bool turns = k % 2 == 0;
    if (!turns) W.bottomRows<3>().setZero(), W.rightCols<3>().setZero(), b.tail<3>().setZero();
    RollingCoulomb::Memory<double> memory;
    Coulomb::Memory<double> other;
    law.prepare(W, memory);
    const Mat3 moving = W.topLeftCorner<3, 3>();
    Coulomb{}.prepare(moving, other);
    const Vec<6> lambda = law.solve_local({0.4, turns ? 0.0 : 0.1, turns ? 0.0 : 0.1}, W, b, memory);
    const Vec3 alone = Coulomb{}.solve_local(Coulomb::Parameters{0.4}, moving, Vec3(b.head<3>()), other);
    REQUIRE((lambda.head<3>() - alone).norm() <= 1e-12 * (1 + alone.norm()));
    REQUIRE(lambda.tail<3>().norm() == 0);
  }
}

TEST_CASE("what no rolling friction can be is refused by its name") {
  CHECK_THROWS_WITH(RollingCoulomb{.rolling_friction = -1}.check(),
                    "delassus: RollingCoulomb: rolling_friction -1 must be finite and >= 0");
  CHECK_THROWS_WITH(RollingCoulomb{.torsional_friction = std::nan("")}.check(),
                    Catch::Contains("torsional_friction"));
}

// Sweeps alone take a thousand times the ratio of the masses: none of these steps ended within 20 000. With a
// tangent Newton's method acts; a contact starts without moments, so that it does in every step. The last digit of the tolerance is
// at the edge of what it reaches: which steps miss it is chance. What they leave, of the 0.16 m/s of gravity, is below 1e-5 m/s.
TEST_CASE("boxes that rest with rolling friction under 1e5 kg are solved in nearly every step, by Newton's method") {
  AnimationLoop loop{
      World{RigidBodies{}},
      Constraints{Contact{Restitution{
          RollingCoulomb{.friction = 0.5, .rolling_friction = 1e-2, .torsional_friction = 1e-2}, 0.2}}},
      AcceleratedGaussSeidel{.tolerance = 1e-6, .max_iterations = 2000}};
  auto& set = rigid_bodies(loop);
  set.add_fixed(HalfSpace{});
  for (int i = 0; i < 3; ++i)
    set.add({.position = {0.01 * i, 0.02 * i, 0.5 + i}, .mass = i == 2 ? 1e5 : 1.0, .shape = Box{1, 1, 1}});
  int factorizations = 0, missed = 0;
  for (int n = 0; n < 50; ++n) {
    CAPTURE(n);
    const StepReport report = loop.step(1.0 / 60);
    missed += report.status != Status::converged;
    REQUIRE(report.residual * 9.81 / 60 <= 1e-5);
    for (const SolveReport& r : loop.island_reports()) factorizations += r.factorizations;
  }
  CHECK(missed <= 5);
  CHECK(factorizations >= 50);
  CHECK(factorizations <= 4000);
}

}  // namespace rolling_coulomb_tests
