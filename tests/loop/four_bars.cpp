// Loops of hinges that lie on one line twice a turn, by the midpoint rule and Newton's method.
#include <delassus/steppers/newton_midpoint.hpp>

#include "loop/smooth_scenes.hpp"

#include "catch.hpp"

#include <vector>

namespace four_bars_tests {

using namespace smooth;

namespace {

/// AC-11: n + 1 upright unit rods of 1 kg with n level ones between their tops, the tops at 1 m/s along x.
struct FourBars {
  AnimationLoop<World<RigidBodies>, Constraints<Hinge>, NewtonMidpoint> loop{
      World{RigidBodies{}}, Constraints{Hinge{}}, NewtonMidpoint{}};
  int n;

  explicit FourBars(int bars) : n(bars) {
    auto& set = bodies<RigidBodies>(loop.world());
    const Quat across = frame_along({0, 1, 0});
    const auto hinge = [&](const Anchor& a, const Anchor& b) { loop.add(Hinge::Item{a, b}); };
    std::vector<RigidBodies::Handle> cranks;
    for (int k = 0; k <= n; ++k) {
      cranks.push_back(set.add({.position = {double(k), 0, 0.5},
                                .velocity = {0.5, 0, 0},
                                .angular_velocity = {0, 1, 0},
                                .mass = 1.0,
                                .inertia = Mat3(Vec3(1. / 12, 1. / 12, 1e-3).asDiagonal())}));
      hinge(world_anchor({double(k), 0, 0}, across), anchor(set, cranks.back(), {0, 0, -0.5}, across));
    }
    for (int k = 0; k < n; ++k) {
      const auto bar = set.add({.position = {k + 0.5, 0, 1},
                                .velocity = {1, 0, 0},
                                .mass = 1.0,
                                .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
      hinge(anchor(set, cranks[std::size_t(k)], {0, 0, 0.5}, across), anchor(set, bar, {-0.5, 0, 0}, across));
      hinge(anchor(set, cranks[std::size_t(k + 1)], {0, 0, 0.5}, across),
            anchor(set, bar, {0.5, 0, 0}, across));
    }
  }
  /// The top of a crank, from its foot.
  Vec3 top(int crank = 0) const {
    const auto& set = loop.world().template set<0>();
    const auto body = set.handle(Index(crank));
    return set.position(body) + set.orientation(body) * Vec3(0, 0, 0.5) - Vec3(double(crank), 0, 0);
  }
  /// Ω² of φ¨ = Ω² sin φ, φ from the upright: all cranks turn alike.
  double rate() const { return 9.81 * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n); }
  /// From the top down, J.
  double height_of_energy() const { return 9.81 * (0.5 * (n + 1) + n) * 2; }
};

/// φ after t s of φ¨ = Ω² sin φ from 0 at 1 rad/s, by the classical Runge-Kutta method in steps of 1e-4 s.
double crank_angle(double rate, double t) {
  double phi = 0, omega = 1;
  const int steps = int(std::lround(t / 1e-4));
  const double h = t / steps;
  for (int k = 0; k < steps; ++k) {
    const auto bend = [&](double x) { return rate * std::sin(x); };
    const double k1 = bend(phi), l2 = omega + h / 2 * k1, k2 = bend(phi + h / 2 * omega);
    const double l3 = omega + h / 2 * k2, k3 = bend(phi + h / 2 * l2), l4 = omega + h * k3,
                 k4 = bend(phi + h * l3);
    phi += h / 6 * (omega + 2 * l2 + 2 * l3 + l4);
    omega += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return phi;
}

struct Ran {
  double place = 0, energy = 0, gap = 0, apart = 0;
  bool converged = true;
};
/// `seconds` at h: how far the first top is from where it must be, and what was kept on the way.
Ran run(FourBars& bars, double seconds, double h) {
  Ran ran;
  const double start = energy(bars.loop);
  for (long k = std::lround(seconds / h); k > 0; --k) {
    const StepReport report = bars.loop.step(h);
    ran.converged = ran.converged && report.status <= Status::stalled;
    ran.gap = std::max(ran.gap, report.max_joint_violation);
    ran.energy = std::max(ran.energy, std::abs(energy(bars.loop) - start) / bars.height_of_energy());
    for (const int crank : {1, bars.n})
      ran.apart = std::max(ran.apart, (bars.top(crank) - bars.top()).norm());
  }
  const double phi = crank_angle(bars.rate(), seconds);
  ran.place = (bars.top() - Vec3(std::sin(phi), 0, std::cos(phi))).norm();
  return ran;
}

}  // namespace

TEST_CASE("the reference of the four-bars is that of AC-11") {
  const FourBars two(2);
  CHECK(two.rate() == Approx(11.445).epsilon(1e-12));
  const double phi = crank_angle(two.rate(), 10);
  CHECK((Vec3(std::sin(phi), 0, std::cos(phi)) - Vec3(0.328458111540815, 0, 0.944518538178601)).norm() <=
        1e-8);
}

// AC-11 at gold and HC-21: 1e-5 of the energy and 1e-3 m are asked for after twenty seconds. Second order: a
// turn in about two seconds is off by (h Ω)²/12 = 4e-6 of it, 1e-4 m after ten. Forty, with 243 rows of which
// each loop has three to spare.
TEST_CASE("four-bars turn for twenty seconds through their singular poses on the branch they are on") {
  for (const int n : {1, 2, 5, 40}) {
    FourBars bars(n);
    const Ran ran = run(bars, 20, 2e-3);
    CAPTURE(n, ran.place, ran.energy, ran.gap, ran.apart);
    CHECK(ran.converged);
    CHECK(ran.apart <= 1e-6);
    CHECK(ran.energy <= 1e-5);
    CHECK(ran.place <= 1e-3);
    CHECK(ran.gap <= 1e-9);
  }
}

}  // namespace four_bars_tests
