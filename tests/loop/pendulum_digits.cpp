// Pendulums of points against the digits of their closed forms and references, by the classical Runge-Kutta
// method.
#include <delassus/steppers/runge_kutta4.hpp>

#include "loop/chains.hpp"
#include "loop/smooth_scenes.hpp"

#include <array>
#include <vector>

#include "catch.hpp"

namespace pendulum_digits_tests {

using namespace smooth;

namespace {

constexpr double g = 9.81;

}  // namespace

TEST_CASE("the closed form of the pendulum has the digits of AC-08") {
  CHECK((pendulum_at(1) - Vec3(-0.986291751131875, 0, -0.165010853125541)).norm() <= 1e-13);
  CHECK((pendulum_at(100) - Vec3(0.181513351427031, 0, -0.983388480334058)).norm() <= 1e-11);
  CHECK((pendulum_at(2000) - Vec3(-0.814603068589032, 0, -0.580018827836935)).norm() <= 1e-10);
}

// AC-08 and IFToMM's A01: 4000 outputs of 2000 s within 1e-3 m. The error is one of phase and grows like t².
TEST_CASE("a pendulum is within a millimetre of its closed form for two thousand seconds") {
  auto loop = pendulum(RungeKutta4{});
  const double h = 4e-3, start = energy(loop);
  double worst = 0, lost = 0;
  for (int output = 1; output <= 4000; ++output) {
    run(loop, 0.5, h);
    worst = std::max(worst, (end_of(loop) - pendulum_at(0.5 * output)).norm());
    lost = std::max(lost, std::abs(energy(loop) - start));
  }
  CAPTURE(worst, lost);
  CHECK(worst <= 1e-3);
  CHECK(lost <= 1e-3 * g);
}

// T/T₀ = 2 K(sin θ/2)/π. A quarter of it later the bob passes below the pivot at 2 √g sin(θ/2).
TEST_CASE("the period of a pendulum grows with its amplitude as the elliptic integral says") {
  struct Row {
    double degrees, ratio;
  };
  for (const auto& [degrees, ratio] : {Row{45, 1.0399733431968},
                                       {90, 1.1803405990161},
                                       {120, 1.37288050061835},
                                       {150, 1.76220372950376},
                                       {179, 3.90106516038909}}) {
    auto loop = pendulum(RungeKutta4{});
    auto& points = bodies<Particles>(loop.world());
    const double angle = degrees * EIGEN_PI / 180, quarter = ratio * EIGEN_PI / (2 * std::sqrt(g));
    points.place(points.handle(0), {std::sin(angle), 0, -std::cos(angle)});
    const int steps = 1000;
    for (int n = 0; n < steps; ++n) loop.step(quarter / steps);
    const double late = end_of(loop).x() / (2 * std::sqrt(g) * std::sin(angle / 2));
    CAPTURE(degrees, late / quarter);
    CHECK(std::abs(late) <= 1e-8 * quarter);
    CHECK(end_of(loop).z() < 0);
  }
}

// AC-10: angles against the vertical. Nearby runs part by a factor of some ten a second; h⁴ has a factor of
// 1e-4 between the steps of the two claims.
TEST_CASE("a double pendulum follows its reference for ten seconds") {
  struct Row {
    double t, first, second;
  };
  const std::array<Row, 4> rows{Row{1, -0.62508769980639062995, -1.0345850856800123406},
                                {3, 1.7857955220774166762, 1.1181074612051554404},
                                {5, -0.62718670506653073014, -1.3013155502098116779},
                                {10, -0.56847466401595018878, -0.52639372793240469833}};
  auto loop = double_pendulum(RungeKutta4{});
  const double h = 1e-4;
  double t = 0;
  for (const Row& row : rows) {
    run(loop, row.t - t, h);
    t = row.t;
    const Vec3 at(std::sin(row.first) + std::sin(row.second), 0, -std::cos(row.first) - std::cos(row.second));
    CAPTURE(t, (end_of(loop) - at).norm());
    CHECK((end_of(loop) - at).norm() <= (t < 10 ? 1e-9 : 1e-6));
  }
}

// θ₂ = ±√2 θ₁, ω² = g (2 ∓ √2). At 1e-4 rad the amplitude is in the period by 1e-9 of it.
TEST_CASE("a double pendulum swings slightly with its two frequencies") {
  struct Mode {
    double omega, share;
  };
  for (const auto& [omega, share] :
       {Mode{2.39719939786409, std::sqrt(2.0)}, {5.78735129803609, -std::sqrt(2.0)}}) {
    auto loop = double_pendulum(RungeKutta4{});
    auto& points = bodies<Particles>(loop.world());
    const double a = 1e-4, b = share * a;
    const Vec3 first(std::sin(a), 0, -std::cos(a));
    points.place(points.handle(0), first);
    points.place(points.handle(1), first + Vec3(std::sin(b), 0, -std::cos(b)));
    for (int n = 0; n < 500; ++n) loop.step(EIGEN_PI / (2 * omega) / 500);
    for (const Index body : {0, 1}) CHECK(std::abs(points.position(points.handle(body)).x()) <= 1e-6 * a);
  }
}

// ω² = g/(L cos 30°): the bob stays at its height and is back after a turn. h⁴ with 1000 steps a turn.
TEST_CASE("a conical pendulum at thirty degrees turns with the rate of its closed form") {
  auto loop = pendulum(RungeKutta4{});
  auto& points = bodies<Particles>(loop.world());
  const double omega = 3.3656518360490675, radius = 0.5, depth = std::sqrt(0.75);
  const auto bob = points.handle(0);
  points.place(bob, {radius, 0, -depth});
  points.set_velocity(bob, {0, omega * radius, 0});
  for (int n = 0; n < 1000; ++n) {
    loop.step(2 * EIGEN_PI / omega / 1000);
    REQUIRE(std::abs(points.position(bob).z() + depth) <= 1e-9);
  }
  CHECK((points.position(bob) - Vec3(radius, 0, -depth)).norm() <= 1e-9);
}

}  // namespace pendulum_digits_tests
