// HC-21: mechanisms that pass the pose in which they lose a rank, and redundant rows on all of their way.
#include "../../examples/ladders/plane_loop.hpp"

#include <delassus/delassus.hpp>
#include <delassus/steppers/newton_midpoint.hpp>

#include <algorithm>
#include <cmath>

#include "catch.hpp"

using namespace delassus;
using ladders::PlaneLoop;

namespace {

/// How a run keeps what it should, at its worst.
struct Worst {
  double gap = 0, energy = 0;
  bool converged = true;
  template <class F>
  Worst(PlaneLoop& m, double h, int steps, const F& look) {
    const double start = kinetic_energy(m.rigid);
    for (int n = 0; n < steps; ++n) {
      const StepReport report = m.loop.step(h);
      converged = converged && report.status <= Status::stalled;
      gap = std::max(gap, report.max_joint_violation);
      energy = std::max(energy, std::abs(kinetic_energy(m.rigid) / start - 1));
      look();
    }
  }
};

}  // namespace

// A crank and a rod of one length: at the dead centre, θ = 90°, the slider is over the crank's axle and could
// stay there while both turn on. On its branch x = 2 cos θ, and 2 T = M θ̇² with M = ⅓ + (¼ + 2 s²) + 1/12 + 4
// s², s = sin θ: of the crank, the rod's centre (1.5 cos θ, ½ sin θ), its turn, the slider. So the time for θ
// is ∫ √(M/2T) dθ, whatever the dead centres do. The rule's phase errs by (h θ̇)²/12 of 20 s and some times
// that for the harmonics of M: 1e-3 bounds it.
TEST_CASE("a slider-crank of equal rods passes its dead centres on its branch for twenty seconds") {
  PlaneLoop m;
  const double first = 0.3, speed = 2, h = 2e-3;
  const double c = std::cos(first), s = std::sin(first);
  const Vec3 tip(c, 0, s), v_tip = speed * Vec3(-s, 0, c), at(2 * c, 0, 0), v_at(-2 * s * speed, 0, 0);
  const auto crank = m.rod({0, 0, 0}, tip, {0, 0, 0}, v_tip), link = m.rod(tip, at, v_tip, v_at);
  const auto slider =
      m.rigid.add({.position = at, .velocity = v_at, .mass = 1.0, .inertia = Mat3(0.1 * Mat3::Identity())});
  m.pin(world_anchor({0, 0, 0}, m.across), crank, {0, 0, 0});
  m.pin(m.on(crank, tip), link, tip);
  m.pin(m.on(slider, at), link, at);
  const Quat along = frame_along({1, 0, 0});
  m.loop.add(Slider::Item{world_anchor(at, along), anchor_at(m.rigid, slider, at, along)});
  double turned = first, last = first, off = 0;
  const Worst worst(m, h, 10000, [&] {
    const Vec3 now = m.end(crank, 1);
    const double theta = std::atan2(now.z(), now.x());
    turned += std::remainder(theta - last, 2 * EIGEN_PI);
    last = theta;
    off = std::max(off, std::abs(m.rigid.position(slider).x() - 2 * now.x()));
  });
  const auto inertia = [](double t) { return 2. / 3 + 6 * std::sin(t) * std::sin(t); };
  const double twice = inertia(first) * speed * speed;
  double time = 0;
  const int pieces = 100000;
  for (int k = 0; k < pieces; ++k)
    time +=
        std::sqrt(inertia(first + (turned - first) * (k + 0.5) / pieces) / twice) * (turned - first) / pieces;
  CAPTURE(worst.gap, worst.energy, off, turned, time);
  CHECK(worst.converged);
  CHECK(worst.gap <= 1e-9);
  CHECK(worst.energy <= 1e-8);
  CHECK(off <= 1e-6);
  CHECK(turned >= 20);  // over the dead centres six times and more
  CHECK(std::abs(time - 20) <= 1e-3 * 20);
}

// Two unit cranks a metre apart, and two unit rods between their ends: with the cranks mirrored the rods lie
// on one line when the cranks are at 60° to it; there the tip may leave to either side. It comes from above
// and goes on below.
TEST_CASE("a parallel five-bar passes through the pose in which its rods are one line") {
  PlaneLoop m;
  const double angle = 65 * EIGEN_PI / 180, h = 1e-3;
  const double x = std::cos(angle), z = std::sin(angle), w = 0.2;  // the cranks turn apart
  const Vec3 left(-x, 0, z), right(1 + x, 0, z), half(0.5 + x, 0, 0);
  const double rise = std::sqrt(1 - half.squaredNorm());
  const Vec3 tip(0.5, 0, z + rise);
  const Vec3 v_left = w * Vec3(-z, 0, -x), v_right = w * Vec3(z, 0, -x);
  // The rods keep their length: half · v + rise · v_z = 0 of the tip against the elbow.
  const Vec3 v_tip(0, 0, v_left.z() + v_left.x() * half.x() / rise);
  const auto a = m.rod({0, 0, 0}, left, {0, 0, 0}, v_left), b = m.rod({1, 0, 0}, right, {0, 0, 0}, v_right);
  const auto p = m.rod(left, tip, v_left, v_tip), q = m.rod(right, tip, v_right, v_tip);
  m.pin(world_anchor({0, 0, 0}, m.across), a, {0, 0, 0});
  m.pin(world_anchor({1, 0, 0}, m.across), b, {1, 0, 0});
  m.pin(m.on(a, left), p, left);
  m.pin(m.on(b, right), q, right);
  m.pin(m.on(p, tip), q, tip);
  double lowest = 1, skew = 0;
  const Worst worst(m, h, 20000, [&] {
    const Vec3 elbow = m.end(a, 1), other = m.end(b, 1), now = m.end(p, 1);
    lowest = std::min(lowest, now.z() - 0.5 * (elbow.z() + other.z()));
    if (lowest > -0.1) skew = std::max(skew, std::abs(elbow.x() + other.x() - 1));
  });
  CAPTURE(worst.gap, worst.energy, lowest, skew);
  CHECK(worst.converged);
  CHECK(worst.gap <= 1e-9);
  CHECK(worst.energy <= 1e-8);
  CHECK(skew <= 1e-6);  // nothing tells left from right on the way there
  CHECK(lowest <= -0.2);
}

namespace {

/// Rods of 1 m and 1 kg on ball joints, in one line between two hooks, under their weight.
struct TautChain {
  AnimationLoop<World<RigidBodies>, Constraints<BallJoint>, NewtonMidpoint> loop{
      World{RigidBodies{}}, Constraints{BallJoint{}}, NewtonMidpoint{}};
  RigidBodies& rigid = bodies<RigidBodies>(loop.world());

  explicit TautChain(int links) {
    Anchor end = world_anchor(Vec3::Zero());
    for (int k = 0; k < links; ++k) {
      const auto rod = rigid.add({.position = {k + 0.5, 0, 0},
                                  .mass = 1.0,
                                  .inertia = Mat3(Vec3(1e-3, 1. / 12, 1. / 12).asDiagonal())});
      loop.add(BallJoint::Item{end, anchor(rigid, rod, {-0.5, 0, 0})});
      end = anchor(rigid, rod, {0.5, 0, 0});
    }
    loop.add(BallJoint::Item{world_anchor({double(links), 0, 0}), end});
  }
};

/// 500 solved steps; how far a joint is open at the end, m.
double let_hang(TautChain& chain, double h) {
  double gap = 0;
  for (int n = 0; n < 500; ++n) {
    const StepReport report = chain.loop.step(h);
    REQUIRE(report.status <= Status::stalled);
    gap = report.max_joint_violation;
  }
  return gap;
}

}  // namespace

// No tension holds a straight chain: its rows yield by R = 1e-10 W_kk h/2 a unit of impulse. Two rods hang at
// θ where the tension is F = m g/(2 θ) and the joints, W_kk = 1/m at the hooks and 2/m between, are apart by
// θ² = 4/m · 1e-10 h/2 · F h in all: θ³ = 1e-10 h² g, and half of it between the rods.
TEST_CASE("two rods drawn straight between two hooks hang") {
  for (const double h : {1e-2, 1e-3}) {
    TautChain chain(2);
    const double gap = let_hang(chain, h);
    const double sag = std::cbrt(1e-10 * h * h * 9.81);
    double fast = 0;
    for (const auto& v : chain.rigid.velocity()) fast = std::max(fast, v.norm());
    CAPTURE(h, sag, gap, fast);
    CHECK(chain.rigid.pose(0).position.z() == Approx(-sag / 2).epsilon(1e-3));
    CHECK(gap == Approx(sag * sag / 2).epsilon(1e-2));
    CHECK(fast <= 1e-3 * 9.81 * h);
  }
}

// As many weights as links, L metres of them, on a parabola of slope α at its ends: F = L m g/(2 α), and its
// length is L α²/6 more than the straight line's, of which each of L joints has 2/m · 1e-10 h/2 · F h: α³ =
// 3e-10 L h² g. It is L α/4 deep. The polygon is within 1/L of the parabola, and what still swings of the
// chain as much again.
TEST_CASE("twenty rods drawn straight between two hooks hang on a parabola") {
  const double h = 0.01, L = 20;
  TautChain chain(20);
  const double gap = let_hang(chain, h);
  const double slope = std::cbrt(3e-10 * L * h * h * 9.81), pull = L * 9.81 / (2 * slope);
  CAPTURE(slope, pull);
  CHECK(chain.rigid.pose(9).position.z() == Approx(-L * slope / 4).epsilon(2 / L));
  CHECK(gap == Approx(1e-10 * h * h * pull).epsilon(2 / L));
}
