// A chain of rods that hangs at rest between two points, against the statics of its links.
#include <delassus/solvers/direct_gauss_seidel.hpp>

#include "loop/chains.hpp"

#include "catch.hpp"

namespace catenary_tests {

using namespace chains;

namespace {

struct Hung {
  double level, end, sag;  ///< N, N, m
};

/// `links` rods, 2 m and 2 kg together, between two points of one height 1.5 m apart, after `seconds` with a
/// damping of 5 /s; they begin on the catenary of a rope.
Hung hang(int links, double seconds, double h) {
  AnimationLoop loop{World{RigidBodies{}}, Constraints{BallJoint{}}, ImplicitEuler{.rayleigh_mass = 5},
                     DirectGaussSeidel{.tolerance = 1e-12}, WholeViolation{}};
  auto& rigid = bodies<RigidBodies>(loop.world());
  const double a = 0.555041792308151, span = 1.5, length = 2.0 / links, mass = 2.0 / links;
  const auto rope = [&](double s) {  // m from the lowest point
    return Vec3(a * std::asinh(s / a) + span / 2, 0,
                a * std::sqrt(1 + s * s / (a * a)) - a * std::cosh(0.75 / a));
  };
  Anchor end = world_anchor(Vec3::Zero());
  for (int k = 0; k < links; ++k) {
    const Vec3 from = rope(k * length - 1), to = rope((k + 1) * length - 1);
    const auto link =
        rigid.add({.position = 0.5 * (from + to),
                   .orientation = frame_along(to - from),
                   .mass = mass,
                   .inertia = Mat3(mass * length * length / 12 * Vec3(1, 1, 0.1).asDiagonal())});
    loop.add(BallJoint::Item{end, anchor(rigid, link, {0, 0, -0.5 * length})});
    end = anchor(rigid, link, {0, 0, 0.5 * length});
  }
  const auto last = loop.add(BallJoint::Item{end, world_anchor({span, 0, 0})});
  for (long n = std::lround(seconds / h); n > 0; --n) loop.step(h);
  const Vec3 force = loop.impulse(last) / h;
  double lowest = 0;
  for (Index b = 0; b < rigid.blocks(); ++b) {
    const Pose pose = rigid.pose(b);
    lowest = std::min(lowest, pose.position.z() - 0.5 * length * std::abs(pose.rotation(2, 2)));
  }
  return {std::abs(force.x()), force.norm(), -lowest};
}

}  // namespace

// AC-35: 1e-4 is asked for. The swings have gone by e^(−2.5 t/2): 1e-5 of what they were, 1e-3 of the forces,
// after 8 s. A link must not swing sideways by more than a radian a step, √(4T/(mL)) h = 316 h with a hundred
// of them.
TEST_CASE("a chain at rest pulls at its ends with the tensions of its statics, and sags as far") {
  struct Row {
    int links;
    double level, end, sag, h;
  };
  for (const auto& [links, level, end, sag, h] : {Row{10, 5.432298490, 11.213650917, 0.592039131, 0.01},
                                                  {20, 5.441783726, 11.218248978, 0.589502100, 0.01},
                                                  {100, 5.444832794, 11.219728346, 0.588700968, 2e-3}}) {
    const Hung chain = hang(links, 8, h);
    CAPTURE(links, chain.level, chain.end, chain.sag);
    CHECK(chain.level == Approx(level).epsilon(1e-6));
    CHECK(chain.end == Approx(end).epsilon(1e-6));
    CHECK(chain.sag == Approx(sag).epsilon(1e-6));
  }
}

}  // namespace catenary_tests
